// Camera raw files: values compared with the formula and with LibRaw's own programs, recovery and correction of
// falloffs, and every kind of unreadable file.
#include "photo/registration/registration.hpp"
#include "raw_runs.hpp"

#include <cstring>
#include <random>

using namespace raw_runs;

namespace {

constexpr double k1 = -0.40, k2 = 0.10, k3 = -0.05;
constexpr double light[3] = {0.5, 0.8, 0.6};

double falloff(double x, double y, uint32_t width, uint32_t height) {
    const double dx = x - (width - 1) / 2.0, dy = y - (height - 1) / 2.0;
    const double r2 = 4.0 * (dx * dx + dy * dy) / (double(width) * width + double(height) * height);
    return 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
}

// A card with a known falloff on a mosaic; `gain` is the exposure.
Dng card(uint32_t width, uint32_t height, uint16_t bits, Packing packing, double gain = 1.0) {
    Dng dng;
    dng.width = width, dng.height = height, dng.bits = bits, dng.packing = packing;
    dng.white = (1u << bits) - 1;
    dng.black = {256, 260, 262, 250};
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0.0, 2.0);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const size_t place = y % 2 * 2 + x % 2;
            const double black = dng.black[place];
            const double value =
                black + (dng.white - black) * gain * light[dng.pattern[place]] * falloff(x, y, width, height);
            dng.values.push_back(
                static_cast<uint16_t>(std::clamp(std::lround(value + noise(random)), 0l, long(dng.white))));
        }
    return dng;
}

std::string save_dng(const std::string &name, const Dng &dng) {
    save(work(name), dng_bytes(dng));
    return work(name);
}

double linear(const Dng &dng, uint32_t x, uint32_t y) {
    const double black = dng.black.size() == 4 ? dng.black[y % 2 * 2 + x % 2] : dng.black[0];
    const double value = dng.values[size_t(y) * dng.width + x];
    return std::clamp((value - black) / (dng.white - black), 0.0, 1.0) * 65535.0;
}

// Every channel of every cell is the mean of its samples within rounding; 65535 if one is saturated, and only then.
void assert_cells(const Dng &dng, const std::string &path) {
    ReadOptions options;
    options.max_side = std::max(dng.width, dng.height) / 2;
    Picture picture = read_picture(path, options);
    assert_int_equal(picture.reduction, 2);
    assert_int_equal(picture.width, dng.width / 2);
    assert_int_equal(picture.height, dng.height / 2);
    assert_int_equal(picture.sample, LENSPROF_SAMPLE_U16);
    assert_int_equal(picture.layout, LENSPROF_LAYOUT_RGB);
    size_t saturated = 0;
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++) {
            const auto *pixel =
                reinterpret_cast<const uint16_t *>(picture.pixels.data() + y * picture.row_bytes) + 3 * x;
            for (uint8_t c = 0; c < 3; c++) {
                double sum = 0;
                int count = 0;
                bool is_saturated = false;
                for (uint32_t i = 0; i < 4; i++)
                    if (dng.pattern[i] == c) {
                        const uint32_t u = 2 * x + i % 2, v = 2 * y + i / 2;
                        sum += linear(dng, u, v), count++;
                        is_saturated |= dng.values[size_t(v) * dng.width + u] >= dng.white;
                    }
                assert_true((pixel[c] == 65535) == is_saturated);
                saturated += is_saturated;
                if (!is_saturated && std::fabs(pixel[c] - sum / count) > 1.01)
                    fail_msg("%s: channel %d of cell %u, %u: %d, not %g", path.c_str(), c, x, y, pixel[c], sum / count);
            }
        }
    assert_true(saturated > 0);
}

// 12, 14 and 16 bits, every packing and mosaic, a black level per site, saturated corners.
void test_values(void **) {
    needs_libraw();
    const std::array<uint8_t, 4> patterns[] = {{0, 1, 1, 2}, {1, 0, 2, 1}, {1, 2, 0, 1}, {2, 1, 1, 0}};
    size_t i = 0;
    for (uint16_t bits : {uint16_t(12), uint16_t(14)})
        for (Packing packing : {Packing::words, Packing::bits, Packing::lossless}) {
            Dng dng = card(160, 120, bits, packing);
            dng.pattern = patterns[i % 4];
            for (size_t k = 0; k < 300; k++) dng.values[k * 7] = static_cast<uint16_t>(dng.white);
            for (size_t k = 0; k < 300; k++) dng.values[10000 + k * 3] = static_cast<uint16_t>(k % 300);  // near black
            assert_cells(dng, save_dng("v" + std::to_string(i++) + ".dng", dng));
        }
}

