// `lensprof flat --fields` in process: pictures, pages, stacks and planes of different scenes under a known shading.
#include "cli_runs.hpp"

#include <lensprof/fields.h>

#include "photo/pictures/picture.hpp"

namespace {

using namespace cli_runs;

constexpr uint32_t width = 96, height = 72;
constexpr double pedestal = 120.0;

using Plane = std::vector<uint16_t>;

double shading(double x, double y) {
    const double u = x / width - 0.6, v = y / width - 0.3;
    return std::exp(-1.2 * (u * u + v * v));
}

// Bright cells on an even background; the camera uses 3 % of its range.
std::vector<Plane> scenes(size_t count, uint64_t random = 3) {
    std::vector<Plane> planes;
    for (size_t i = 0; i < count; i++) {
        std::vector<double> scene(size_t(width) * height, 800.0 * (0.6 + lp_random(&random)));
        for (int cell = 0; cell < 20; cell++) {
            const double x = width * lp_random(&random), y = height * lp_random(&random);
            const double size = 2.0 + 4.0 * lp_random(&random);
            for (uint32_t v = 0; v < height; v++)
                for (uint32_t u = 0; u < width; u++)
                    if (std::hypot(u - x, v - y) < size) scene[size_t(v) * width + u] += 2000.0;
        }
        Plane plane;
        for (uint32_t k = 0; k < width * height; k++)
            plane.push_back(static_cast<uint16_t>(
                std::lround(scene[k] * shading(k % width, k / width) + pedestal + 3.0 * lp_normal(&random))));
        planes.push_back(plane);
    }
    return planes;
}

Picture picture_of(const Plane &plane) {
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY);
    std::memcpy(picture.pixels.data(), plane.data(), plane.size() * 2);
    return picture;
}

std::string folder_of(const std::string &name, const std::vector<Plane> &planes) {
    const std::string folder = work(name);
    std::filesystem::create_directories(folder);
    for (size_t i = 0; i < planes.size(); i++)
        write_picture(folder + "/" + std::to_string(i) + ".tif", picture_of(planes[i]));
    return folder;
}

void put(Bytes &bytes, size_t at, size_t count, uint64_t value, bool big) {
    for (size_t i = 0; i < count; i++)
        bytes.at(at + i) = static_cast<uint8_t>(value >> 8 * (big ? count - 1 - i : i) & 255);
}

// TIFF with a directory per page (or for all of them: a stack of ImageJ), uncompressed.
Bytes tiff_of(const std::vector<Plane> &planes, const std::string &description, bool one_directory, bool big) {
    Bytes bytes(8);
    bytes[0] = bytes[1] = big ? 'M' : 'I';
    put(bytes, 2, 2, 42, big);
    size_t link = 4;  // where the place of the next directory belongs
    const size_t directories = one_directory ? 1 : planes.size(), plane_bytes = size_t(width) * height * 2;
    for (size_t page = 0; page < directories; page++) {
        const size_t text = bytes.size(), directory = text + (description.size() + 2) / 2 * 2;
        const uint64_t entries[][4] = {{256, 4, 1, width},
                                       {257, 4, 1, height},
                                       {258, 3, 1, 16},
                                       {259, 3, 1, 1},
                                       {262, 3, 1, 1},
                                       {270, 2, description.size() + 1, text},
                                       {273, 4, 1, directory + 2 + 10 * 12 + 4},
                                       {277, 3, 1, 1},
                                       {278, 4, 1, height},
                                       {279, 4, 1, plane_bytes}};
        bytes.resize(directory + 2 + 10 * 12 + 4);
        std::copy(description.begin(), description.end(), bytes.begin() + ptrdiff_t(text));
        put(bytes, link, 4, directory, big);
        put(bytes, directory, 2, 10, big);
        for (size_t i = 0; i < 10; i++) {
            const size_t at = directory + 2 + 12 * i;
            put(bytes, at, 2, entries[i][0], big), put(bytes, at + 2, 2, entries[i][1], big);
            put(bytes, at + 4, 4, entries[i][2], big);
            put(bytes, at + 8, entries[i][1] == 3 ? 2 : 4, entries[i][3], big);
        }
        link = directory + 2 + 10 * 12;
        for (size_t i = page; i < (one_directory ? planes.size() : page + 1); i++)
            for (uint16_t value : planes[i]) {
                bytes.resize(bytes.size() + 2);
                put(bytes, bytes.size() - 2, 2, value, big);
            }
    }
    return bytes;
}

