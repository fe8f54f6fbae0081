// `lensprof apply`: pixels compared with formulas computed here, and preservation of everything else in the file.
#include "cli_runs.hpp"

#include <lensprof/store.h>

using namespace cli_runs;

namespace {

// A project of pictures with a linear response and known falloff and exposures, so that a formula gives every pixel.
constexpr uint32_t width = 40, height = 30;
constexpr double k1 = -0.3, k2 = 0.1, true_ev[3] = {0, 0.7, -0.4}, true_red[3] = {1, 1.1, 0.9},
                 true_blue[3] = {1, 0.95, 1.2};

double falloff(uint32_t x, uint32_t y) {
    const double r = std::hypot(x - (width - 1) / 2.0, y - (height - 1) / 2.0) / (std::hypot(width, height) / 2);
    return 1 + k1 * r * r + k2 * r * r * r * r;
}

double exposure(size_t image, size_t channel) {
    return std::exp2(true_ev[image]) * (channel == 0 ? true_red[image] : channel == 2 ? true_blue[image] : 1);
}

std::string picture_name(size_t image) { return work("in/p" + std::to_string(image) + ".tif"); }

// Grey values of the middle range, far from saturation.
Picture make_picture(size_t image, uint32_t sample = LENSPROF_SAMPLE_U16) {
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB);
    uint64_t state = image + 1;
    auto *values = reinterpret_cast<float *>(picture.pixels.data());
    for (size_t i = 0; i < width * height * 3; ++i) values[i] = static_cast<float>(0.1 + 0.25 * lp_random(&state));
    if (sample == LENSPROF_SAMPLE_F32) return picture;
    Picture whole = make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    auto *codes = reinterpret_cast<uint16_t *>(whole.pixels.data());
    for (size_t i = 0; i < width * height * 3; ++i) codes[i] = static_cast<uint16_t>(values[i] * 65535);
    return whole;
}

double value_of(const Picture &picture, size_t i) {
    if (picture.sample == LENSPROF_SAMPLE_U16)
        return reinterpret_cast<const uint16_t *>(picture.pixels.data())[i] / 65535.0;
    if (picture.sample == LENSPROF_SAMPLE_F32) return double(reinterpret_cast<const float *>(picture.pixels.data())[i]);
    return picture.pixels[i] / 255.0;
}

// Writes pictures and project; the project's exposures start at an absolute value, as Hugin's do.
std::string make_project() {
    fs::create_directories(work("in"));
    std::ostringstream pto;
    pto << "p f2 w300 h150 v360 n\"TIFF_m\"\nm g1 i0 f0 m2 p0.00784314\n";
    for (size_t i = 0; i < 3; ++i) {
        write_picture(picture_name(i), make_picture(i));
        pto << "i w40 h30 f0 v50 Rt1 Ra0 Rb0 Rc0 Rd0 Re0 Eev" << 9 - true_ev[i] << " Er" << 1.25 * true_red[i] << " Eb"
            << 0.8 * true_blue[i] << " r0 p0 y" << 30 * i << " TrX0 TrY0 TrZ0 Tpy0 Tpp0 j0 a0 b0 c0 d0 e0 g0 t0 Va1 Vb"
            << k1 << " Vc" << k2 << " Vd0 Vx0 Vy0 Vm5 n\"p" << i << ".tif\"\n";
    }
    pto << "v Eev1 Eev2\nv\n";
    save_text(work("in/pano.pto"), pto.str());
    return work("in/pano.pto");
}

// Every pixel of every output is `wanted(image, channel)` times the input divided by falloff and exposure.
void check_pixels(const std::string &out, uint32_t sample, const std::function<double(size_t, size_t)> &wanted) {
    for (size_t i = 0; i < 3; ++i) {
        const Picture before = read_picture(picture_name(i)),
                      after = read_picture(out + "/p" + std::to_string(i) + ".tif");
        assert_int_equal(after.sample, sample);
        assert_int_equal(after.layout, LENSPROF_LAYOUT_RGB);
        for (size_t s = 0; s < width * height * 3; ++s) {
            const uint32_t x = uint32_t(s / 3 % width), y = uint32_t(s / 3 / width);
            const double light = value_of(before, s) / (falloff(x, y) * exposure(i, s % 3)) * wanted(i, s % 3);
            assert_close(value_of(after, s), light, 1.5 / 65535);
        }
    }
}

