// The scenes of simulate, and its difficult effects: parallax, sharpening, blown-out lights.
#include <sched.h>

#include <array>

#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

constexpr uint32_t width = 320, height = 240;

// Linear float pictures without noise, falloff or differences of exposure: the scene itself.
Words simulate(const std::string &name, const Words &more) {
    Words words = {"simulate", "-o",    work(name),     "--response", "linear", "--size",     "320x240",
                   "--images", "3",     "--vignetting", "0,0,0",      "--set",  "center=0,0", "--set",
                   "wb=0",     "--set", "jitter=0",     "--format",   "tiff32"};
    for (const std::string key : {"noise=", "ev="}) {
        const auto sets = [&](const std::string &word) { return !find_pattern("(^|,)" + key, word).empty(); };
        if (std::none_of(more.begin(), more.end(), sets)) words = words + Words{"--set", key + "0"};
    }
    return words + more;
}

Json truth_of(const std::string &name) { return parsed(text_of(work(name + "/truth.json"))); }

std::vector<float> samples_of(const std::string &name, int i) {
    const Picture picture = read_picture(work(name + "/img00" + std::to_string(i) + ".tif"));
    assert_int_equal(picture.sample, LENSPROF_SAMPLE_F32);
    std::vector<float> samples(picture.pixels.size() / sizeof(float));
    std::memcpy(samples.data(), picture.pixels.data(), picture.pixels.size());
    return samples;
}

double green(const std::vector<float> &samples, size_t x, size_t y) { return double(samples[3 * (y * width + x) + 1]); }