// The black level comes from the masked borders, whatever the tags state, and the borders are not part of the picture.
void test_masked_borders(void **) {
    needs_libraw();
    const Dng inner = card(160, 120, 14, Packing::words);
    Dng dng = inner;
    dng.width = 160 + 32, dng.height = 120 + 8;
    dng.active = {8, 32, 128, 192};
    dng.masked = {8, 2, 128, 30};
    dng.values.clear();
    for (uint32_t y = 0; y < dng.height; y++)
        for (uint32_t x = 0; x < dng.width; x++)
            dng.values.push_back(y >= 8 && x >= 32 ? inner.values[size_t(y - 8) * 160 + x - 32]
                                                   : static_cast<uint16_t>(inner.black[y % 2 * 2 + x % 2]));
    dng.black = {10, 10, 10, 10};
    const std::string path = save_dng("masked.dng", dng);
    Dng truth = inner;
    truth.values[0] = static_cast<uint16_t>(truth.white);
    dng.values[size_t(8) * dng.width + 32] = truth.values[0];
    save(path, dng_bytes(dng));
    assert_cells(truth, path);
}

Dng linear_card() {
    const Dng mosaic = card(160, 120, 12, Packing::words);
    Dng dng = mosaic;
    dng.samples = 3, dng.black = {256}, dng.values.clear();
    for (uint32_t y = 0; y < dng.height; y++)
        for (uint32_t x = 0; x < dng.width; x++)
            for (double l : light)
                dng.values.push_back(static_cast<uint16_t>(std::lround(256 + 3839 * l * falloff(x, y, 160, 120))));
    dng.values[4] = 4095;
    return dng;
}

// Linear values are not interpolated.
void test_linear_dng(void **) {
    needs_libraw();
    const Dng dng = linear_card();
    Picture picture = read_picture(save_dng("linear.dng", dng));
    assert_int_equal(picture.width, 160);
    assert_int_equal(picture.height, 120);
    const auto *got = reinterpret_cast<const uint16_t *>(picture.pixels.data());
    for (size_t i = 0; i < dng.values.size(); i++)
        if (std::fabs(got[i] - (dng.values[i] - 256.0) / 3839.0 * 65535.0) > 0.51)
            fail_msg("sample %zu: %d of %d", i, got[i], dng.values[i]);
    assert_int_equal(got[4], 65535);
}

// At full size, the samples of the mosaic are unchanged; the others are interpolated close to the truth.
void test_full_size(void **) {
    needs_libraw();
    const Dng dng = card(160, 120, 14, Packing::words);
    Picture picture = read_picture(save_dng("full.dng", dng));
    assert_int_equal(picture.width, 160);
    double worst = 0;
    for (uint32_t y = 0; y < 120; y++)
        for (uint32_t x = 0; x < 160; x++) {
            const auto *pixel =
                reinterpret_cast<const uint16_t *>(picture.pixels.data() + y * picture.row_bytes) + 3 * x;
            assert_true(std::fabs(pixel[dng.pattern[y % 2 * 2 + x % 2]] - linear(dng, x, y)) <= 0.51);
            for (int c = 0; c < 3; c++)
                worst = std::max(worst, std::fabs(pixel[c] / (65535.0 * light[c] * falloff(x, y, 160, 120)) - 1.0));
        }
    print_message("interpolated: error at most %.2f %%\n", 100.0 * worst);
    assert_true(worst < 0.02);  // noise of 2 of 16383, and interpolation at the border
}