double mean_exposure(size_t, size_t channel) {
    double product = 1;
    for (size_t i = 0; i < 3; ++i) product *= exposure(i, channel);
    return std::cbrt(product);
}

void test_output_exposures(void **) {
    const Words words = {"apply", "--pto", make_project(), "--set"};
    must_exit(done, words + Words{"exposure=mean", "-o", work("mean")});
    check_pixels(work("mean"), LENSPROF_SAMPLE_U16, mean_exposure);
    must_exit(done, words + Words{"exposure=reference", "-o", work("reference")});
    check_pixels(work("reference"), LENSPROF_SAMPLE_U16, [](size_t, size_t) { return 1.0; });
    must_exit(done, words + Words{"exposure=keep", "-o", work("keep")});
    check_pixels(work("keep"), LENSPROF_SAMPLE_U16, exposure);
    must_exit(done, {"apply", "--pto", work("in/pano.pto"), "-o", work("default")});
    check_pixels(work("default"), LENSPROF_SAMPLE_U16, mean_exposure);
}

void test_linear_is_float(void **) {
    must_exit(done,
              {"apply", "--pto", make_project(), "--linear", "--set", "exposure=reference", "-o", work("linear")});
    check_pixels(work("linear"), LENSPROF_SAMPLE_F32, [](size_t, size_t) { return 1.0; });
    write_picture(work("in/p0.png"), make_picture(0));
    edit(work("in/pano.pto"), "p0\\.tif", "p0.png");
    must_exit(done, {"apply", "--pto", work("in/pano.pto"), "--linear", "-o", work("png"), work("in/p0.png")});
    assert_int_equal(read_header(work("png/p0.tif")).sample, LENSPROF_SAMPLE_F32);
}

