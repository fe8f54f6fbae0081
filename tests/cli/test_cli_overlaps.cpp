// `lensprof apply --linear --merge`: light of overlapping pictures against the light they were rendered from.
#include "cli_runs.hpp"

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

// Light of a direction, .01 to 1.9 of white of an exposure of 0 EV: smooth, with both ends in all three pictures.
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

// The grey value of the linear camera; something stands before the scene where `things` says so.
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

const Words merging = {"apply", "--linear", "--merge", "--output-exposure", "reference", "--pto"};

double light_in(const Picture &picture, uint32_t x, uint32_t y, size_t c) {
    return double(reinterpret_cast<const float *>(picture.pixels.data())[(size_t(y) * width + x) * 3 + c]);
}

// Largest grey value, of the image's own camera, that another image has of the pixel; 2 where none shows it.
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

// Pixels that are white in the image itself, and those of which it is sure, against the truth.
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

// Without the others the same pixels are as bright as white is.
void test_own_light_is_not_enough(void **) {
    make_project();
    must_exit(done,
              {"apply", "--linear", "--output-exposure", "reference", "--pto", work("in/pano.pto"), "-o", work("out")});
    assert_true(compare(1, work("out/p1.tif")).worst > 0.3);
}

// What another picture shows before the scene does not come into this one, where this one has seen the scene.
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

// A mask excludes the only picture that shows the light of white pixels.
void test_masks_are_respected(void **) {
    make_project();
    must_exit(done, merging + Words{work("in/pano.pto"), "-o", work("all")});
    make_project({}, "k i0 t0 p\"0 0 120 0 120 90 0 90\"\nk i2 t0 p\"0 0 120 0 120 90 0 90\"\n");
    must_exit(done, merging + Words{work("in/pano.pto"), "-o", work("masked")});
    must_exit(done,
              {"apply", "--linear", "--output-exposure", "reference", "--pto", work("in/pano.pto"), "-o", work("one")});
    assert_true(read_picture(work("masked/p1.tif")).pixels != read_picture(work("all/p1.tif")).pixels);
    assert_true(compare(1, work("masked/p1.tif")).worst > 0.3);
}

void test_threads_and_json(void **) {
    make_project();
    const Words words = merging + Words{work("in/pano.pto"), "--json"};
    const Json json = Json::parse(must_exit(done, words + Words{"-o", work("one"), "--threads", "1", file_of(1)}));
    assert_int_equal(json["pictures"].size(), 1);
    assert_int_equal(json["pictures"][0]["overlapping"].get<int>(), 2);
    assert_true(!fs::exists(work("one/p0.tif")));
    must_exit(done, words + Words{"-o", work("four"), "--threads", "4"});
    assert_true(read_picture(work("one/p1.tif")).pixels == read_picture(work("four/p1.tif")).pixels);
    must_exit(done, words + Words{"--linear-output", "exr", "-o", work("exr"), file_of(0)});
    assert_true(read_picture(work("four/p0.tif")).pixels.size() > 0);
    assert_true(fs::exists(work("exr/p0.exr")));
}

void test_bad_merges(void **) {
    const std::string project = make_project();
    const Words bad[] = {{"apply", "--pto", project, "--merge"},
                         {"apply", "--linear", "--merge", "--profile", "1", file_of(0)},
                         {"apply", "--linear", "--merge", file_of(0)},
                         {"apply", "--linear", "--merge", "--pto", project, "--profile", "1"},
                         {"apply", "--linear", "--merge", "--pto", project, "--gain-cap", "2"},
                         {"apply", "--linear", "--merge", "--pto", project, "--strength", "0.5"},
                         {"apply", "--linear", "--merge", "--pto", project, "--simulate"},
                         {"apply", "--linear", "--merge", "--pto", project, "--contact-sheet", work("sheet.jpg")}};
    for (const Words &words : bad) {
        must_exit(usage, words + Words{"-o", work("none")});
        assert_true(!fs::exists(work("none")));
    }
    write_picture(file_of(1), make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGBA));
    must_exit(usage, merging + Words{project, "-o", work("none")});
    write_picture(file_of(1), make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY));
    must_exit(usage, merging + Words{project, "-o", work("none")});
    fs::remove(file_of(1));  // that is not asked for itself
    must_exit(unreadable, merging + Words{project, "-o", work("none"), file_of(0)});
    assert_true(!fs::exists(work("none")));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_white_is_filled),        CLI_TEST(test_own_light_is_not_enough),
        CLI_TEST(test_moving_things_stay_out), CLI_TEST(test_masks_are_respected),
        CLI_TEST(test_threads_and_json),       CLI_TEST(test_bad_merges),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
