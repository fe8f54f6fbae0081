// Black and white level of linear pictures: build removes and stores them, apply keeps them.
#include "raw_runs.hpp"

using namespace raw_runs;

namespace {

constexpr double kSpan = 4095.0 / 65535.0;  // white of 12 bit samples in 16 bits
const std::vector<double> kFalloff = {-0.3, 0.05, -0.15};

std::string linear_scene() {
    render("linear", {"--response", "linear", "--size", "320x240", "--images", "6", "--format", "tiff16", "--set",
                      "ev=1.2,mean-ev=-0.5,noise=0.5"});
    return work("linear");
}

// A copy of the pictures as a sensor has them: 12 bit codes with a pedestal per channel.
std::string with_pedestal(const std::string &from, const std::array<double, 3> &codes, bool is_grey = false) {
    const std::string to = from + "_pedestal";
    std::filesystem::remove_all(to);
    std::filesystem::copy(from, to);
    const lensprof_levels levels = {{codes[0] / 65535.0, codes[1] / 65535.0, codes[2] / 65535.0}, kSpan};
    for (int i = 0; i < 6; i++) {
        const std::string file = to + "/img00" + std::to_string(i) + ".tif";
        const Picture source = read_picture(file);
        Picture picture = make_noise(source.width, source.height, LENSPROF_SAMPLE_U16,
                                     is_grey ? LENSPROF_LAYOUT_GREY : LENSPROF_LAYOUT_RGB);
        auto *at = reinterpret_cast<uint16_t *>(picture.pixels.data());
        for (size_t n = 0; n < size_t(3) * source.width * source.height; n++) {
            const auto channel = static_cast<uint32_t>(n % 3);
            if (is_grey && channel != 1) continue;
            const double value = sample_value(source.sample, source.pixels.data(), n);
            *at++ = static_cast<uint16_t>(std::lround(65535.0 * lensprof_levels_to_sample(&levels, channel, value)));
        }
        write_picture(file, picture);
    }
    return to;
}

Words build(const std::string &path, const Words &more) {
    return Words{"build", path + "/pano.pto", "--fit", "pairs=2000,camera-kind=linear"} + more;
}

Json fitted(const std::string &path, const Words &more = {}) {
    return json_of(build(path, Words{"--no-store", "--json"} + more));
}

double error_of(const Json &json) {
    const Json &k = json["vignetting"]["k"];
    return falloff_error(k[k.size() / 2], kFalloff);
}

void assert_same_exposures(const Json &json, const Json &expected) {
    for (size_t i = 0; i < expected["images"].size(); i++)
        assert_close(json["images"][i]["ev"].get<double>(), expected["images"][i]["ev"].get<double>(), 0.01);
}

// The result is that of pictures without a pedestal, by each method of sampling and each kind of picture.
void test_pedestal(void **) {
    const std::string plain = linear_scene(), pedestal = with_pedestal(plain, {256, 256, 256});
    const Json expected = fitted(plain), stated = fitted(pedestal, {"--fit", "black-level=256,white-level=4095"}),
               without = fitted(pedestal, {"--fit", "white-level=4095"});
    assert_true(error_of(expected) < 0.01);
    assert_true(error_of(stated) < 0.01);
    assert_same_exposures(stated, expected);
    assert_true(error_of(without) > 0.03);
    // A forgotten one is noted, with its level in the file; others are not.
    const auto printed = [](const std::string &path, const std::string &levels) {
        return run_words(build(path, {"--no-store", "--json", "--fit", levels})).err;
    };
    assert_true(contains(printed(pedestal, "white-level=4095"), "black level of about 0.39 % of full scale"));
    assert_true(contains(printed(pedestal, "black-level=128,white-level=4095"), "black level of about 0.39 %"));
    assert_false(contains(printed(pedestal, "black-level=256,white-level=4095"), "black level"));
    assert_false(contains(printed(plain, "seed=1"), "black level"));
    assert_close(stated["levels"]["black"][1].get<double>(), 256.0 / 65535.0, 1e-9);
    assert_close(stated["levels"]["white"].get<double>(), kSpan, 1e-9);
    assert_false(expected.contains("levels"));
    const Json tracks = fitted(pedestal, {"--fit", "black-level=256,white-level=4095,method=radiance"});
    assert_true(error_of(tracks) < 0.015);
    assert_same_exposures(tracks, expected);
    const std::string grey = with_pedestal(plain, {256, 256, 256}, true);
    assert_true(error_of(fitted(grey, {"--fit", "black-level=256,white-level=4095"})) < 0.01);
}

void test_black_of_each_channel(void **) {
    const std::string pedestal = with_pedestal(linear_scene(), {160, 256, 400});
    const Json stated = fitted(pedestal, {"--fit", "black-level=160:256:400,white-level=4095"});
    assert_int_equal(stated["vignetting"]["k"].size(), 1);  // channels differ by their black level alone
    assert_true(error_of(stated) < 0.01);
    const Json one = fitted(pedestal, {"--fit", "black-level=160,white-level=4095"});
    assert_true(error_of(one) > 2.0 * error_of(stated));
}

// The profile has the levels: black stays where it is. Other outputs do not, and their notes have the words for apply.
void test_correction(void **) {
    const std::string pedestal = with_pedestal(linear_scene(), {256, 256, 256}), db = work("lens.db");
    const Outcome built =
        run_words(build(pedestal, {"--fit", "black-level=256,white-level=4095", "--db", db, "--camera", "Box", "--lens",
                                   "Box", "--write", "exposures=" + work("e.json"), "--report", work("report.html")}));
    assert_int_equal(built.code, done);
    assert_true(contains(built.out, "levels    black 0.3906"));
    assert_true(contains(built.err, "e.json: does not hold the black and white level"));
    assert_true(contains(must_exit(done, {"profile", "show", "1", "--db", db}), "levels    black 0.3906"));
    const std::string set = "black=0.390631%,white=6.24857%";
    assert_true(contains(built.err, set));

    Picture dark = read_picture(pedestal + "/img000.tif");
    auto *codes = reinterpret_cast<uint16_t *>(dark.pixels.data());
    std::fill_n(codes, dark.pixels.size() / 2, uint16_t(256));
    write_picture(work("dark.tif"), dark);
    must_exit(done, {"apply", work("dark.tif"), "--profile", "1", "--db", db, "-o", work("out")});
    assert_same_pixels(read_picture(work("out/dark.tif")), dark);

    write_picture(pedestal + "/img000.tif", dark);  // exposures are scaled, too
    must_exit(done, {"apply", pedestal + "/img000.tif", "--model", work("e.json"), "--set", set, "-o", work("even")});
    assert_same_pixels(read_picture(work("even/img000.tif")), dark);
}

void test_refusals(void **) {
    const std::string path = with_pedestal(linear_scene(), {256, 256, 256}), project = path + "/pano.pto";
    const auto refused = [&](int code, const Words &words, const Words &named) {
        assert_refused(code, Words{"build", project, "--no-store"} + words, named);
    };
    refused(usage, {"--fit", "black-level=256"}, {"img000.tif: is not known to be linear", "camera-kind=linear"});
    const std::string linear = "camera-kind=linear,";
    refused(usage, {"--fit", linear + "black-level=5000,white-level=4095"},
            {"img000.tif", "not below its white level"});
    refused(usage, {"--fit", linear + "black-level=1:2"}, {"black-level", "RED:GREEN:BLUE"});
    refused(usage, {"--fit", linear + "black-level=0.06"}, {"img000.tif", "such as 6%"});
    refused(usage, {"--fit", linear + "white-level=0"}, {"white level"});
    refused(not_usable, {"--fit", linear + "black-level=900,white-level=4095"},
            {".tif", "below the black level", "--fit black-level=LEVEL"});
    must_exit(done, {"build", project, "--no-store", "--fit", linear + "black-level=256,white-level=4095,pairs=600",
                     "--write", "points=" + work("points.txt")});
    refused(usage, {"--fit", linear + "black-level=256", "--points", work("points.txt")},
            {"points.txt: its values are taken as they are"});
    Picture bytes = make_smooth(320, 240, LENSPROF_LAYOUT_RGB);
    write_picture(path + "/img003.tif", bytes);
    refused(usage, {"--fit", linear + "black-level=256"}, {"img003.tif: its samples are of another type"});
    bytes.sample = LENSPROF_SAMPLE_F32, bytes.row_bytes *= 4;
    bytes.pixels.assign(bytes.pixels.size() * 4, 0);
    write_picture(path + "/img000.tif", bytes);
    refused(usage, {"--fit", linear + "black-level=256"}, {"img000.tif: has float samples"});
    must_exit(done, {"simulate", "-o", work("jpeg"), "--size", "160x120", "--images", "2", "--format", "jpeg"});
    assert_refused(usage, {"build", work("jpeg/pano.pto"), "--no-store", "--fit", linear + "black-level=16"},
                   {"img000.jpg: is a rendered picture", "--fit black-level=LEVEL"});
}

// A raw file states its own black level, which is gone when it is read.
void test_raw_files(void **) {
    needs_libraw();
    make_mosaics(work("raw"));
    assert_refused(usage, {"build", work("raw"), "--no-store", "--fit", "black-level=512"},
                   {".dng", "is subtracted already"});
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {CLI_TEST(test_pedestal), CLI_TEST(test_black_of_each_channel),
                                       CLI_TEST(test_correction), CLI_TEST(test_refusals), CLI_TEST(test_raw_files)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