// FITS: 16 bit with BZERO, of which BLANK may be undefined; or float.
Bytes fits_of(const std::vector<Plane> &planes, bool is_float, const std::string &more = "") {
    std::string head;
    const auto card = [&](const std::string &name, const std::string &value) {
        std::string line = name + std::string(8 - name.size(), ' ') + "= " + value;
        head += line + std::string(80 - line.size(), ' ');
    };
    card("SIMPLE", "T"), card("BITPIX", is_float ? "-32" : "16"), card("NAXIS", "3");
    card("NAXIS1", std::to_string(width)), card("NAXIS2", std::to_string(height));
    card("NAXIS3", std::to_string(planes.size()));
    if (!is_float) card("BZERO", "32768"), card("BSCALE", "1");
    if (!more.empty()) card("BLANK", more);
    head += "END" + std::string(77, ' ');
    head.resize((head.size() + 2879) / 2880 * 2880, ' ');
    Bytes bytes(head.begin(), head.end());
    for (const Plane &plane : planes)
        for (size_t i = 0; i < plane.size(); i++) {
            const bool is_hole = i % width < 12 && i / width < 12 && is_float;
            const float value = is_hole ? NAN : plane[i];
            uint32_t bits;
            std::memcpy(&bits, &value, 4);
            const size_t size = is_float ? 4 : 2;
            bytes.resize(bytes.size() + size);
            put(bytes, bytes.size() - size, size, is_float ? bits : uint64_t(uint16_t(plane[i] - 32768)), true);
        }
    bytes.resize((bytes.size() + 2879) / 2880 * 2880);
    return bytes;
}

Words fields(const Words &words) { return Words{"flat", "--fields"} + words; }

Words fits_fields(const char *name, const Words &options) { return fields({work(name)}) + options; }

// The largest error of the shading that JSON has, relative to the middle.
double error_of(const Json &json) {
    const Json &grid = json["shading"];
    const auto columns = grid["columns"].get<uint32_t>(), rows = grid["rows"].get<uint32_t>();
    double worst = 0.0;
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < columns; i++) {
            const double x = i * (width - 1.0) / (columns - 1), y = j * (height - 1.0) / (rows - 1);
            const double truth = shading(x, y) / shading(0.5 * (width - 1), 0.5 * (height - 1));
            worst = std::max(worst, std::fabs(grid["attenuation"][0][j][i].get<double>() / truth - 1.0));
        }
    return worst;
}