// LibRaw interpolates X-Trans from 512 pixels on. Cells of 2 x 2 pixels may lack red or blue. For a uniform colour, all
// pixels get it, at half and at full size.
void test_xtrans(void **) {
    needs_libraw();
    Dng dng;
    dng.width = 624, dng.height = 540, dng.bits = 14, dng.white = 16383, dng.black = {1000};
    dng.pattern6 = {1, 1, 0, 1, 1, 2, 1, 1, 2, 1, 1, 0, 2, 0, 1, 0, 2, 1,
                    1, 1, 2, 1, 1, 0, 1, 1, 0, 1, 1, 2, 0, 2, 1, 2, 0, 1};
    for (uint32_t y = 0; y < dng.height; y++)
        for (uint32_t x = 0; x < dng.width; x++)
            dng.values.push_back(static_cast<uint16_t>(1000 + 3000 * (1 + dng.pattern6[y % 6 * 6 + x % 6])));
    const std::string path = save_dng("xtrans.dng", dng);
    for (uint32_t side : {0u, 312u}) {
        ReadOptions options;
        options.max_side = side;
        const Picture picture = read_picture(path, options);
        assert_int_equal(picture.width, side ? 312 : 624);
        const auto *got = reinterpret_cast<const uint16_t *>(picture.pixels.data());
        for (size_t i = 0; i < size_t(picture.width) * picture.height * 3; i++)
            if (std::fabs(got[i] - 65535.0 * 3000.0 * double(1 + i % 3) / 15383.0) > 1.01)
                fail_msg("side %u, sample %zu: %d", side, i, got[i]);
    }
}

Picture read_ppm(const std::string &path) {
    const Bytes bytes = load(path);
    unsigned width = 0, height = 0, most = 0;
    int used = 0;
    assert_int_equal(
        sscanf(reinterpret_cast<const char *>(bytes.data()), "P6 %u %u %u%n", &width, &height, &most, &used), 3);
    assert_int_equal(most, 65535);
    Picture picture;
    picture.width = width, picture.height = height, picture.row_bytes = size_t(width) * 6;
    picture.pixels.assign(bytes.begin() + used + 1, bytes.end());
    for (size_t i = 0; i + 1 < picture.pixels.size(); i += 2) std::swap(picture.pixels[i], picture.pixels[i + 1]);
    return picture;
}

// dcraw_emu subtracts black per channel and scales all channels by the white above the lowest black: a known
// difference.
void test_dcraw_emu(void **) {
    needs_libraw();
    if (system("command -v dcraw_emu >/dev/null 2>&1") != 0) {
        print_message("needs package libraw-bin\n");
        skip();
    }
    for (Packing packing : {Packing::words, Packing::bits, Packing::lossless}) {
        const Dng dng = card(160, 120, 14, packing, 0.9);
        const std::string path = save_dng("peer.dng", dng);
        const std::string call =
            "cd '" + work("") + "' && dcraw_emu -4 -h -o 0 -r 1 1 1 1 -g 1 1 -W -t 0 -c 0 peer.dng >/dev/null 2>&1";
        assert_int_equal(system(call.c_str()), 0);
        const Picture theirs = read_ppm(path + ".ppm");
        ReadOptions options;
        options.max_side = 80;
        const Picture own = read_picture(path, options);
        assert_int_equal(theirs.width, own.width);
        assert_int_equal(theirs.height, own.height);
        const double least = *std::min_element(dng.black.begin(), dng.black.end());
        for (size_t i = 0; i < size_t(80) * 60 * 3; i++) {
            const auto a = reinterpret_cast<const uint16_t *>(own.pixels.data())[i];
            const auto b = reinterpret_cast<const uint16_t *>(theirs.pixels.data())[i];
            double scale = 0;  // ratio of both, per channel
            int count = 0;
            for (size_t place = 0; place < 4; place++)
                if (dng.pattern[place] == i % 3) scale += (dng.white - least) / (dng.white - dng.black[place]), count++;
            if (std::fabs(a - b * scale / count) > 12.0) fail_msg("sample %zu: %d, not %d", i, a, b);
        }
    }
}

