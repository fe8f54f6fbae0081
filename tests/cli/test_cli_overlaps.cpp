// `lensprof apply --linear --merge`: light of overlapping pictures compared with the light they were rendered from.
#include "cli_runs.hpp"

#include "photo/base/format.hpp"

#include <lensprof/geometry.h>

using namespace cli_runs;

namespace {

constexpr uint32_t width = 120, height = 90;
constexpr double k1 = -0.4, evs[3] = {0.0, 2.0, -2.0}, yaws[3] = {0.0, 10.0, -8.0};

lensprof_camera camera_of(size_t image) {
    lensprof_camera camera{};
    camera.width = width, camera.height = height;
    camera.hfov_deg = 50.0, camera.yaw_deg = yaws[image];
    return camera;
}

double falloff(uint32_t x, uint32_t y) {
    const double r = std::hypot(x - (width - 1) / 2.0, y - (height - 1) / 2.0) / (std::hypot(width, height) / 2);
    return 1 + k1 * r * r;
}

// Light of a direction, from .01 to 1.9 times white at 0 EV: smooth, with both extremes in all three pictures.
double light_of(const double direction[2], size_t channel) {
    const double stops = -2.9 + 3.8 * std::sin(9.0 * direction[0] + 4.0 * direction[1]);
    return std::exp2(stops) * (channel == 0 ? 0.9 : channel == 2 ? 0.8 : 1.0);
}

double truth(size_t image, uint32_t x, uint32_t y, size_t channel) {
    const lensprof_camera camera = camera_of(image);
    double direction[2];
    assert_true(lensprof_camera_unproject(&camera, x, y, direction));
    return light_of(direction, channel);
}

// The grey value of the linear camera; `things` covers parts of the scene.
double grey(size_t image, uint32_t x, uint32_t y, size_t channel) {
    return std::min(1.0, truth(image, x, y, channel) * std::exp2(evs[image]) * falloff(x, y));
}

using Thing = std::function<bool(size_t image, uint32_t x, uint32_t y)>;

Picture render(size_t image, const Thing &thing) {
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    auto *codes = reinterpret_cast<uint16_t *>(picture.pixels.data());
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (size_t c = 0; c < 3; c++)
                *codes++ = static_cast<uint16_t>(
                    std::lround(65535 * (thing && thing(image, x, y) ? 0.5 : grey(image, x, y, c))));
    return picture;
}

std::string file_of(size_t image) { return work("in/p" + std::to_string(image) + ".tif"); }

std::string make_project(const Thing &thing = {}, const std::string &more = {}) {
    fs::create_directories(work("in"));
    std::ostringstream pto;
    pto << "p f2 w300 h150 v360 n\"TIFF_m\"\nm g1 i0 f0 m2 p0.00784314\n";
    for (size_t i = 0; i < 3; i++) {
        write_picture(file_of(i), render(i, thing));
        pto << "i w120 h90 f0 v50 Rt1 Ra0 Rb0 Rc0 Rd0 Re0 Eev" << 9 - evs[i] << " Er1 Eb1 r0 p0 y" << yaws[i]
            << " TrX0 TrY0 TrZ0 Tpy0 Tpp0 j0 a0 b0 c0 d0 e0 g0 t0 Va1 Vb" << k1 << " Vc0 Vd0 Vx0 Vy0 Vm5 n\"p" << i
            << ".tif\"\n";
    }
    pto << "v Eev1 Eev2\nv\n" << more;
    save_text(work("in/pano.pto"), pto.str());
    return work("in/pano.pto");
}

const Words merging = {"apply", "--linear", "--merge", "--set", "exposure=reference", "--pto"};

double light_in(const Picture &picture, uint32_t x, uint32_t y, size_t c) {
    return double(reinterpret_cast<const float *>(picture.pixels.data())[(size_t(y) * width + x) * 3 + c]);
}

// Whether another image shows a pixel far from black and white.
bool is_well_seen_by(size_t other, size_t image, uint32_t x, uint32_t y) {
    const lensprof_camera own = camera_of(image), camera = camera_of(other);
    double direction[2], xy[2];
    if (!lensprof_camera_unproject(&own, x, y, direction)
        || !lensprof_camera_project(&camera, direction[0], direction[1], xy))
        return false;
    if (!(xy[0] > 1.0 && xy[1] > 1.0 && xy[0] < width - 2.0 && xy[1] < height - 2.0)) return false;
    double most = 0.0;
    for (size_t c = 0; c < 3; c++)
        most = std::max(most, light_of(direction, c) * std::exp2(evs[other])
                                  * falloff(uint32_t(std::lround(xy[0])), uint32_t(std::lround(xy[1]))));
    return most > 0.05 && most < 0.9;
}

struct Counts {
    size_t filled = 0, own = 0;
    double worst = 0.0;
};

// Pixels that are white in the image itself, and those known reliably, compared with the truth.
Counts compare(size_t image, const std::string &file) {
    const Picture merged = read_picture(file);
    assert_int_equal(merged.sample, LENSPROF_SAMPLE_F32);
    Counts counts;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double largest = std::max({grey(image, x, y, 0), grey(image, x, y, 1), grey(image, x, y, 2)});
            bool is_seen = largest > 0.1 && largest < 0.85;
            counts.own += is_seen;
            for (size_t other = 0; other < 3 && largest >= 0.99; other++)
                if (other != image && is_well_seen_by(other, image, x, y) && !is_seen) is_seen = true, counts.filled++;
            for (size_t c = 0; c < 3 && is_seen; c++)
                counts.worst = std::max(counts.worst, std::fabs(light_in(merged, x, y, c) / truth(image, x, y, c) - 1));
        }
    return counts;
}

