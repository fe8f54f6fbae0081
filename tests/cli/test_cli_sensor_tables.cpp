// `lensprof flat -o FILE.json`: shading tables of a sensor at several colour temperatures, for the Raspberry Pi.
#include "raw_runs.hpp"

#include "photo/base/format.hpp"
#include "photo/cards/card_names.hpp"

namespace {

using namespace raw_runs;

constexpr uint32_t width = 240, height = 180;
constexpr double temperatures[] = {2850, 4000, 6500};

// k1 of red, green and blue: infrared filters of small cameras shade colours by the light.
std::array<double, 3> k1_at(double temperature) {
    const double warm = (4000.0 - temperature) / 4000.0;
    return {-0.45 + 0.08 * warm, -0.45, -0.45 - 0.06 * warm};
}

double falloff_at(double k1, double r2) { return 1.0 + r2 * (k1 + r2 * (0.05 - 0.02 * r2)); }

double r2_at(double x, double y) {
    const lensprof_vignetting centred{{-0.4, 0.0, 0.0}, {0.0, 0.0}};
    return lensprof_vignetting_r2(&centred, width, height, x, y, nullptr);
}

// A mosaic with a black level, as a DNG.
void shoot_mosaic(const std::string &name, double temperature, uint64_t seed) {
    Dng dng;
    dng.width = width, dng.height = height, dng.white = 4095, dng.black = {256, 256, 256, 256};
    dng.maker = "Raspberry Pi", dng.model = "imx477";
    const double colour[] = {0.35, 0.55, 0.4};
    uint64_t random = seed;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const uint8_t channel = dng.pattern[y % 2 * 2 + x % 2];
            const double light =
                colour[channel] * falloff_at(k1_at(temperature)[channel], r2_at(x, y)) + 0.002 * lp_normal(&random);
            dng.values.push_back(static_cast<uint16_t>(std::lround(256.0 + light * (4095.0 - 256.0))));
        }
    const std::string path = in_folder(name);
    fs::create_directories(fs::path(path).parent_path());
    save(path, dng_bytes(dng));
}

// Linear TIFF of 16 bits, grey or colour.
void shoot_tiff(const std::string &name, double temperature, uint32_t layout, uint64_t seed) {
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_U16, layout);
    auto *at = reinterpret_cast<uint16_t *>(picture.pixels.data());
    uint64_t random = seed;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < (layout == LENSPROF_LAYOUT_RGB ? 3u : 1u); c++) {
                const double k1 = layout == LENSPROF_LAYOUT_RGB ? k1_at(temperature)[c] : -0.45;
                *at++ = static_cast<uint16_t>(
                    std::lround(65535.0 * (0.5 * falloff_at(k1, r2_at(x, y)) + 0.002 * lp_normal(&random))));
            }
    const std::string path = in_folder(name);
    fs::create_directories(fs::path(path).parent_path());
    write_picture(path, picture, {});
}

Words tables_of(const Words &inputs, const std::string &file, const Words &more = {}) {
    return Words{"flat"} + inputs + Words{"--linear", "--black", "0", "--no-store", "-o", file} + more;
}

// The tables of the file at a temperature, read as by any program, are the truth within 0.5 %.
void assert_truth(const std::string &file, double temperature) {
    const std::string db = in_folder("back.db");
    fs::remove(db);
    must_exit(done, {"profile", "import", file, "--db", db, "--camera", "imx477", "--encoding",
                     format("frame=%ux%u,color-temperature=%g", width, height, temperature)});
    const Json profile = json_of({"profile", "show", "1", "--db", db, "--json"});
    assert_true(profile["key"]["color_temperature_k"] == temperature);
    const Json k = profile["vignetting"]["k"], centre = profile["vignetting"]["center"];
    assert_int_equal(k.size(), 3);
    for (size_t c = 0; c < 3; c++)
        for (const double r2 : {0.25, 0.5, 0.8})
            assert_float_equal(
                1.0 + r2 * (k[c][0].get<double>() + r2 * (k[c][1].get<double>() + r2 * k[c][2].get<double>())),
                falloff_at(k1_at(temperature)[c], r2), 0.005);
    assert_float_equal(centre[0].get<double>(), 0.0, 0.005);
}

// Raw files in a folder per temperature, in any order.
void test_raw_folders(void **) {
    needs_libraw();
    for (const double temperature : temperatures) shoot_mosaic(format("raw/%gK/card.dng", temperature), temperature, 3);
    const std::string file = in_folder("raw.json"), other = in_folder("other.json");
    must_exit(done, {"flat", in_folder("raw"), "--no-store", "-o", file});
    const Json alsc = parsed(text_of(file))["rpi.alsc"];
    assert_int_equal(alsc["calibrations_Cr"].size(), 3);
    assert_int_equal(alsc["calibrations_Cb"].size(), 3);
    assert_int_equal(alsc["luminance_lut"].size(), 16 * 12);
    for (size_t n = 0; n < 3; n++) {
        assert_true(alsc["calibrations_Cr"][n]["ct"] == temperatures[n]);
        assert_truth(file, temperatures[n]);
    }
    must_exit(done, {"flat", in_folder("raw/6500K"), in_folder("raw/2850K"), in_folder("raw/4000K"), "--no-store", "-o",
                     other});
    assert_true(text_of(other) == text_of(file));
}