// The response is linear, the falloff within .001, the profile stored as raw; a correction leaves the card flat, and an
// opcode changes only the list.
void test_card(void **) {
    needs_libraw();
    const std::string path = save_dng("card.dng", card(600, 400, 14, Packing::lossless));
    const std::string db = work("x.db");
    const Json flat = json_of({"flat", path, "--db", db, "--camera", "TestCam 1", "--lens", "L", "--focal", "50",
                               "--aperture", "2.8", "--json"});
    assert_true(flat["response"]["kind"] == "linear" || contains(flat["response"].dump(), "linear"));
    assert_true(contains(json_of({"profile", "show", "1", "--db", db, "--json"}).dump(), "\"processing\":\"raw\""));
    const Json k = flat["vignetting"]["k"][0];
    for (double r : {0.5, 1.0}) {
        const double r2 = r * r,
                     got = 1 + r2 * (k[0].get<double>() + r2 * (k[1].get<double>() + r2 * k[2].get<double>()));
        const double truth = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
        print_message("falloff at %.1f: %.5f, true %.5f\n", r, got, truth);
        assert_true(std::fabs(got - truth) < 1e-3);
    }
    const Words apply = {"apply", path, "--db", db, "--profile", "1", "-o"};
    must_exit(done, apply + Words{work("dng")});
    must_exit(done, apply + Words{work("tif"), "--encoding", "raw=tif", "--threads", "1"});
    must_exit(done, apply + Words{work("tif4"), "--encoding", "raw=tif", "--threads", "4"});
    assert_true(load(work("tif/card.tif")) == load(work("tif4/card.tif")));
    const Picture before = read_picture(path), same = read_picture(work("dng/card.dng"));
    assert_true(before.pixels == same.pixels);
    const Bytes original = load(path), copy = load(work("dng/card.dng"));  // only the offset of the directory differs
    assert_true(copy.size() > original.size() && std::equal(original.begin() + 8, original.end(), copy.begin() + 8));

    assert_true(read_metadata(work("tif/card.tif")).key.processing == LENSPROF_PROCESSING_CORRECTED);
    assert_true(read_metadata(work("tif/card.tif")).processing_before == LENSPROF_PROCESSING_RAW);
    const Picture flattened = read_picture(work("tif/card.tif"));
    assert_int_equal(flattened.sample, LENSPROF_SAMPLE_U16);
    for (uint32_t y : {20u, 200u, 380u})
        for (uint32_t x : {20u, 300u, 580u}) {
            double mean[3] = {};
            for (uint32_t i = 0; i < 256; i++)
                for (size_t c = 0; c < 3; c++)
                    mean[c] += reinterpret_cast<const uint16_t *>(
                        flattened.pixels.data() + (y - 8 + i / 16) * flattened.row_bytes)[3 * (x - 8 + i % 16) + c];
            for (size_t c = 0; c < 3; c++) assert_true(std::fabs(mean[c] / 256 / (65535.0 * light[c]) - 1.0) < 2e-3);
        }
    assert_refused(not_found, {"apply", work("tif/card.tif"), "--db", db, "--profile", "1", "-o", work("again")},
                   {"already corrected"});
}

void test_build(void **) {
    needs_libraw();
    const std::string folder = work("pictures");
    make_mosaics(folder);
    const std::string project = replaced(text_of(folder + "/pano.pto"), "\\.png", ".dng");
    save_text(folder + "/raw.pto", project);
    const Json built = json_of({"build", folder + "/raw.pto", "--db", work("x.db"), "--camera", "C", "--json"});
    const Json k = built["vignetting"]["k"][0];
    for (double r : {0.5, 1.0}) {
        const double r2 = r * r;
        const double got = 1 + r2 * (k[0].get<double>() + r2 * (k[1].get<double>() + r2 * k[2].get<double>()));
        print_message("falloff at %.1f: %.4f, true %.4f\n", r, got, 1 + r2 * (k1 + r2 * (k2 + r2 * k3)));
        assert_true(std::fabs(got - (1 + r2 * (k1 + r2 * (k2 + r2 * k3)))) < 0.01);
    }
    assert_true(built["response"]["kind"] == "linear");
    assert_true(
        contains(json_of({"profile", "show", "1", "--db", work("x.db"), "--json"}).dump(), "\"processing\":\"raw\""));
}

// The copies are linear TIFFs; the JPEG of a raw file is reported as left out.
void test_calibrate(void **) {
    needs_libraw();
    if (!can_register()) skip();
    const std::string folder = work("pictures");
    make_mosaics(folder);
    Picture small = read_picture(folder + "/img002.dng");
    small.icc.clear();
    write_picture(folder + "/img002.png", small, WriteOptions{});
    const Json json = json_of({"calibrate", folder, "-o", work("out"), "--db", work("x.db"), "--json"});
    assert_int_equal(json["panoramas"].size(), 1);
    assert_true(json["panoramas"][0]["result"]["equalizes"] == true);
    assert_int_equal(json["pictures"].size(), 6);
    for (const Json &picture : json["pictures"]) {
        const std::string output = picture["output"];
        assert_true(contains(output, ".tif") && fs::exists(output));
        assert_true(read_metadata(output).processing_before == LENSPROF_PROCESSING_RAW);
    }
    assert_int_equal(json["found"], 7);
    assert_int_equal(json["left_out"].size(), 1);
    assert_true(contains(json["left_out"][0]["reason"], "img002.png: img002.dng is used instead"));
}