double quantile(std::vector<double> values, double share) {
    const auto at = values.begin() + long(share * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

struct Look {
    double texture;   // median |difference| of neighbours, share of the light
    double contrast;  // between the 2nd and the 98th percentile, EV
    double edges;     // share of pixels next to a step of more than 30 %
};

Look look_of(const std::string &scene) {
    std::vector<double> steps, light;
    for (const char *seed : {"1", "2", "3"}) {
        must_exit(done, simulate("look", {"--scene", scene, "--seed", seed, "--set", "mean-ev=-1"}));
        for (int i = 0; i < 3; ++i) {
            const std::vector<float> picture = samples_of("look", i);
            for (size_t y = 0; y < height; ++y)
                for (size_t x = 1; x < width; ++x) {
                    const double here = green(picture, x, y), left = green(picture, x - 1, y);
                    steps.push_back(std::fabs(here - left) / std::max(here, left));
                    light.push_back(here);
                }
        }
    }
    const double edges = double(std::count_if(steps.begin(), steps.end(), [](double s) { return s > 0.3; }));
    return {quantile(steps, 0.5), std::log2(quantile(light, 0.98) / quantile(light, 0.02)),
            edges / double(steps.size())};
}

// The bounds are far apart: a smooth scene has a tenth of the texture of a rough one.
void test_scenes_differ(void **) {
    const Look sky = look_of("sky"), wall = look_of("wall"), foliage = look_of("foliage"),
               interior = look_of("interior");
    assert_true(sky.texture < 0.004 && wall.texture > 0.004 && wall.texture < 0.04 && foliage.texture > 0.08);
    assert_true(wall.contrast < 2 && foliage.contrast > 3 && interior.contrast > 4);
    assert_true(sky.edges > 0.001 && sky.edges < 0.05 && wall.edges < 0.02);
    assert_true(foliage.edges > 0.05 && interior.edges > 0.01 && interior.edges < 0.2);
}

void test_default_scene(void **) {
    must_exit(done, simulate("plain", {}));
    must_exit(done, simulate("named", {"--scene", "landscape"}));
    assert_true(text_of(work("plain/img001.tif")) == text_of(work("named/img001.tif")));
    const Json truth = truth_of("plain");
    assert_string_equal(truth["scene"].get<std::string>().c_str(), "landscape");
    assert_close(truth["parallax"].get<double>(), 0, 0);
    assert_false(truth["images"][0].contains("shift"));
    must_exit(done, simulate("other", {"--scene", "wall"}));
    assert_string_equal(truth_of("other")["scene"].get<std::string>().c_str(), "wall");
    assert_false(text_of(work("plain/img001.tif")) == text_of(work("other/img001.tif")));
}

// The share of pixels that are white in a channel, over pictures of several exposures whose differences are kept.
void test_clip(void **) {
    for (const char *scene : {"landscape", "foliage", "sky"}) {
        must_exit(done, simulate("plain", {"--set", "ev=1", "--scene", scene}));
        must_exit(done, simulate("white", {"--set", "ev=1", "--scene", scene, "--set", "clip=0.2"}));
        size_t white = 0;
        for (int i = 0; i < 3; ++i) {
            const std::vector<float> picture = samples_of("white", i);
            for (size_t p = 0; p < width * height; ++p)
                white += *std::max_element(&picture[3 * p], &picture[3 * p] + 3) >= 1;
        }
        assert_close(double(white) / (3.0 * width * height), 0.2, 0.02);
        const Json before = truth_of("plain")["images"], after = truth_of("white")["images"];
        for (size_t i = 1; i < 3; ++i)
            assert_close(after[i]["ev"].get<double>() - after[0]["ev"].get<double>(),
                         before[i]["ev"].get<double>() - before[0]["ev"].get<double>(), 1e-9);
        assert_close(truth_of("white")["clip"].get<double>(), 0.2, 0);
    }
}

// Computed here: value + gain (value - Gaussian mean), as a single two-dimensional sum.
void test_sharpen(void **) {
    must_exit(done, simulate("plain", {"--scene", "interior", "--seed", "3"}));
    must_exit(done, simulate("sharp", {"--scene", "interior", "--seed", "3", "--set", "sharpen=0.8"}));
    const std::vector<float> before = samples_of("plain", 1), after = samples_of("sharp", 1);
    double most = 0, least = 0;
    for (size_t y = 8; y < height - 8; y += 3)
        for (size_t x = 8; x < width - 8; x += 3) {
            double sum = 0, weights = 0;
            for (int v = -7; v <= 7; ++v)
                for (int u = -7; u <= 7; ++u) {
                    const double w = std::exp(-(u * u + v * v) / (2 * 1.5 * 1.5));
                    sum += w * green(before, x + size_t(u), y + size_t(v)), weights += w;
                }
            const double here = green(before, x, y), more = 0.8 * (here - sum / weights);
            assert_close(green(after, x, y), std::min(std::max(here + more, 0.0), 1.0), 0.003);
            most = std::max(most, more), least = std::min(least, more);
        }
    assert_true(most > 0.1 && least < -0.1);
    assert_close(truth_of("sharp")["sharpen"].get<double>(), 0.8, 0);
}

// The shift in px of the middle of block (x, y) that best matches a picture taken from another position.
std::array<int, 2> shift_of(const std::vector<float> &a, const std::vector<float> &b, size_t x, size_t y) {
    std::array<int, 2> best = {};
    double least = 1e9;
    for (int v = -8; v <= 8; ++v)
        for (int u = -8; u <= 8; ++u) {
            double sum = 0;
            for (size_t j = 0; j < 16; ++j)
                for (size_t i = 0; i < 16; ++i)
                    sum += std::fabs(green(a, x + i, y + j) - green(b, x + i + size_t(u), y + j + size_t(v)));
            if (sum < least) least = sum, best = {u, v};
        }
    return best;
}

// Distant objects stay, close ones move by the stated shift, others by half; nothing moves more than requested.
void test_parallax(void **) {
    must_exit(done, simulate("still", {"--scene", "foliage", "--seed", "3"}));
    must_exit(done, simulate("moved", {"--scene", "foliage", "--seed", "3", "--set", "parallax=12"}));
    const Json images = truth_of("moved")["images"];
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < i; ++j)
            assert_true(std::hypot(images[i]["shift"][0].get<double>() - images[j]["shift"][0].get<double>(),
                                   images[i]["shift"][1].get<double>() - images[j]["shift"][1].get<double>())
                        <= 12);
    const double shift[2] = {images[1]["shift"][0].get<double>(), images[1]["shift"][1].get<double>()};
    const std::vector<float> before = samples_of("still", 1), after = samples_of("moved", 1);
    int near[3] = {}, blocks = 0;
    for (size_t y = 20; y < 200; y += 9)
        for (size_t x = 20; x < 280; x += 9, ++blocks) {
            const std::array<int, 2> found = shift_of(before, after, x, y);
            for (int step = 0; step < 3; ++step)
                near[step] += std::hypot(found[0] - shift[0] * step / 2, found[1] - shift[1] * step / 2) < 1.1;
        }
    assert_true(std::hypot(shift[0], shift[1]) > 2.5);
    for (int count : near) assert_true(count > blocks / 10);
    assert_true(near[0] + near[1] + near[2] > blocks * 6 / 10);
    assert_close(truth_of("moved")["parallax"].get<double>(), 12, 0);
}

// Pairs show the parallax too, noise-free ones do not.
void test_parallax_in_pairs(void **) {
    const Words pairs = {"--scene", "foliage", "--set", "no-images=yes,points=500,test-points=200"};
    must_exit(done, simulate("still", pairs));
    must_exit(done, simulate("moved", pairs + Words{"--set", "parallax=12"}));
    assert_false(text_of(work("still/points.txt")) == text_of(work("moved/points.txt")));
    assert_true(text_of(work("still/test_points.txt")) == text_of(work("moved/test_points.txt")));
}

void test_same_bytes_with_any_threads(void **) {
    const Words hard = {"--scene",   "interior", "--set",   "parallax=5", "--set", "sharpen=1", "--set",
                        "clip=0.05", "--set",    "noise=2", "--set",      "ev=1",  "--set",     "outliers=0.01"};
    must_exit(done, simulate("many", hard));
    cpu_set_t all, one;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++cpu)
        if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    must_exit(done, simulate("one", hard));
    assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
    for (const char *file : {"/img000.tif", "/img001.tif", "/img002.tif", "/truth.json", "/pano.pto"})
        assert_true(text_of(work(std::string("many") + file)) == text_of(work(std::string("one") + file)));
}

void test_refused_options(void **) {
    for (const Words &words : {Words{"--scene", "moon"}, Words{"--scene", ""}, Words{"--set", "parallax=-1"},
                               Words{"--set", "parallax=nan"}, Words{"--set", "sharpen=11"},
                               Words{"--set", "sharpen=x"}, Words{"--set", "clip=1"}, Words{"--set", "clip=-0.1"}})
        assert_refused(usage, simulate("s", words), {words[0]});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_scenes_differ),
        CLI_TEST(test_default_scene),
        CLI_TEST(test_clip),
        CLI_TEST(test_sharpen),
        CLI_TEST(test_parallax),
        CLI_TEST(test_parallax_in_pairs),
        CLI_TEST(test_same_bytes_with_any_threads),
        CLI_TEST(test_refused_options),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