// Names as the tuning tool's, tables for a Pi 5, and one temperature that an option states.
void test_names_and_options(void **) {
    for (const double temperature : temperatures)
        for (int n = 0; n < 2; n++)
            shoot_tiff(format("names/alsc_%gk_%d.tif", temperature, n), temperature, LENSPROF_LAYOUT_RGB, 5 + n);
    const std::string file = in_folder("names.json");
    must_exit(done, tables_of({in_folder("names")}, file));
    for (const double temperature : temperatures) assert_truth(file, temperature);
    const Json small = parsed(text_of(file))["rpi.alsc"];
    must_exit(done, tables_of({in_folder("names")}, file, {"--fit", "tables=32x32"}));
    const Json alsc = parsed(text_of(file))["rpi.alsc"];
    assert_int_equal(alsc["luminance_lut"].size(), 32 * 32);
    assert_true(small["sigma"].get<double>() > alsc["sigma"].get<double>() && alsc["sigma"].get<double>() > 0.0);
    shoot_tiff("plain/1.tif", 6500, LENSPROF_LAYOUT_RGB, 9);
    const std::string unknown = must_exit(done, tables_of({in_folder("plain")}, file));
    assert_true(contains(unknown, "no colour temperature is stated"));
    assert_true(parsed(text_of(file))["rpi.alsc"]["calibrations_Cr"][0]["ct"] == 4500);
    must_exit(done, tables_of({in_folder("plain")}, file, {"--key", "temperature=6500K"}));
    assert_truth(file, 6500);
}

// Grey pictures have the luminance table alone.
void test_a_mono_sensor(void **) {
    for (const double temperature : {2850, 6500})
        shoot_tiff(format("mono/%gK.tif", double(temperature)), temperature, LENSPROF_LAYOUT_GREY,
                   static_cast<uint64_t>(temperature));
    const std::string file = in_folder("mono.json");
    const std::string out = must_exit(done, tables_of({in_folder("mono")}, file));
    assert_false(contains(out, "luminance table"));
    const Json alsc = parsed(text_of(file))["rpi.alsc"];
    assert_false(alsc.contains("calibrations_Cr"));
    assert_float_equal(alsc["luminance_lut"][0].get<double>() / alsc["luminance_lut"][16 * 6 + 8].get<double>(),
                       falloff_at(-0.45, r2_at(width / 2.0, height / 2.0))
                           / falloff_at(-0.45, r2_at(width / 32.0 - 0.5, height / 24.0 - 0.5)),
                       0.01);
    must_exit(done, {"profile", "import", file, "--db", in_folder("mono.db"), "--camera", "m", "--encoding",
                     format("frame=%ux%u", width, height)});
}

// What belongs to no temperature is named, and two sensors are not one file.
void test_what_is_left_out(void **) {
    for (const double temperature : {2850.0, 6500.0})
        shoot_tiff(format("left/%gK/1.tif", temperature), temperature, LENSPROF_LAYOUT_RGB, 5);
    shoot_tiff("left/loose.tif", 4000, LENSPROF_LAYOUT_RGB, 6);
    const std::string file = in_folder("left.json");
    const std::string out = must_exit(unreadable, tables_of({in_folder("left")}, file));
    assert_true(contains(out, "loose.tif: its name does not state the colour temperature"));
    assert_int_equal(parsed(text_of(file))["rpi.alsc"]["calibrations_Cr"].size(), 2);
    save_text(in_folder("table.csv"), "file,temperature\nloose.tif,4000K\n");
    must_exit(done, tables_of({in_folder("left")}, file, {"--key", "table=" + in_folder("table.csv")}));
    assert_int_equal(parsed(text_of(file))["rpi.alsc"]["calibrations_Cr"].size(), 3);
    save_text(in_folder("table.csv"), "file,camera,temperature\nloose.tif,other,4000K\n");
    assert_refused(usage, tables_of({in_folder("left")}, file, {"--key", "table=" + in_folder("table.csv")}),
                   {"left.json", "one sensor"});
    assert_refused(usage,
                   tables_of({in_folder("left")}, in_folder("x.xml"),
                             {"--lens", "L", "--focal", "6", "--aperture", "2", "--key", "crop-factor=5"}),
                   {"x.xml", "2850 K"});
}

void test_temperatures_of_names(void **) {
    assert_true(setting_of_names("a/2850K/c.dng").color_temperature_k == 2850.0);
    assert_true(setting_of_names("alsc_3000k_0.dng").color_temperature_k == 3000.0);
    assert_true(setting_of_names("2850K/imx_6500K_1.dng").color_temperature_k == 6500.0);
    assert_true(setting_of_names("50mm_2850K/1.dng").focal_mm == 50.0);
    for (const char *other : {"a/850K.dng", "a/28500K.dng", "a/2850Kb.dng", "a/x2850K.dng", "a/2850.dng"})
        assert_true(setting_of_names(other).color_temperature_k == LENSPROF_UNKNOWN);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_raw_folders),      CLI_TEST(test_names_and_options),     CLI_TEST(test_a_mono_sensor),
        CLI_TEST(test_what_is_left_out), CLI_TEST(test_temperatures_of_names),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