void test_white_is_filled(void **) {
    must_exit(done, merging + Words{make_project(), "-o", work("out")});
    for (size_t i = 0; i < 3; i++) {
        const Counts counts = compare(i, work("out/p" + std::to_string(i) + ".tif"));
        assert_true(counts.own > 500);
        if (i != 2) assert_true(counts.filled > 300);
        assert_true(counts.worst < 0.02);
    }
}

// Without the other pictures, these pixels are only as bright as white.
void test_own_light_is_not_enough(void **) {
    make_project();
    must_exit(done,
              {"apply", "--linear", "--set", "exposure=reference", "--pto", work("in/pano.pto"), "-o", work("out")});
    assert_true(compare(1, work("out/p1.tif")).worst > 0.3);
}

// An object that covers the scene in another picture does not appear in a picture that shows the scene.
void test_moving_things_stay_out(void **) {
    make_project(
        [](size_t image, uint32_t x, uint32_t y) { return image == 1 && x > 30 && x < 70 && y > 20 && y < 60; });
    must_exit(done, merging + Words{work("in/pano.pto"), "-o", work("out")});
    const Picture merged = read_picture(work("out/p0.tif"));
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double largest = std::max({grey(0, x, y, 0), grey(0, x, y, 1), grey(0, x, y, 2)});
            if (largest < 0.15 || largest > 0.85) continue;
            assert_true(std::fabs(light_in(merged, x, y, 1) / truth(0, x, y, 1) - 1) < 0.05 / largest);
        }
}

// Masks exclude both other pictures: neither their light nor their white enters this one.
void test_masks_are_respected(void **) {
    make_project();
    must_exit(done, merging + Words{work("in/pano.pto"), "-o", work("all")});
    make_project({}, "k i0 t0 p\"0 0 120 0 120 90 0 90\"\nk i2 t0 p\"0 0 120 0 120 90 0 90\"\n");
    must_exit(done, merging + Words{work("in/pano.pto"), "-o", work("masked")});
    must_exit(done,
              {"apply", "--linear", "--set", "exposure=reference", "--pto", work("in/pano.pto"), "-o", work("one")});
    assert_true(read_picture(work("masked/p1.tif")).pixels != read_picture(work("all/p1.tif")).pixels);
    const Picture masked = read_picture(work("masked/p1.tif")), one = read_picture(work("one/p1.tif"));
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            assert_true(std::fabs(light_in(masked, x, y, 1) / light_in(one, x, y, 1) - 1) < 1e-5);
}