// A folder is measured, stored, and the profile then corrects its pictures.
void test_a_folder_is_measured_and_corrected(void **) {
    const std::string folder = folder_of("slides", scenes(10)), db = work("fields.db");
    const Words words = fields({folder, "--camera", "Orca", "--lens", "10x", "--db", db, "-o", work("shading.tif"),
                                "--report", work("report.html")});
    const Json json = json_of(words + Words{"--json"});
    assert_true(json["usable"].get<bool>());
    assert_string_equal(json["method"].get<std::string>().c_str(), "fields");
    assert_int_equal(json["used"].get<int>(), 10);
    assert_true(error_of(json) < 0.02);
    const Json &channel = json["channels"][0];
    assert_true(channel["offset_found"].get<bool>());
    assert_close(channel["offset"].get<double>(), pedestal, 4.0);
    assert_int_equal(channel["smoothnesses"].size(), 24);
    assert_true(json["images"][3]["level"][0].get<double>() > 300.0);
    const Picture map = read_picture(work("shading.tif"));
    assert_true(map.width == width && map.height == height && map.sample == LENSPROF_SAMPLE_F32);
    const auto *value = reinterpret_cast<const float *>(map.pixels.data());
    assert_close(value[5 * width + 7] * shading(0.5 * (width - 1), 0.5 * (height - 1)) / shading(7, 5), 1.0, 0.01);
    assert_true(contains(text_of(work("report.html")), "Shading of many pictures"));

    const std::string printed = must_exit(done, fields({folder, "--no-store"}));
    assert_true(contains(printed, "pictures  10 of 10 in 10 files, 96 x 72 px"));
    assert_true(contains(printed, "of 65535"));
    const Words apply = {"apply", "--profile", "1", "--db", db, folder + "/0.tif", "-o", work("corrected")};
    must_exit(done, apply);
    const Picture before = read_picture(folder + "/0.tif"), after = read_picture(work("corrected/0.tif"));
    const auto at = [](const Picture &picture, size_t i) {
        return reinterpret_cast<const uint16_t *>(picture.pixels.data())[i];
    };
    for (size_t i : {size_t(0), size_t(1000), size_t(width) * height - 1}) {
        const double s = shading(double(i % width), double(i / width)) / shading(0.5 * (width - 1), 0.5 * (height - 1));
        assert_close((at(after, i) - pedestal) / ((at(before, i) - pedestal) / s), 1.0, 0.03);
    }
}

Plane dark_frame(double level) {
    Plane plane;
    uint64_t random = 9;
    for (uint32_t k = 0; k < width * height; k++)
        plane.push_back(static_cast<uint16_t>(std::lround(level + 3.0 * lp_normal(&random))));
    return plane;
}

// Pictures without light give the offset; what lies at a stated white level or above is saturated.
void test_dark_frames_and_white_level(void **) {
    const std::string folder = folder_of("with_dark", scenes(6)),
                      dark = folder_of("dark_frames", {dark_frame(pedestal)}) + "/0.tif";
    const Json json = json_of(fields({folder, "--no-store", "--json", "--dark", dark}));
    assert_close(json["channels"][0]["offset"].get<double>(), pedestal, 0.2);
    assert_false(json["channels"][0]["offset_found"].get<bool>());
    assert_true(error_of(json) < 0.02);
    const Json stated = json_of(fields({folder, "--no-store", "--json", "--dark", dark, "--fit", "white-level=2000"}));
    assert_true(stated["white_share"].get<double>() > json["white_share"].get<double>() + 0.05);
    assert_true(error_of(stated) < 0.02);
    std::filesystem::copy_file(dark, folder + "/dark.tif");  // which is not a picture with light
    const Json among = json_of(fields({folder, "--no-store", "--json", "--dark", folder + "/dark.tif"}));
    assert_true(among["shading"] == json["shading"] && among["used"] == json["used"]);
    std::filesystem::remove(folder + "/dark.tif");
    assert_refused(usage, fields({folder, "--no-store", "--dark", dark, "-o", dark}),
                   {"0.tif", "would be overwritten"});
}

// Float counts, of which dark frames lie near 0 or above 1: the unit is that of the pictures.
void test_dark_frames_of_float_counts(void **) {
    if (!can_read_fits()) return;
    for (const double level : {0.0, 0.6, pedestal}) {
        std::vector<Plane> planes = scenes(8);
        const std::string name = std::to_string(static_cast<int>(10.0 * level)),
                          file = work("pictures" + name + ".fits"), dark = work("dark" + name + ".tif");
        for (Plane &plane : planes)
            for (uint16_t &value : plane) value = static_cast<uint16_t>(value - pedestal + level);
        save(file, fits_of(planes, true));
        Picture frame = make_noise(width, height, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_GREY);
        auto *sample = reinterpret_cast<float *>(frame.pixels.data());
        uint64_t random = 5;
        for (size_t i = 0; i < size_t(width) * height; i++)
            sample[i] = static_cast<float>(level + 3.0 * lp_normal(&random));
        write_picture(dark, frame);
        const Json json = json_of(fields({file, "--no-store", "--json", "--dark", dark}));
        assert_close(json["channels"][0]["offset"].get<double>(), level, 0.3);
        for (size_t i = 0; i < size_t(width) * height; i++) sample[i] = static_cast<float>(level + 8.0 * (i % width));
        write_picture(dark, frame);
        assert_refused(not_usable, fields({file, "--no-store", "--dark", dark}), {dark, "is not dark"});
    }
}