void test_opcodes_are_not_doubled(void **) {
    needs_libraw();
    const std::string path = save_dng("card.dng", card(600, 400, 14, Packing::words)), db = work("x.db");
    must_exit(done, {"flat", path, "--db", db, "--camera", "C"});
    must_exit(done, {"apply", path, "--db", db, "--profile", "1", "-o", work("dng")});
    if (system("exiftool -ver >/dev/null 2>&1") == 0)
        assert_int_equal(
            system(("exiftool -s3 -OpcodeList3 '" + work("dng/card.dng") + "' | grep -q FixVignetteRadial").c_str()),
            0);
    assert_refused(not_found, {"apply", work("dng/card.dng"), "--db", db, "--profile", "1", "-o", work("two")},
                   {"card.dng", "--encoding raw=tif"});
    assert_refused(usage,
                   {"apply", path, "--db", db, "--profile", "1", "--encoding", "raw=dng", "--set", "strength=0.5", "-o",
                    work("two")},
                   {"--encoding raw"});
}

void test_mixed_and_pairs(void **) {
    needs_libraw();
    const std::string path = save_dng("card.dng", card(600, 400, 14, Packing::words)), db = work("x.db");
    must_exit(done, {"flat", path, "--db", db, "--camera", "C"});
    must_exit(done, {"apply", path, "--db", db, "--profile", "1", "-o", work("tif"), "--encoding", "raw=tif"});
    assert_refused(usage, {"flat", path, work("tif/card.tif"), "--no-store"},
                   {"card.dng", "card.tif", "files of one kind"});
    assert_refused(usage, {"bracket", path, work("tif/card.tif"), "--no-store"},
                   {"card.dng", "card.tif", "files of one kind"});
    fs::create_directories(work("pair"));
    fs::copy_file(path, work("pair/a.DNG")), fs::copy_file(work("tif/card.tif"), work("pair/a.tif"));
    const Outcome outcome = run_words({"apply", work("pair"), "--db", db, "--profile", "1", "-o", work("out")});
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "a.DNG: used instead of a.tif"));
    assert_true(fs::exists(work("out/a.dng")) && !fs::exists(work("out/a.tif")));
}

// Frames of a raw sequence become TIFFs that match; they cannot be written as DNG.
void test_align(void **) {
    needs_libraw();
    Words frames;
    for (double gain : {1.0, 0.25}) {
        frames.push_back(save_dng(gain < 1.0 ? "dark.dng" : "bright.dng", card(300, 200, 14, Packing::words, gain)));
    }
    const Json json = json_of(Words{"align", "-o", work("al"), "--to", "first", "--json"} + frames);
    assert_true(json["frames"][1]["output"] == work("al/dark.tif"));
    const Picture bright = read_picture(work("al/bright.tif")), dark = read_picture(work("al/dark.tif"));
    assert_int_equal(dark.sample, LENSPROF_SAMPLE_U16);
    double off = 0.0, most = 0.0;
    const auto *a = reinterpret_cast<const uint16_t *>(bright.pixels.data());
    const auto *b = reinterpret_cast<const uint16_t *>(dark.pixels.data());
    for (size_t n = 0; n < bright.pixels.size() / 2; n++) {
        off += std::abs(a[n] - b[n]), most = std::max<double>(most, a[n]);
    }
    assert_true(off / (double(bright.pixels.size()) / 2) < 0.02 * most);
    must_exit(done, {"simulate", "-o", work("other"), "--images", "2", "--size", "300x200"});
    assert_refused(usage, {"align", frames[0], work("other/img000.png"), "-o", work("no")},
                   {"bright.dng", "img000.png"});
}

// The content counts, not the name, for raw files and for others.
void test_content_counts(void **) {
    needs_libraw();
    const Dng dng = card(160, 120, 12, Packing::words);
    assert_int_equal(read_size(save_dng("a.jpg", dng)).width, 160);
    assert_int_equal(read_metadata(work("a.jpg")).key.processing, LENSPROF_PROCESSING_RAW);
    assert_int_equal(read_metadata(work("a.jpg")).size.width, 160);
    const Picture smooth = make_smooth(64, 48, LENSPROF_LAYOUT_RGB);
    write_picture(work("b.png"), smooth);
    fs::rename(work("b.png"), work("b.nef"));
    assert_int_equal(read_size(work("b.nef")).width, 64);
}