void test_threads_and_json(void **) {
    make_project();
    const Words words = merging + Words{work("in/pano.pto"), "--json"};
    const Json json = parsed(must_exit(done, words + Words{"-o", work("one"), "--threads", "1", file_of(1)}));
    assert_int_equal(json["pictures"].size(), 1);
    assert_int_equal(json["pictures"][0]["overlapping"].get<int>(), 2);
    assert_true(!fs::exists(work("one/p0.tif")));
    must_exit(done, words + Words{"-o", work("four"), "--threads", "4"});
    assert_true(read_picture(work("one/p1.tif")).pixels == read_picture(work("four/p1.tif")).pixels);
    must_exit(done, words + Words{"--encoding", "linear=exr", "-o", work("exr"), file_of(0)});
    assert_true(fs::exists(work("exr/p0.exr")));
}

// A picture of one grey value, or of two: `right` from column `from` on.
void write_even(const std::string &file, uint32_t w, uint32_t h, double left, double right, uint32_t from) {
    Picture picture = make_noise(w, h, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    auto *codes = reinterpret_cast<uint16_t *>(picture.pixels.data());
    for (uint32_t n = 0; n < w * h * 3; n++)
        codes[n] = static_cast<uint16_t>(std::lround(65535 * (n / 3 % w < from ? left : right)));
    fs::create_directories(fs::path(file).parent_path());
    write_picture(file, picture);
}

std::string image_line(uint32_t w, uint32_t h, const std::string &lens, double ev, const std::string &file) {
    return format(
        "i w%u h%u %s Rt1 Ra0 Rb0 Rc0 Rd0 Re0 Eev%g Er1 Eb1 r0 p0 TrX0 TrY0 TrZ0 Tpy0 Tpp0 j0 a0 b0 c0 d0 e0 g0 "
        "t0 Va1 Vb-0.0001 Vc0 Vd0 Vx0 Vy0 Vm5 n\"%s\"\n",
        w, h, lens.c_str(), 9 - ev, file.c_str());
}

std::string two_images(const std::string &one, const std::string &other) {
    save_text(work("two/pano.pto"),
              "p f2 w300 h150 v360 n\"TIFF_m\"\nm g1 i0 f0 m2 p0.00784314\n" + one + other + "v Eev1\nv\n");
    return work("two/pano.pto");
}

double middle_of(const std::string &file, uint32_t x, uint32_t y) {
    const Picture picture = read_picture(file);
    const auto *light = reinterpret_cast<const float *>(picture.pixels.data());
    return double(light[(size_t(y) * picture.width + x) * 3 + 1]);
}

// Almost white pixels among white ones agree with brighter light from other pictures.
void test_almost_white(void **) {
    fs::remove_all(work("two"));
    for (const double grey : {0.96, 0.975, 0.979}) {
        write_even(work("two/p0.tif"), 60, 40, grey, 1.0, 40);
        write_even(work("two/p1.tif"), 60, 40, 0.5, 0.5, 0);
        fs::remove_all(work("out"));
        must_exit(done, merging
                            + Words{two_images(image_line(60, 40, "f0 v40 y0", 0, "p0.tif"),
                                               image_line(60, 40, "f0 v40 y0", -3, "p1.tif")),
                                    "-o", work("out")});
        assert_close(middle_of(work("out/p0.tif"), 20, 20), grey, 0.001);
        assert_close(middle_of(work("out/p0.tif"), 39, 20), 4.0, 0.03);
        assert_close(middle_of(work("out/p0.tif"), 50, 20), 4.0, 0.001);
    }
}

// Identical cameras: every pixel is filled, including the outermost.
void test_to_the_edges(void **) {
    write_even(work("two/p0.tif"), 120, 80, 1.0, 1.0, 0);
    write_even(work("two/p1.tif"), 120, 80, 0.5, 0.5, 0);
    must_exit(done, merging
                        + Words{two_images(image_line(120, 80, "f0 v40 y0", 0, "p0.tif"),
                                           image_line(120, 80, "f0 v40 y0", -3, "p1.tif")),
                                "-o", work("out")});
    for (uint32_t y = 0; y < 80; y++)
        for (uint32_t x = 0; x < 120; x++) assert_close(middle_of(work("out/p0.tif"), x, y), 4.0, 0.01);
}

// A telephoto picture inside a 360 degree panorama: at the panorama's seam, light comes from the matching side.
void test_all_around(void **) {
    write_even(work("two/p0.tif"), 400, 300, 1.0, 1.0, 0);
    write_even(work("two/p1.tif"), 2000, 1000, 0.25, 0.75, 1000);
    const std::string around = image_line(2000, 1000, "f4 v360 y0", -3, "p1.tif");
    for (const char *tele : {"f0 v60 y180", "f0 v8 y7"}) {
        const bool is_at_cut = contains(tele, "180");
        const Json json = json_of(
            merging + Words{two_images(image_line(400, 300, tele, 0, "p0.tif"), around), "--json", "-o", work("out")});
        for (const Json &picture : json["pictures"]) assert_int_equal(picture["overlapping"].get<int>(), 1);
        const Picture merged = read_picture(work("out/p0.tif"));
        const auto *light = reinterpret_cast<const float *>(merged.pixels.data());
        for (uint32_t x = 0; x < 400; x++) {
            const double expected = is_at_cut && x >= 200 ? 2.0 : 6.0;
            if (x == 199 || x == 200) continue;
            for (uint32_t y : {0u, 150u, 299u})
                assert_close(double(light[(size_t(y) * 400 + x) * 3 + 1]), expected, 0.02);
        }
    }
}

// In shadows, moved objects differ by less than .03 of full scale, but by more than noise.
void test_moving_shadows_stay_out(void **) {
    const auto dark = [](size_t image, uint32_t from) {
        Picture picture = make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
        auto *codes = reinterpret_cast<uint16_t *>(picture.pixels.data());
        uint64_t state = image + 1;
        for (uint32_t n = 0; n < width * height * 3; n++) {
            const uint32_t x = n / 3 % width, y = n / 3 / width;
            const bool is_thing = x >= from && x < from + 20 && y > 20 && y < 60;
            const double light = (is_thing ? 0.025 : 0.05) * std::exp2(image ? 2.0 : 0.0);
            codes[n] = static_cast<uint16_t>(std::lround(65535 * (light + 0.012 * (lp_random(&state) - 0.5))));
        }
        fs::create_directories(work("two"));
        write_picture(work("two/p" + std::to_string(image) + ".tif"), picture);
    };
    dark(0, 30), dark(1, 70);
    must_exit(done, merging
                        + Words{two_images(image_line(width, height, "f0 v40 y0", 0, "p0.tif"),
                                           image_line(width, height, "f0 v40 y0", 2, "p1.tif")),
                                "-o", work("out")});
    const Picture merged = read_picture(work("out/p0.tif"));
    const auto mean = [&](uint32_t left, uint32_t right) {
        double sum = 0.0;
        for (uint32_t y = 24; y < 56; y++)
            for (uint32_t x = left; x < right; x++) sum += light_in(merged, x, y, 1);
        return sum / ((right - left) * 32.0);
    };
    assert_close(mean(33, 47), 0.025, 0.0015);
    assert_close(mean(73, 87), 0.05, 0.0015);
    assert_close(mean(100, 115), 0.05, 0.0005);
    double spread = 0.0;  // noise, a quarter as large in the other picture, which has four times the light
    for (uint32_t y = 24; y < 56; y++)
        for (uint32_t x = 100; x < 115; x++) spread += std::pow(light_in(merged, x, y, 1) - 0.05, 2);
    assert_true(std::sqrt(spread / (15 * 32)) < 0.35 * 0.012 / std::sqrt(12.0));
}

// A picture that differs from the one the project was fitted to is reported.
void test_changed_pictures_are_named(void **) {
    make_project();
    const Json right = json_of(merging + Words{work("in/pano.pto"), "--json", "-o", work("right")})["pictures"];
    for (const Json &picture : right) assert_true(picture["agreement"] > 0.9);
    Picture rotated = read_picture(file_of(0));
    auto *codes = reinterpret_cast<uint16_t *>(rotated.pixels.data());
    std::reverse(codes, codes + size_t(width) * height * 3);
    write_picture(file_of(0), rotated);
    const Outcome run = run_words(merging + Words{work("in/pano.pto"), "--json", "-o", work("out")});
    assert_int_equal(run.code, done);
    assert_true(contains(run.err, "p0.tif: agrees with the overlapping pictures"));
    const Json pictures = parsed(run.out)["pictures"];
    assert_true(pictures[0]["agreement"] < 0.5);
}

// Outputs in the folder of their sources replace only files made by lensprof.
void test_pictures_beside_are_kept(void **) {
    make_project();
    for (size_t i = 0; i < 3; i++) {
        write_picture(work("in/p" + std::to_string(i) + ".png"), render(i, {}));
        edit(work("in/pano.pto"), "p" + std::to_string(i) + "\\.tif", "p" + std::to_string(i) + ".png");
    }
    const std::string before = text_of(file_of(1));
    must_exit(usage, merging + Words{work("in/pano.pto"), "-o", work("in")});
    assert_true(text_of(file_of(1)) == before);
    for (size_t i = 0; i < 3; i++) fs::remove(file_of(i));
    must_exit(done, merging + Words{work("in/pano.pto"), "-o", work("in")});
    must_exit(done, merging + Words{work("in/pano.pto"), "-o", work("in")});
}

// Light from a picture whose falloff is already removed would be wrong.
void test_corrected_pictures_give_no_light(void **) {
    make_project();
    must_exit(done, {"apply", "--pto", work("in/pano.pto"), "-o", work("even")});
    fs::copy_file(work("even/p1.tif"), file_of(1), fs::copy_options::overwrite_existing);
    must_exit(not_found, merging + Words{work("in/pano.pto"), "-o", work("none")});
    assert_true(!fs::exists(work("none")));
    const Outcome other = run_words(merging + Words{work("in/pano.pto"), "-o", work("out"), "--json", file_of(0)});
    assert_int_equal(other.code, done);
    assert_true(contains(other.err, "it is not merged"));
    assert_int_equal(parsed(other.out)["pictures"][0]["overlapping"].get<int>(), 1);
}

void test_bad_merges(void **) {
    const std::string project = make_project();
    const Words bad[] = {{"apply", "--pto", project, "--merge"},
                         {"apply", "--linear", "--merge", "--profile", "1", file_of(0)},
                         {"apply", "--linear", "--merge", file_of(0)},
                         {"apply", "--linear", "--merge", "--pto", project, "--profile", "1"},
                         {"apply", "--linear", "--merge", "--pto", project, "--set", "gain-cap=2"},
                         {"apply", "--linear", "--merge", "--pto", project, "--encoding", "dither=yes"},
                         {"apply", "--linear", "--merge", "--pto", project, "--set", "strength=0.5"},
                         {"apply", "--linear", "--merge", "--pto", project, "--set", "simulate=yes"},
                         {"apply", "--linear", "--merge", "--pto", project, "--contact-sheet", work("sheet.jpg")}};
    for (const Words &words : bad) {
        must_exit(usage, words + Words{"-o", work("none")});
        assert_true(!fs::exists(work("none")));
    }
    // A picture that cannot be merged is refused; if only another one is requested, it contributes no light.
    const auto only_others = [&](int code) {
        must_exit(code, merging + Words{project, "-o", work("none")});
        assert_true(!fs::exists(work("none")));
        const Outcome run = run_words(merging + Words{project, "--json", "-o", work("others"), file_of(0)});
        assert_int_equal(run.code, done);
        assert_true(contains(run.err, "p1.tif: ") && contains(run.err, "it is not merged"));
        assert_int_equal(parsed(run.out)["pictures"][0]["overlapping"].get<int>(), 1);
    };
    write_picture(file_of(1), make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGBA));
    only_others(usage);
    write_picture(file_of(1), make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY));
    only_others(usage);
    fs::remove(file_of(1));
    only_others(unreadable);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_white_is_filled),
        CLI_TEST(test_own_light_is_not_enough),
        CLI_TEST(test_moving_things_stay_out),
        CLI_TEST(test_masks_are_respected),
        CLI_TEST(test_threads_and_json),
        CLI_TEST(test_bad_merges),
        CLI_TEST(test_almost_white),
        CLI_TEST(test_to_the_edges),
        CLI_TEST(test_all_around),
        CLI_TEST(test_moving_shadows_stay_out),
        CLI_TEST(test_changed_pictures_are_named),
        CLI_TEST(test_pictures_beside_are_kept),
        CLI_TEST(test_corrected_pictures_give_no_light),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