std::string float_folder_of(const std::string &name, const std::vector<Plane> &planes, double unit) {
    const std::string folder = work(name);
    std::filesystem::create_directories(folder);
    for (size_t i = 0; i < planes.size(); i++) {
        Picture picture = make_noise(width, height, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_GREY);
        auto *sample = reinterpret_cast<float *>(picture.pixels.data());
        for (size_t n = 0; n < planes[i].size(); n++) sample[n] = static_cast<float>(planes[i][n] / unit);
        write_picture(folder + "/" + std::to_string(i) + ".tif", picture);
    }
    return folder;
}

// A share among counts, or the reverse, is refused with the unit.
void test_units_of_levels(void **) {
    const std::vector<Plane> covered = {dark_frame(pedestal)};
    const std::string counts = float_folder_of("unit_counts", scenes(6), 1.0),
                      shares = float_folder_of("unit_shares", scenes(6), 4095.0),
                      dark_counts = float_folder_of("unit_dark_counts", covered, 1.0) + "/0.tif",
                      dark = float_folder_of("unit_dark", covered, 4095.0) + "/0.tif";
    const struct {
        Words words, named;
    } cases[] = {
        {{counts, "--black", "0.05"}, {"0.tif", "are counts", "a level of 0.05", "such as 200"}},
        {{counts, "--dark", dark}, {dark, "its level is 0.029", "are counts", "--black"}},
        {{counts, "--fit", "white-level=0.9"}, {"0.tif", "are counts", "a level of 0.9", "such as 4095"}},
        {{counts, "--fit", "white-level=1"}, {"0.tif", "are counts", "a level of 1"}},
        {{shares, "--dark", dark_counts}, {dark_counts, "its level is 1", "full scale of " + shares, "unit"}},
    };
    for (const auto &one : cases) assert_refused(usage, fields(one.words + Words{"--no-store"}), one.named);
    const Json json = json_of(fields({shares, "--no-store", "--json", "--dark", dark}));
    assert_close(json["channels"][0]["offset"].get<double>(), pedestal / 4095.0, 0.0005);
}

// A profile has no place for the offset of counts in float samples: both commands state it.
void test_offset_of_float_counts_is_noted(void **) {
    if (!can_read_fits()) return;
    const std::string db = work("counts.db"), file = work("counts.fits"), one = work("one.fits");
    save(file, fits_of(scenes(8), true));
    const Outcome flat =
        run_words(fields({file, "--camera", "Orca", "--lens", "10x", "--key", "processing=raw", "--db", db}));
    assert_true(contains(flat.err, "the profile cannot hold the offset of 1"));
    assert_refused(usage, fields({file, "--no-store", "--black", "5%"}), {"counts.fits", "as counts"});
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_GREY);
    auto *sample = reinterpret_cast<float *>(picture.pixels.data());
    for (size_t i = 0; i < size_t(width) * height; i++) sample[i] = 700.0f;
    write_picture(work("counts.tif"), picture);
    const Words apply = {"apply", "--profile", "1", "--db", db, "-o", work("flattened"), "--overwrite"};
    const Outcome counts = run_words(apply + Words{work("counts.tif")});
    assert_int_equal(counts.code, done);
    assert_true(contains(counts.err, "counts.tif: has float samples above 1, and the profile holds no offset"));
    for (size_t i = 0; i < size_t(width) * height; i++) sample[i] = 0.7f;
    write_picture(work("shares.tif"), picture);
    assert_false(contains(run_words(apply + Words{work("shares.tif")}).err, "offset"));
}