// Float pictures may count electrons: what is linear is not clipped at 1.
void test_counts_are_not_clipped(void **) {
    fs::create_directories(work("counts"));
    Picture picture = make_picture(0, LENSPROF_SAMPLE_F32);
    auto *values = reinterpret_cast<float *>(picture.pixels.data());
    for (size_t i = 0; i < width * height * 3; ++i) values[i] *= 4000.0f;
    write_picture(work("counts/a.tif"), picture);
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    lensprof_response_set_linear(&p->response[0]);
    p->key.processing = LENSPROF_PROCESSING_RAW;
    p->vignetting[0].k[0] = k1, p->vignetting[0].k[1] = k2;
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("counts.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);
    must_exit(done,
              {"apply", "--profile", "1", "--db", work("counts.db"), "-o", work("counted"), work("counts/a.tif")});
    const Picture after = read_picture(work("counted/a.tif"));
    for (size_t s = 0; s < width * height * 3; ++s) {
        const double light = value_of(picture, s) / falloff(uint32_t(s / 3 % width), uint32_t(s / 3 / width));
        assert_close(value_of(after, s), light, 1e-4 * light);
    }
}

void test_simulate_undoes_correct(void **) {
    must_exit(done, {"apply", "--pto", make_project(), "--set", "exposure=keep", "-o", work("once")});
    fs::copy(work("in/pano.pto"), work("once/pano.pto"));
    must_exit(done,
              {"apply", "--pto", work("once/pano.pto"), "--set", "exposure=keep,simulate=yes", "-o", work("twice")});
    for (size_t i = 0; i < 3; ++i) {
        const Picture before = read_picture(picture_name(i)),
                      after = read_picture(work("twice/p" + std::to_string(i) + ".tif"));
        for (size_t s = 0; s < width * height * 3; ++s)
            assert_close(value_of(after, s), value_of(before, s), 2.0 / 65535);
    }
}

// A folder means its pictures, in order; other files in it are ignored.
void test_folder(void **) {
    make_project();
    write_picture(work("in/.hidden.tif"), make_picture(0));
    save_text(work("in/notes.txt"), "rain");
    fs::create_directory(work("in/more.tif"));
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("p.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);
    const Words words = {"apply", "--profile", "1", "--db", work("p.db"), "-o", work("out")};
    const Json json = json_of(words + Words{"--json", work("in")});
    assert_int_equal(json["pictures"].size(), 3);
    for (size_t i = 0; i < 3; ++i)
        assert_string_equal(json["pictures"][i]["file"].get<std::string>().c_str(), picture_name(i).c_str());
    fs::create_directory(work("empty"));
    assert_true(
        contains(run_words(words + Words{work("empty")}).err, work("empty") + ": is a folder without pictures"));
}

// Of a neutral scene through a lens whose falloff differs by channel, --chroma leaves the luminance and no colour; a
// profile with one curve changes nothing, which a note states.
void test_colour_alone(void **) {
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("p.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    p->vignetting[0].k[0] = -0.4;
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    p->vignettings = 3;
    for (int c = 0; c < 3; c++) p->vignetting[c].k[0] = -0.2 - 0.1 * c;
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);
    Picture scene_light = make_noise(64, 48, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    auto *values = reinterpret_cast<uint16_t *>(scene_light.pixels.data());
    for (size_t i = 0; i < size_t(64) * 48 * 3; i++) {
        const double r2 =
            lensprof_vignetting_r2(p->vignetting, 64, 48, double(i / 3 % 64), double(i / 3 / 64), nullptr);
        values[i] =
            static_cast<uint16_t>(std::lround(40000 * lensprof_vignetting_eval(&p->vignetting[i % 3], r2, nullptr)));
    }
    write_picture(work("flat.tif"), scene_light);
    const auto apply = [&](const char *id, const char *out) {
        return run_words(
            {"apply", "--profile", id, "--db", work("p.db"), work("flat.tif"), "--chroma", "-o", work(out)});
    };
    assert_int_equal(apply("2", "coloured").code, done);
    const Picture neutral = read_picture(work("coloured/flat.tif"));
    for (size_t i = 0; i < size_t(64) * 48 * 3; i += 3) {
        const auto luminance = [&](const Picture &picture) {
            return 0.2126 * value_of(picture, i) + 0.7152 * value_of(picture, i + 1)
                   + 0.0722 * value_of(picture, i + 2);
        };
        assert_close(luminance(neutral) / luminance(scene_light), 1.0, 0.002);
        assert_close(value_of(neutral, i) / value_of(neutral, i + 2), 1.0, 0.001);
    }
    const Outcome one_curve = apply("1", "plain");
    assert_int_equal(one_curve.code, done);
    assert_true(contains(one_curve.err, "one falloff for all channels"));
    assert_true(read_picture(work("plain/flat.tif")).pixels == scene_light.pixels);
}

// What lies outside of the image circle keeps its bytes, in the orientation of the picture, and a note states it.
void test_image_circle(void **) {
    const double half = std::hypot(64, 48) / 2;
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    p->key.processing = LENSPROF_PROCESSING_JPEG;
    p->vignetting[0].k[0] = -0.6;
    p->image_circle = {{0.15, 0.0}, 0.6};
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("p.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);
    Picture scene_light = make_noise(64, 48, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    for (size_t i = 0; i < size_t(64) * 48 * 3; i++)
        reinterpret_cast<uint16_t *>(scene_light.pixels.data())[i] = static_cast<uint16_t>(9000 + i % 977);
    write_picture(work("a.tif"), scene_light), write_picture(work("b.tif"), scene_light);
    const Outcome outcome =
        run_words({"apply", "--profile", "1", "--db", work("p.db"), work("a.tif"), work("b.tif"), "-o", work("out")});
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err,
                         "a.tif and 1 more: the image circle has a radius of 0.60 half diagonals; what lies "
                         "outside is left as it is"));
    const Picture corrected = read_picture(work("out/a.tif"));
    int kept = 0;
    for (size_t i = 0; i < size_t(64) * 48; i++) {
        const double x = (double(i % 64) - 31.5) / half, y = (double(i / 64) - 23.5) / half;
        const double gain = value_of(corrected, 3 * i) / value_of(scene_light, 3 * i);
        const bool is_outside = std::hypot(x - 0.15, y) > 0.6;
        kept += is_outside;
        assert_close(gain, is_outside ? 1.0 : 1.0 / (1.0 - 0.6 * (x * x + y * y)), 1e-3);
    }
    assert_true(kept > 500);
    const Outcome shown = run_words({"profile", "show", "1", "--db", work("p.db")});
    assert_true(contains(shown.out, "image circle of r = 0.600 about (0.150, 0.000)"));
}

// The keys strength and gain-cap limit the effect of the falloff; dither preserves the mean that rounding would change.
void test_strength_cap_and_dither(void **) {
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    p->vignetting[0].k[0] = -0.6;
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("p.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);
    Picture flat = make_noise(64, 48, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    std::fill(flat.pixels.begin(), flat.pixels.end(), uint8_t(40));
    write_picture(work("flat.png"), flat);
    const Words words = {"apply", "--profile", "1", "--db", work("p.db"), work("flat.png")};
    must_exit(done, words + Words{"--set", "strength=0.5", "-o", work("half")});
    must_exit(done, words + Words{"--set", "gain-cap=1.25", "-o", work("capped")});
    must_exit(done, words + Words{"--encoding", "dither=yes", "-o", work("dithered")});
    const Picture half = read_picture(work("half/flat.png")), capped = read_picture(work("capped/flat.png")),
                  dithered = read_picture(work("dithered/flat.png"));
    double sum[2] = {0, 0};
    for (uint32_t y = 0; y < 48; y++)
        for (uint32_t x = 0; x < 64; x++) {
            const double m = lensprof_vignetting_eval(
                p->vignetting, lensprof_vignetting_r2(p->vignetting, 64, 48, x, y, nullptr), nullptr);
            const size_t at = y * half.row_bytes + 3 * x;
            assert_close(half.pixels[at], 40 / (1 + 0.5 * (m - 1)), 0.6);
            assert_close(capped.pixels[at], 40 / std::max(m, 1 / 1.25), 0.6);
            assert_close(dithered.pixels[at], 40 / m, 1.0);
            if (x < 8 && y < 8) sum[0] += dithered.pixels[at], sum[1] += 40 / m;
        }
    assert_close(sum[0] / 64, sum[1] / 64, 0.1);
    for (const Words &wrong :
         {Words{"--set", "strength=1.5"}, Words{"--set", "gain-cap=0.5"}, Words{"--set", "strength=nan"}})
        must_exit(usage, words + wrong + Words{"-o", work("none")});
    assert_false(fs::exists(work("none")));
}

void test_some_pictures_of_a_project(void **) {
    const std::string pto = make_project();
    const Json json = json_of({"apply", "--pto", pto, "--json", "-o", work("out"), picture_name(2), picture_name(0)});
    assert_int_equal(json["pictures"].size(), 2);
    assert_string_equal(json["pictures"][0]["file"].get<std::string>().c_str(), picture_name(2).c_str());
    assert_string_equal(json["pictures"][1]["output"].get<std::string>().c_str(), work("out/p0.tif").c_str());
    assert_int_equal(std::distance(fs::directory_iterator(work("out")), fs::directory_iterator()), 2);
}

// The median disagreement of overlapping pictures at points known from the simulation, not from the fit.
double disagreement(const std::string &pictures) {
    std::vector<Picture> held;
    for (int i = 0; i < 4; ++i) held.push_back(read_picture(pictures + "/img00" + std::to_string(i) + ".png"));
    std::istringstream lines(text_of(scene("test_points.txt")));
    std::vector<double> squares;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream numbers(line);
        double column[6];
        for (double &number : column) numbers >> number;
        for (size_t c = 0; c < 3; ++c) {
            double value[2];
            for (size_t side = 0; side < 2; ++side) {
                const auto x = size_t(column[2 + 2 * side] + 0.5), y = size_t(column[3 + 2 * side] + 0.5);
                value[side] = held[size_t(column[side])].pixels[(y * 320 + x) * 3 + c];
            }
            squares.push_back((value[0] - value[1]) * (value[0] - value[1]));
        }
    }
    std::nth_element(squares.begin(), squares.begin() + long(squares.size() / 2), squares.end());
    return std::sqrt(squares[squares.size() / 2]);  // the median tolerates edges
}

void test_overlaps_agree_better(void **) {
    const std::string copy = copy_of("scene");
    must_exit(done, {"build", copy + "/pano.pto", "--no-store", "--write", std::string("pto=") + copy + "/out.pto"});
    for (const char *exposure : {"mean", "reference"}) {
        must_exit(done, {"apply", "--pto", copy + "/out.pto", "--set", std::string("exposure=") + exposure, "-o",
                         work(exposure)});
        const double before = disagreement(in_folder("scene")), after = disagreement(work(exposure));
        if (!(before > 10 && after < 3.5))
            fail_msg("%s: median difference: %.1f levels before, %.1f after", exposure, before, after);
    }
}

// Depth, size, format, colour profile, EXIF.
void check_kept(const std::string &from, const std::string &to) {
    const Picture before = read_header(from), after = read_header(to);
    assert_int_equal(after.sample, before.sample);
    assert_int_equal(after.layout, before.layout);
    assert_int_equal(after.width, before.width);
    assert_int_equal(after.height, before.height);
    assert_true(after.traits.format == before.traits.format);
    assert_false(before.icc.empty());
    assert_true(after.icc == before.icc);
    PictureMetadata a = read_metadata(from), b = read_metadata(to);
    assert_int_equal(b.key.processing, LENSPROF_PROCESSING_CORRECTED);
    a.key.processing = b.key.processing;
    assert_string_equal(a.key.camera_model, "Simulated Camera");
    assert_memory_equal(&a.key, &b.key, sizeof a.key);
    assert_true(a.exif_ev.has_value() && b.exif_ev.has_value());
    assert_close(*a.exif_ev, *b.exif_ev, 0);
    if (after.traits.format == FileFormat::jpeg) assert_true(after.traits.quantisation == before.traits.quantisation);
}

void test_pictures_keep_their_nature(void **) {
    const std::string copy = copy_of("mixed");
    for (const char *name : mixed_names) {
        Picture picture = read_picture(mixed(name));
        picture.icc = make_profile(false, 500);
        WriteOptions options;
        options.metadata_from = mixed(name);
        write_picture(copy + "/" + name, picture, options);
    }
    const Disk before = disk();
    must_exit(done, Words{"build", copy + "/pano.pto", "--db", work("p.db")} + quick);
    must_exit(done, {"apply", "--pto", copy + "/pano.pto", "--profile", "1", "--key", "processing=jpeg", "--db",
                     work("p.db"), "-o", work("out")});
    for (const char *name : mixed_names) {
        check_kept(copy + "/" + name, work("out/") + name);
        assert_true(load(copy + "/" + name) != load(work("out/") + name));
        assert_true(load(copy + "/" + name) == before.at(std::string("work/copy/") + name));
    }
    must_exit(done, {"apply", "--profile", "1", "--db", work("p.db"), "--linear", "-o", work("linear"),
                     copy + "/img005.jpg"});
    assert_int_equal(read_header(work("linear/img005.tif")).sample, LENSPROF_SAMPLE_F32);
    assert_true(read_metadata(work("linear/img005.tif")).exposure_time_s.has_value());
}

void test_profile_by_id_or_exif(void **) {
    const Words db = {"--db", work("p.db")};
    must_exit(done, Words{"build", scene("pano.pto")} + quick + db);
    must_exit(done, Words{"build", scene("pano.pto"), "--fit", "seed=2"} + quick + db);
    const Json by_exif =
        json_of(Words{"apply", "--profile", "auto", "--json", "-o", work("exif"), scene("img001.png")} + db);
    assert_int_equal(by_exif["pictures"][0]["profile"].get<int>(), 2);  // the newest
    must_exit(done, Words{"apply", "--profile", "2", "-o", work("two"), scene("img001.png")} + db);
    must_exit(done, Words{"apply", "--profile", "1", "-o", work("one"), scene("img001.png")} + db);
    assert_true(load(work("exif/img001.png")) == load(work("two/img001.png")));
    assert_true(load(work("exif/img001.png")) != load(work("one/img001.png")));
    // A single picture keeps its exposure: the middle stays, the corner gains what the falloff took, about 0.6 EV.
    const Picture before = read_picture(scene("img001.png")), after = read_picture(work("two/img001.png"));
    const size_t middle = (119 * 320 + 160) * 3;
    for (size_t c = 0; c < 3; ++c) assert_true(std::abs(before.pixels[middle + c] - after.pixels[middle + c]) <= 1);
    double sum[2] = {0, 0};
    for (size_t y = 0; y < 10; ++y)
        for (size_t s = 0; s < 30; ++s) {
            sum[0] += before.pixels[y * before.row_bytes + s];
            sum[1] += after.pixels[y * after.row_bytes + s];
        }
    assert_true(sum[1] > 1.1 * sum[0]);
}

// The gain grid of a stored profile is removed or applied in every pixel and channel.
void test_gain_grid_of_a_profile(void **) {
    const double flat = 20000;
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    p->grid.columns = 4, p->grid.rows = 3, p->grid.channels = 3;
    for (int i = 0; i < 36; i++) p->grid.attenuation[i] = 0.7f + 0.05f * float(i * 7 % 13);
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("p.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);

    Picture picture = make_noise(61, 45, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    std::fill_n(reinterpret_cast<uint16_t *>(picture.pixels.data()), 61 * 45 * 3, uint16_t(flat));
    write_picture(work("flat.png"), picture);
    const Words words = {"apply", "--profile", "1", "--db", work("p.db"), work("flat.png")};
    must_exit(done, words + Words{"-o", work("corrected")});
    must_exit(done, words + Words{"--set", "simulate=yes", "-o", work("simulated")});
    const Picture corrected = read_picture(work("corrected/flat.png")),
                  simulated = read_picture(work("simulated/flat.png"));
    for (uint32_t y = 0; y < 45; y++)
        for (uint32_t i = 0; i < 61 * 3; i++) {
            const double gain = lensprof_gain_grid_eval(&p->grid, 61, 45, i / 3, y, i % 3);
            const size_t at = y * corrected.row_bytes + 2 * i;
            uint16_t light, dark;
            std::memcpy(&light, &corrected.pixels[at], 2);
            std::memcpy(&dark, &simulated.pixels[at], 2);
            assert_close(light, flat / gain, 0.6);
            assert_close(dark, flat * gain, 0.6);
        }
}

void test_contact_sheet(void **) {
    const std::string sheet = work("sheet.png");
    const std::string said =
        must_exit(done, {"apply", "--pto", make_project(), "-o", work("out"), "--contact-sheet", sheet});
    assert_true(contains(said, sheet));
    const Picture picture = read_picture(sheet);
    assert_int_equal(picture.sample, LENSPROF_SAMPLE_U8);
    assert_true(picture.width >= 3 * width && picture.height >= 2 * height);
    // It replaces an older sheet, but not a photograph, and its name is checked before anything is written.
    const Words again = {"apply", "--pto", make_project(), "-o", work("more"), "--contact-sheet"};
    must_exit(done, again + Words{sheet});
    fs::remove_all(work("more"));
    must_exit(done, {"simulate", "-o", work("taken"), "--images", "2", "--size", "64x48", "--exif"});
    const std::string photograph = work("taken/img000.png");
    assert_refused(usage, again + Words{photograph}, {photograph, "is a photograph"});
    assert_refused(failed, again + Words{work("missing/sheet.png")}, {"missing"});
    assert_true(!fs::exists(work("more")) || fs::is_empty(work("more")));
}

// Two circles in one file: each is corrected by its own falloff, in Hugin's terms (r = 1 in the corner of the file),
// and its own exposure; what is of no circle stays.
void test_two_circles(void **) {
    struct Layout {
        uint32_t width, height, side;
        double x[2], y[2];
    };
    const Layout layouts[] = {{96, 48, 48, {23.5, 71.5}, {23.5, 23.5}},   // side by side
                              {96, 48, 48, {71.5, 23.5}, {23.5, 23.5}},   // the second one first
                              {40, 84, 40, {19.5, 19.5}, {19.5, 62.5}},   // one above the other
                              {120, 60, 50, {31.5, 85.5}, {30.5, 27.5}},  // with dark around
                              {90, 50, 50, {22.5, 66.5}, {24.5, 24.5}}};  // that overlap, beyond the file
    const double k[2][3] = {{-.6, -.1, -.9}, {-1.1, .3, -.4}}, ev[2] = {0, .6};
    uint64_t state = 1;
    for (const Layout &of : layouts) {
        Picture picture = make_noise(of.width, of.height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
        auto *codes = reinterpret_cast<uint16_t *>(picture.pixels.data());
        for (size_t i = 0; i < size_t(of.width) * of.height * 3; i++)
            codes[i] = static_cast<uint16_t>(65535 * (.05 + .15 * lp_random(&state)));
        fs::create_directories(work("in"));
        write_picture(work("in/pair.tif"), picture);
        std::ostringstream pto;
        for (int i = 0; i < 2; i++) {
            const double half = of.side / 2.0, left = of.x[i] + .5 - half, top = of.y[i] + .5 - half;
            pto << "i w" << of.width << " h" << of.height << " f2 v" << 200.0 * of.width / of.side << " Rt1 y"
                << 180 * i << " Eev" << -ev[i] << " Va1 Vb" << k[i][0] << " Vc" << k[i][1] << " Vd" << k[i][2] << " Vx"
                << of.x[i] - (of.width - 1) / 2.0 << " Vy" << of.y[i] - (of.height - 1) / 2.0 << " S" << left << ","
                << left + of.side << "," << top << "," << top + of.side << " Vm5 n\"pair.tif\"\n";
        }
        save_text(work("in/pair.pto"), pto.str());
        fs::remove_all(work("out"));
        const Json json = json_of({"apply", "--pto", work("in/pair.pto"), "--json", "-o", work("out")});
        assert_int_equal(json["pictures"].size(), 1);
        const Picture before = read_picture(work("in/pair.tif")), after = read_picture(work("out/pair.tif"));
        size_t inside = 0, outside = 0;
        for (uint32_t y = 0; y < of.height; y++)
            for (uint32_t x = 0; x < of.width; x++) {
                double distance[2], wanted = 1;
                for (int i = 0; i < 2; i++) distance[i] = std::hypot(x - of.x[i], y - of.y[i]);
                const int nearer = distance[1] < distance[0];
                const double depth = of.side / 2.0 - distance[nearer];
                if (std::fabs(depth) < 1.5 || std::fabs(distance[0] - distance[1]) < 3) continue;
                const double r = distance[nearer] / (std::hypot(of.width, of.height) / 2), s = r * r;
                const double m = 1 + s * (k[nearer][0] + s * (k[nearer][1] + s * k[nearer][2]));
                if (depth > 0) wanted = std::exp2(.3 - ev[nearer]) / m;  // .3: the mean exposure
                (depth > 0 ? inside : outside)++;
                for (uint32_t c = 0; c < 3; c++) {
                    const size_t at = (size_t(y) * of.width + x) * 3 + c;
                    assert_close(value_of(after, at), std::min(value_of(before, at) * wanted, 1.0), 2e-4);
                }
            }
        assert_true(inside > 500 && outside > 30);
    }
    const Words on = {"apply", "--pto", work("in/pair.pto"), "-o", work("more")};
    assert_refused(usage, on + Words{"--linear", "--merge"}, {"--merge", "crops of one file"});
    assert_refused(usage, {"build", work("in/pair.pto"), "--no-store", "--write", "preview=" + work("p.jpg")},
                   {"--write preview", "crops"});
    assert_refused(usage, {"align", "--project", work("in/pair.pto"), "-o", work("more")}, {"align", "crops"});
}

// Each crop is judged: the falloffs of a circle by its circle, that of a rectangle by its corners, and the largest
// lift.
void test_doubts_of_crops(void **) {
    fs::create_directories(work("in"));
    write_picture(work("in/pair.tif"), make_smooth(96, 48, LENSPROF_LAYOUT_RGB));
    const struct {
        const char *second;  // Vb of the second crop, and its exposure
        int circular;
        const char *warning;
    } cases[] = {{"Vb-0.5 Eev0", 1, ""},
                 {"Vb-0.5 Eev0", 0, ""},
                 {"Vb1 Eev0", 1, "its falloff rises"},
                 {"Vb1 Eev0", 0, "its falloff rises"},
                 {"Vb-2.45 Eev0", 1, ""},  // M = 0.51 at the edge of the circle, 0.02 in the corner
                 {"Vb-2.45 Eev0", 0, "its falloff falls"},
                 {"Vb-0.5 Eev8", 1, "lifted by 4.0 EV"}};
    for (const auto &of : cases) {
        std::ostringstream pto;
        for (int i = 0; i < 2; i++)
            pto << "i w96 h48 f2 v400 Rt1 y" << 180 * i << " Va1 " << (i ? of.second : "Vb-0.4 Eev0") << " Vx"
                << 48 * i - 24 << " S" << 48 * i << "," << 48 * i + 48 << ",0,48 Vm5 n\"pair.tif\"\n";
        std::string text = pto.str();
        if (!of.circular)
            for (size_t at; (at = text.find(" f2 ")) != text.npos;) text.replace(at, 4, " f3 ");
        save_text(work("in/pair.pto"), text);
        fs::remove_all(work("out"));
        const Outcome outcome = run_words({"apply", "--pto", work("in/pair.pto"), "-o", work("out")});
        assert_int_equal(outcome.code, done);
        const bool is_warned = contains(outcome.err, "its falloff") || contains(outcome.err, "lifted");
        if (is_warned != (*of.warning != 0) || !contains(outcome.err, of.warning))
            fail_msg("%s, %d: %s", of.second, of.circular, outcome.err.c_str());
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_output_exposures),
        CLI_TEST(test_linear_is_float),
        CLI_TEST(test_counts_are_not_clipped),
        CLI_TEST(test_simulate_undoes_correct),
        CLI_TEST(test_some_pictures_of_a_project),
        CLI_TEST(test_overlaps_agree_better),
        CLI_TEST(test_pictures_keep_their_nature),
        CLI_TEST(test_profile_by_id_or_exif),
        CLI_TEST(test_gain_grid_of_a_profile),
        CLI_TEST(test_contact_sheet),
        CLI_TEST(test_two_circles),
        CLI_TEST(test_doubts_of_crops),
        CLI_TEST(test_colour_alone),
        CLI_TEST(test_image_circle),
        CLI_TEST(test_strength_cap_and_dither),
        CLI_TEST(test_folder),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