// The JPEG in a raw file is read like a separate file.
void test_preview(void **) {
    needs_libraw();
    const Dng dng = card(160, 120, 14, Packing::words);
    write_picture(work("preview.jpg"), make_smooth(96, 72, LENSPROF_LAYOUT_RGB));
    save(work("preview.dng"), dng_with_preview(dng, load(work("preview.jpg")), 96, 72));
    assert_int_equal(read_size(work("preview.dng")).width, 160);
    assert_same_pixels(read_raw_preview(work("preview.dng")), read_picture(work("preview.jpg")));
    save_dng("none.dng", dng);
    assert_failure(LENSPROF_ERROR_READ, "without a JPEG preview", [] { read_raw_preview(work("none.dng")); });
    assert_failure(LENSPROF_ERROR_READ, "not a camera raw file", [] { read_raw_preview(work("preview.jpg")); });
    const Bytes whole = load(work("preview.dng"));
    for (size_t keep = 0; keep < whole.size() - 2 * 160 * 120; keep += 97) {
        save(work("cut.dng"), Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(keep)));
        failure_of(LENSPROF_ERROR_READ, [] { read_raw_preview(work("cut.dng")); });
    }
}

// A file cut anywhere is refused, and no values are invented.
void test_truncated(void **) {
    needs_libraw();
    for (Packing packing : {Packing::words, Packing::bits, Packing::lossless}) {
        const Dng dng = card(160, 120, 12, packing);
        const Bytes whole = dng_bytes(dng);
        for (size_t keep = 0; keep < whole.size(); keep += whole.size() / 23 + 1) {
            save(work("cut.dng"), Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(keep)));
            failure_of(LENSPROF_ERROR_READ, [] { read_picture(work("cut.dng")); });
        }
    }
    save(work("empty.nef"), {});
    assert_failure(LENSPROF_ERROR_READ, "empty", [] { read_picture(work("empty.nef")); });
}

void test_bombs(void **) {
    needs_libraw();
    const Dng dng = card(160, 120, 12, Packing::lossless);
    for (uint32_t side : {20000u, 65535u, 65536u, 1000000u, 4000000000u}) {
        Dng bomb = dng;
        bomb.declared = side;
        save(work("bomb.dng"), dng_bytes(bomb));
        failure_of(LENSPROF_ERROR_READ, [] { read_picture(work("bomb.dng")); });
    }
    Dng bad = dng;
    bad.black = {5000, 5000, 5000, 5000};
    save_dng("black.dng", bad);
    assert_failure(LENSPROF_ERROR_READ, "black level", [] { read_picture(work("black.dng")); });
}

// The message names the kind of file, with and without LibRaw.
void test_kinds_are_named(void **) {
    const std::pair<std::string, const char *> kinds[] = {{"FUJIFILMCCD-RAW 0201", "Fujifilm RAF"},
                                                          {std::string("\0\0\0\x18"
                                                                       "ftypcrx ",
                                                                       12),
                                                           "Canon CR3"},
                                                          {"IIRS xxxxxxxxxxx", "Olympus ORF"},
                                                          {std::string("IIU\0xxxxxxxxxx", 14), "Panasonic RW2"},
                                                          {std::string("II*\0\x10\0\0\0CR\2\0", 12), "Canon CR2"},
                                                          {"FOVbxxxxxxxxxxxx", "Sigma X3F"}};
    for (const auto &[start, kind] : kinds) {
        save_text(work("x.bin"), start + std::string(200, 'x'));
        assert_failure(LENSPROF_ERROR_READ, kind, [] { read_picture(work("x.bin")); });
        assert_failure(LENSPROF_ERROR_READ, can_read_raw() ? "linear 16 bit TIFF" : "without LibRaw",
                       [] { read_picture(work("x.bin")); });
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_values),
        CLI_TEST(test_masked_borders),
        CLI_TEST(test_linear_dng),
        CLI_TEST(test_full_size),
        CLI_TEST(test_xtrans),
        CLI_TEST(test_dcraw_emu),
        CLI_TEST(test_card),
        CLI_TEST(test_build),
        CLI_TEST(test_calibrate),
        CLI_TEST(test_opcodes_are_not_doubled),
        CLI_TEST(test_mixed_and_pairs),
        CLI_TEST(test_align),
        CLI_TEST(test_content_counts),
        CLI_TEST(test_preview),
        CLI_TEST(test_truncated),
        CLI_TEST(test_bombs),
        CLI_TEST(test_kinds_are_named),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