// Pages, slices of ImageJ in both byte orders, and planes of FITS are the same pictures as files.
void test_pages_stacks_and_planes(void **) {
    const auto planes = scenes(8);
    Json first = json_of(fields({folder_of("files", planes), "--no-store", "--json", "--black", "120"}));
    const auto same_shading = [&](const std::string &name, const Bytes &bytes) {
        save(work(name), bytes);
        const Json json = json_of(fields({work(name), "--no-store", "--json", "--black", "120"}));
        assert_int_equal(json["used"].get<int>(), 8);
        assert_true(json["shading"] == first["shading"]);
        assert_true(contains(json["images"][1]["file"].get<std::string>(), ", page 2"));
    };
    same_shading("pages.tif", tiff_of(planes, "of a microscope", false, false));
    const std::string imagej = "ImageJ=1.53t\nimages=8\nslices=8\n";
    same_shading("stack.tif", tiff_of(planes, imagej, true, true));
    same_shading("little.tif", tiff_of(planes, imagej, true, false));
    if (can_read_fits()) same_shading("planes.fits", fits_of(planes, false));
}

void test_channels_of_stacks(void **) {
    std::vector<Plane> planes;
    const auto wanted = scenes(6), other = scenes(6, 77);
    for (size_t i = 0; i < 6; i++) planes.push_back(other[i]), planes.push_back(wanted[i]);
    const Json alone = json_of(fields({folder_of("wanted", wanted), "--no-store", "--json", "--black", "120"}));
    const auto second_channel = [&](const std::string &name, const Bytes &bytes) {
        save(work(name), bytes);
        assert_refused(usage, fields({work(name), "--no-store"}), {name, "has 2 channels", "--fit channel"});
        assert_refused(usage, fields({work(name), "--no-store", "--fit", "channel=3"}),
                       {name, "has 2 channels, not 3"});
        const Json json = json_of(fields({work(name), "--no-store", "--json", "--fit", "channel=2", "--black", "120"}));
        assert_true(json["shading"] == alone["shading"]);
    };
    second_channel("imagej.tif", tiff_of(planes, "ImageJ=1.53t\nimages=12\nchannels=2\nframes=6\n", true, true));
    const std::string ome =
        "<?xml version=\"1.0\"?><OME><Image><Pixels DimensionOrder=\"XYCTZ\" SizeC=\"2\" SizeT=\"6\" "
        "SizeZ=\"1\"><Channel SamplesPerPixel=\"1\"/></Pixels></Image></OME>";
    second_channel("ome.tif", tiff_of(planes, ome, false, false));
}

// Without --fields one picture of a file is used: a note of `flat`, and a refusal of `apply`.
void test_files_of_several_pictures_are_noted(void **) {
    const auto planes = scenes(3);
    const std::string db = work("several.db");
    must_exit(done, fields({folder_of("single", scenes(4)), "--camera", "Orca", "--lens", "10x", "--black", "120",
                            "--db", db}));
    save(work("several.tif"), tiff_of(planes, "", false, false));
    save(work("slices.tif"), tiff_of(planes, "ImageJ=1.53t\nimages=3\nslices=3\n", true, true));
    std::vector<std::pair<std::string, std::string>> files = {{"several.tif", "has 3 pages"},
                                                              {"slices.tif", "is a stack of 3 slices"}};
    if (can_read_fits()) {
        save(work("cube.fits"), fits_of(planes, false));
        files.emplace_back("cube.fits", "has 3 planes");
    }
    for (const auto &[name, what] : files) {
        const Outcome flat = run_words({"flat", work(name), "--linear", "--no-store"});
        assert_true(contains(flat.err, name + ": " + what + "; only the first is used"));
        assert_true(contains(flat.err, "`lensprof flat --fields`"));
        const Outcome apply = run_words({"apply", "--profile", "1", "--db", db, work(name), "-o", work("none.tif")});
        assert_true(apply.code != done && contains(apply.err, name + ": " + what));
        assert_false(fs::exists(work("none.tif")));
    }
}

// The limit of pictures is an error, before any is read.
void test_too_many_pages(void **) {
    const size_t pages = LENSPROF_FIELDS_IMAGES + 1;
    Bytes bytes = {'I', 'I', 42, 0, 8, 0, 0, 0};
    for (size_t page = 0; page < pages; page++) {
        const uint32_t entries[][2] = {{256, 8}, {257, 8}, {258, 8}, {259, 1}, {262, 1}, {273, 8}, {278, 8}, {279, 64}};
        const size_t at = bytes.size(), next = at + 2 + 8 * 12;
        bytes.resize(next + 4);
        put(bytes, at, 2, 8, false);
        for (size_t i = 0; i < 8; i++) {
            const size_t entry = at + 2 + 12 * i;
            put(bytes, entry, 2, entries[i][0], false), put(bytes, entry + 2, 2, 4, false);
            put(bytes, entry + 4, 4, 1, false), put(bytes, entry + 8, 4, entries[i][1], false);
        }
        put(bytes, next, 4, page + 1 < pages ? bytes.size() : 0, false);
    }
    save(work("many.tif"), bytes);
    assert_refused(usage, fields({work("many.tif"), "--no-store"}), {"many.tif", "more than 16384"});
}

// What cannot be read is left out, with a message that names it; the rest is measured.
void test_damaged_files_are_left_out(void **) {
    const auto planes = scenes(9);
    const std::string folder = folder_of("damaged", planes);
    Bytes bytes = load(folder + "/4.tif");
    bytes.resize(bytes.size() / 2);
    save(folder + "/4.tif", bytes);
    save_text(folder + "/5.tif", "no picture");
    const Outcome outcome = run_words(fields({folder, "--no-store", "--black", "120"}));
    assert_int_equal(outcome.code, unreadable);
    assert_true(contains(outcome.out, "pictures  7 of 7 in 8 files"));
    assert_true(contains(outcome.err, "4.tif") && contains(outcome.err, "5.tif") && contains(outcome.err, "left out"));
    Bytes pages = tiff_of(planes, "", false, false);
    pages.resize(pages.size() * 2 / 3);
    save(work("cut.tif"), pages);
    const Json json = json_of(fields({work("cut.tif"), "--no-store", "--json", "--black", "120"}), unreadable);
    assert_true(json["used"].get<int>() >= 5);
    assert_true(contains(json["left_out"][0].get<std::string>(), "truncated"));
    save(work("cut_stack.tif"), tiff_of(planes, "ImageJ=1.53t\nimages=11\nslices=11\n", true, true));
    const Json stack = json_of(fields({work("cut_stack.tif"), "--no-store", "--json", "--black", "120"}), unreadable);
    assert_int_equal(stack["used"].get<int>(), 9);
    assert_true(contains(stack["left_out"][0].get<std::string>(), "after page 9"));
}

void test_fits_with_undefined_samples(void **) {
    const auto planes = scenes(8);
    save(work("nan.fits"), fits_of(planes, true));
    if (!can_read_fits()) {
        assert_refused(unreadable, fields({work("nan.fits"), "--no-store"}), {"nan.fits", "cfitsio"});
        return;
    }
    const Json json = json_of(fields({work("nan.fits"), "--no-store", "--json"}));
    assert_true(json["unseen_share"].get<double>() > 0.01);
    assert_close(json["channels"][0]["offset"].get<double>(), pedestal, 4.0);
    assert_true(error_of(json) < 0.06);  // continued into the corner without samples
    save(work("blank.fits"), fits_of(planes, false, "-32000"));
    assert_close(json_of(fields({work("blank.fits"), "--no-store", "--json"}))["full_scale"].get<double>(), 1.0, 0.0);
    Bytes cut = fits_of(planes, false);
    cut.resize(cut.size() / 2);
    save(work("cut.fits"), cut);
    const Json rest = json_of(fields({work("cut.fits"), "--no-store", "--json"}), unreadable);
    assert_true(rest["used"].get<int>() >= 3 && rest["left_out"].size() >= 3);
}

// A header of a FITS extension, and an image of it with this value everywhere.
Bytes extension_of(uint32_t columns, uint32_t rows, uint16_t value) {
    std::string head;
    for (const std::string &card :
         {std::string("XTENSION= 'IMAGE   '"), std::string("BITPIX  = 16"), std::string("NAXIS   = 2"),
          "NAXIS1  = " + std::to_string(columns), "NAXIS2  = " + std::to_string(rows), std::string("PCOUNT  = 0"),
          std::string("GCOUNT  = 1"), std::string("BZERO   = 32768"), std::string("BSCALE  = 1"), std::string("END")})
        head += card + std::string(80 - card.size(), ' ');
    head.resize((head.size() + 2879) / 2880 * 2880, ' ');
    Bytes bytes(head.begin(), head.end());
    for (size_t i = 0; i < size_t(columns) * rows; i++) {
        bytes.resize(bytes.size() + 2);
        put(bytes, bytes.size() - 2, 2, uint64_t(uint16_t(value - 32768)), true);
    }
    bytes.resize((bytes.size() + 2879) / 2880 * 2880);
    return bytes;
}

// Images of another size are named and left out; what follows the last part and is not one is named, too.
void test_parts_of_fits(void **) {
    if (!can_read_fits()) return;
    const Bytes planes = fits_of(scenes(8), false), small = extension_of(16, 12, 500);
    const auto joined_bytes = [](Bytes a, const Bytes &b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    const Words options = {"--no-store", "--json", "--black", "120"};
    save(work("alone.fits"), planes);
    save(work("weights.fits"), joined_bytes(planes, small));
    const Outcome weights = run_words(fits_fields("weights.fits", options));
    assert_int_equal(weights.code, done);
    assert_true(contains(weights.err,
                         "weights.fits: has images of another size than its first, which are left out: "
                         "part 2, 16 x 12 px"));
    const Json alone = json_of(fits_fields("alone.fits", options));
    assert_true(parsed(weights.out)["shading"] == alone["shading"]);
    Bytes damaged = joined_bytes(planes, extension_of(width, height, 500));
    std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(planes.size()), 80, uint8_t('x'));
    save(work("damaged.fits"), damaged);
    const Json rest = json_of(fits_fields("damaged.fits", options), unreadable);
    assert_int_equal(rest["used"].get<int>(), 8);
    assert_true(contains(rest["left_out"][0].get<std::string>(), "damaged.fits: the pages after page 8"));
    Bytes padded = planes;
    padded.resize(padded.size() + 2880);
    save(work("padded.fits"), padded);
    assert_true(json_of(fits_fields("padded.fits", options))["left_out"].empty());
}

// The profile of pictures that are stated to be linear is for linear ones.
void test_linear_pictures(void **) {
    const std::string folder = folder_of("linear", scenes(6)), db = work("linear.db");
    const Words words = fields({folder, "--camera", "Orca", "--lens", "10x", "--black", "120", "--db", db});
    must_exit(done, words);
    const Outcome linear = run_words(words + Words{"--linear"});
    assert_int_equal(linear.code, done);
    assert_true(contains(linear.err, "lensprof apply --key processing=raw"));
    const auto processing = [&](const char *id) {
        return json_of({"profile", "show", id, "--json", "--db", db})["key"]["processing"];
    };
    assert_true(processing("1") == "jpeg" && processing("2") == "raw");
}

void test_refused(void **) {
    const auto planes = scenes(3);
    const std::string folder = folder_of("few", planes), same = folder_of("same", {planes[0], planes[0], planes[0]});
    const std::string black = folder_of("black", {Plane(size_t(width) * height)}), empty = work("empty");
    std::filesystem::create_directories(empty);
    std::vector<Plane> shut(4);
    uint64_t random = 9;
    for (Plane &plane : shut)
        for (uint32_t k = 0; k < width * height; k++)
            plane.push_back(static_cast<uint16_t>(std::lround(pedestal + 3.0 * lp_normal(&random))));
    const std::string dark = folder_of("dark", shut);
    const std::string sizes = folder_of("sizes", planes), kinds = folder_of("kinds", planes);
    write_picture(sizes + "/9.tif", make_noise(width, height - 8, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY));
    Picture small = make_noise(width, height - 8, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY);
    std::fill(small.pixels.begin(), small.pixels.end(), uint8_t(0));
    write_picture(work("small.tif"), small);
    write_picture(kinds + "/8.png", make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB));
    const struct {
        int code;
        Words words, named;
    } cases[] = {
        {usage, {empty, "--no-store"}, {"empty", "without pictures"}},
        {unreadable, {work("no.tif"), "--no-store"}, {"no.tif"}},
        {not_usable, {same, "--no-store"}, {"same", "fields_few"}},
        {not_usable, {black, "--no-store"}, {"black", "no", "light"}},
        {not_usable, {dark, "--no-store"}, {"dark", "none of the 4 pictures shows light above its offset"}},
        {not_usable, {dark, "--no-store", "--black", "118"}, {"dark", "none of the 4 pictures shows light"}},
        {unreadable, {sizes, "--no-store"}, {"9.tif", "96 x 64", "0.tif"}},
        {usage, {kinds, "--no-store"}, {"8.png", "in colour"}},
        {usage, {folder}, {"0.tif", "--camera", "--lens"}},
        {usage, {folder, "--no-store", "--rotation", "0"}, {"--rotation", "--fields"}},
        {usage, {folder, "--no-store", "-o", "x.xml"}, {"x.xml", ".tif"}},
        {usage, {folder, "--no-store", "--black", "60000"}, {"darker than the black level", "--black"}},
        {usage, {folder, "--no-store", "-o", folder + "/0.tif"}, {"among the pictures"}},
        {not_usable, {folder, "--no-store", "--dark", sizes + "/9.tif"}, {"9.tif", "is not dark"}},
        {usage, {folder, "--no-store", "--dark", work("small.tif")}, {"small.tif", "96 x 64 px", "give dark frames"}},
        {usage, {folder, "--no-store", "--dark", folder + "/0.tif", "--black", "3"}, {"--dark", "--black"}},
        {usage, {folder, "--no-store", "--dark", folder + "/0.tif", "--fit", "gamma=2.2"}, {"--dark"}},
        {usage, {folder, "--no-store", "--fit", "white-level=70000"}, {"--fit white-level", "65535"}},
        {usage, {folder, "--no-store", "--black", "120", "--fit", "white-level=100"}, {"0.tif", "not below its white"}},
        {usage, {folder, "--no-store", "--black", "3", "--fit", "gamma=2.2"}, {"--black"}},
    };
    for (const auto &one : cases) assert_refused(one.code, fields(one.words), one.named);
    assert_refused(usage, {"flat", folder, "--no-store", "--linear", "--fit", "channel=2"}, {"--fields"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_a_folder_is_measured_and_corrected),
        CLI_TEST(test_dark_frames_and_white_level),
        CLI_TEST(test_dark_frames_of_float_counts),
        CLI_TEST(test_units_of_levels),
        CLI_TEST(test_offset_of_float_counts_is_noted),
        CLI_TEST(test_pages_stacks_and_planes),
        CLI_TEST(test_channels_of_stacks),
        CLI_TEST(test_files_of_several_pictures_are_noted),
        CLI_TEST(test_too_many_pages),
        CLI_TEST(test_damaged_files_are_left_out),
        CLI_TEST(test_fits_with_undefined_samples),
        CLI_TEST(test_parts_of_fits),
        CLI_TEST(test_linear_pictures),
        CLI_TEST(test_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
