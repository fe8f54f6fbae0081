// Optional effects of simulate: moving objects, local tone mapping, exposures in the metadata. The camera is linear, so
// the model is two lines here.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

constexpr uint32_t width = 160, height = 120;

Words simulate(const std::string &name, const Words &more) {
    Words words = {"simulate", "-o", work(name), "--response", "linear", "--set", "noise=0"};
    const Words usual = {"--size", "160x120", "--images", "6", "--format", "tiff32"};
    for (size_t i = 0; i < usual.size(); i += 2)
        if (std::find(more.begin(), more.end(), usual[i]) == more.end()) words = words + Words{usual[i], usual[i + 1]};
    return words + more;
}

Json truth_of(const std::string &name) { return parsed(text_of(work(name + "/truth.json"))); }

std::string picture_of(const std::string &name, int i) { return work(name + "/img00" + std::to_string(i) + ".tif"); }

// Samples of a float picture.
std::vector<float> samples_of(const std::string &path) {
    const Picture picture = read_picture(path);
    assert_int_equal(picture.sample, LENSPROF_SAMPLE_F32);
    std::vector<float> samples(picture.pixels.size() / sizeof(float));
    std::memcpy(samples.data(), picture.pixels.data(), picture.pixels.size());
    return samples;
}

bool in_object(const Json &image, double x, double y) {
    for (const Json &box : image.at("objects"))
        if (x >= box[0].get<double>() && y >= box[1].get<double>() && x < box[2].get<double>()
            && y < box[3].get<double>())
            return true;
    return false;
}

struct SeenPair {
    size_t image[2];
    double x[2], y[2];
    double mismatch;  // largest difference of the logarithms of radiance, both ends converted back through the camera
};

std::vector<SeenPair> pairs_of(const std::string &name, const std::string &file) {
    const Json truth = truth_of(name), k = truth["vignetting"]["k"][0], centre = truth["vignetting"]["center"];
    std::istringstream lines(text_of(work(name + "/" + file)));
    std::vector<SeenPair> pairs;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream numbers(line);
        double column[16], light[2][3];
        for (double &number : column) numbers >> number;
        SeenPair pair = {};
        for (size_t side = 0; side < 2; ++side) {
            pair.image[side] = size_t(column[side]);
            pair.x[side] = column[2 + 2 * side], pair.y[side] = column[3 + 2 * side];
            const Json &image = truth["images"][pair.image[side]];
            const double x = (pair.x[side] - 79.5) / 100 - centre[0].get<double>();
            const double y = (pair.y[side] - 59.5) / 100 - centre[1].get<double>(), r2 = x * x + y * y;
            const double m = 1 + r2 * (k[0].get<double>() + r2 * (k[1].get<double>() + r2 * k[2].get<double>()));
            for (size_t c = 0; c < 3; ++c)
                light[side][c] = column[6 + 3 * side + c]
                                 / (m * std::exp2(image["ev"].get<double>()) * image["white_balance"][c].get<double>());
        }
        for (size_t c = 0; c < 3; ++c)
            pair.mismatch = std::max(pair.mismatch, std::fabs(std::log(light[0][c] / light[1][c])));
        pairs.push_back(pair);
    }
    return pairs;
}

double median_mismatch(const std::vector<SeenPair> &pairs) {
    std::vector<double> values;
    for (const SeenPair &pair : pairs) values.push_back(pair.mismatch);
    std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
    return values[values.size() / 2];
}

// Pixels change only inside the stated blocks; the blocks cover the requested share and differ per picture.
void test_objects_in_pictures(void **) {
    must_exit(done, simulate("plain", {}));
    must_exit(done, simulate("moved", {"--set", "objects=0.25"}));
    const Json truth = truth_of("moved");
    assert_close(truth["objects"].get<double>(), 0.25, 0);
    assert_true(truth["images"][0]["ev"] == truth_of("plain")["images"][0]["ev"]);
    size_t inside = 0, changed = 0;
    for (int i = 0; i < 6; ++i) {
        const Json &image = truth["images"][size_t(i)];
        const std::vector<float> before = samples_of(picture_of("plain", i)),
                                 after = samples_of(picture_of("moved", i));
        for (size_t p = 0; p < width * height; ++p) {
            const bool hit = in_object(image, double(p % width), double(p / width));
            const bool differs = std::memcmp(&before[3 * p], &after[3 * p], 3 * sizeof(float)) != 0;
            assert_false(differs && !hit);
            inside += hit, changed += differs;
        }
        for (const Json &box : image["objects"]) {
            assert_close((box[2].get<double>() - box[0].get<double>()) / width, 0.15, 0.1);
            assert_close((box[3].get<double>() - box[1].get<double>()) / height, 0.15, 0.1);
        }
        assert_true(i == 0 || image["objects"] != truth["images"][0]["objects"]);
    }
    assert_close(double(inside) / (6.0 * width * height), 0.25, 0.03);
    assert_true(double(changed) > 0.97 * double(inside));  // white on white does not change
}

// Pairs without an end on an object follow the model, pairs with one do not; noise-free pairs have no objects.
void test_objects_in_pairs(void **) {
    must_exit(done, simulate("moved",
                             {"--set", "objects=0.1,no-images=yes,points=2000,test-points=500", "--format", "tiff16"}));
    const Json truth = truth_of("moved");
    std::vector<SeenPair> hit, clear;
    for (const SeenPair &pair : pairs_of("moved", "points.txt")) {
        bool on = false;
        for (size_t side = 0; side < 2; ++side)
            on = on || in_object(truth["images"][pair.image[side]], pair.x[side], pair.y[side]);
        (on ? hit : clear).push_back(pair);
    }
    assert_close(double(hit.size()) / double(hit.size() + clear.size()), 0.19, 0.06);  // 1 - 0.9^2
    for (const SeenPair &pair : clear) assert_close(pair.mismatch, 0, 0.01);           // 16 bit at one level of 255
    assert_true(median_mismatch(hit) > 0.5);
    for (const SeenPair &pair : pairs_of("moved", "test_points.txt")) assert_close(pair.mismatch, 0, 0.01);
}

// Mean grey value around a pixel, weighted by a Gaussian whose sigma is a tenth of the width.
double surroundings(const std::vector<float> &plain, int x, int y) {
    double sum = 0, weights = 0;
    for (int v = 0; v < int(height); v += 4)
        for (int u = 0; u < int(width); u += 4) {
            const double w = std::exp(-((u - x) * (u - x) + (v - y) * (v - y)) / (2 * 16.0 * 16.0));
            const float *pixel = &plain[3 * (size_t(v) * width + size_t(u))];
            sum += w * (double(pixel[0]) + 2 * double(pixel[1]) + double(pixel[2])) / 4;
            weights += w;
        }
    return sum / weights;
}

// One gain for the three channels, depending on the surroundings: up to +1 EV in the dark, -1 EV in the light.
void test_local_tone_in_pictures(void **) {
    must_exit(done, simulate("plain", {}));
    must_exit(done, simulate("toned", {"--set", "local-tone=1"}));
    assert_close(truth_of("toned")["local_tone"].get<double>(), 1, 0);
    double least = 9, most = -9;
    for (int i = 0; i < 3; ++i) {
        const std::vector<float> before = samples_of(picture_of("plain", i)),
                                 after = samples_of(picture_of("toned", i));
        for (uint32_t y = 0; y < height; y += 7)
            for (uint32_t x = 0; x < width; x += 7) {
                const float *a = &before[3 * (y * width + x)], *b = &after[3 * (y * width + x)];
                const double wanted = 1 - 2 * surroundings(before, int(x), int(y));
                for (int c = 0; c < 3; ++c) {
                    if (a[c] >= 1) assert_close(double(b[c]), 1, 0);
                    if (a[c] >= 1 || b[c] >= 1) continue;
                    const double ev = std::log2(double(b[c]) / double(a[c]));
                    assert_close(ev, wanted, 0.08);
                    least = std::min(least, ev), most = std::max(most, ev);
                }
            }
    }
    assert_true(least < -0.2 && most > 0.5);
}

// The same point is rendered differently in two pictures, but not in the noise-free pairs, which score the response.
void test_local_tone_in_pairs(void **) {
    must_exit(done, simulate("toned", {"--set", "local-tone=1,no-images=yes,points=1000,test-points=300"}));
    assert_true(median_mismatch(pairs_of("toned", "points.txt")) > 0.05);
    for (const SeenPair &pair : pairs_of("toned", "test_points.txt")) assert_close(pair.mismatch, 0, 0.01);
}

// Exposure differences in the metadata of every format are the true ones, with several times and sensitivities.
void test_exif_tells_exposures(void **) {
    must_exit(done, simulate("exif", {"--exif", "--format", "png,png16,tiff,tiff16,tiff32,jpeg"}));
    const Json truth = truth_of("exif");
    double zero = 0;
    std::vector<double> sensitivities;
    for (size_t i = 0; i < 6; ++i) {
        const Json &image = truth["images"][i];
        const PictureMetadata m = read_metadata(work("exif/" + image["file"].get<std::string>()));
        assert_true(m.exif_ev.has_value() && m.exposure_time_s.has_value() && m.iso.has_value());
        assert_close(m.f_number.value_or(0), 2.8, 1e-9);
        assert_string_equal(m.key.camera_model, "Simulated Camera");
        assert_string_equal(m.key.lens, "Simulated Lens");
        assert_close(*m.exif_ev, image["exif_ev"].get<double>(), 1e-8);
        if (i == 0) zero = *m.exif_ev - image["ev"].get<double>();
        assert_close(*m.exif_ev - image["ev"].get<double>(), zero, 1e-8);
        sensitivities.push_back(*m.iso);
    }
    assert_true(*std::max_element(sensitivities.begin(), sensitivities.end())
                > *std::min_element(sensitivities.begin(), sensitivities.end()));
}

void test_exif_is_rounded(void **) {
    must_exit(done, simulate("exif", {"--exif", "--set", "exif-rounding=0.1", "--images", "40", "--size", "16x16"}));
    const Json truth = truth_of("exif");
    double sum = 0, square = 0;
    for (size_t i = 0; i < 40; ++i) {
        const Json &image = truth["images"][i];
        const PictureMetadata m = read_metadata(work("exif/" + image["file"].get<std::string>()));
        assert_close(m.exif_ev.value_or(NAN), image["exif_ev"].get<double>(), 1e-8);
        const double error = image["exif_ev"].get<double>() - image["ev"].get<double>();
        sum += error, square += error * error;
    }
    assert_close(std::sqrt(square / 40 - sum * sum / 1600), 0.1, 0.04);
}

// With one manual exposure, all metadata are equal, and the true exposures scatter as requested.
void test_exif_tells_one_manual_exposure(void **) {
    must_exit(done, simulate("exif", {"--exif", "--set", "exif-manual=yes,exif-scatter=0.03,ev=0", "--images", "40",
                                      "--size", "16x16"}));
    const Json truth = truth_of("exif");
    double sum = 0, square = 0;
    for (size_t i = 0; i < 40; ++i) {
        const Json &image = truth["images"][i];
        const PictureMetadata m = read_metadata(work("exif/" + image["file"].get<std::string>()));
        assert_true(m.is_manual);
        assert_close(m.iso.value_or(0), 100, 0);
        assert_close(m.exif_ev.value_or(NAN), truth["images"][0]["exif_ev"].get<double>(), 1e-12);
        const double ev = image["ev"].get<double>();
        sum += ev, square += ev * ev;
    }
    assert_close(std::sqrt(square / 40 - sum * sum / 1600), 0.03, 0.01);
    must_exit(done, simulate("auto", {"--exif", "--images", "2"}));
    assert_false(read_metadata(picture_of("auto", 0)).is_manual);
}

// Without --exif, the metadata have camera, lens and aperture, but no exposure.
void test_no_exposure_without_exif(void **) {
    must_exit(done, simulate("quiet", {"--images", "2"}));
    const PictureMetadata m = read_metadata(picture_of("quiet", 0));
    assert_string_equal(m.key.camera_model, "Simulated Camera");
    assert_close(m.f_number.value_or(0), 2.8, 1e-9);
    assert_false(m.exposure_time_s || m.iso || m.exif_ev);
    assert_false(truth_of("quiet")["images"][0].contains("exif_ev"));
}

void test_mean_exposure(void **) {
    must_exit(done, simulate("dark", {"--set", "mean-ev=-3,ev=0.5,no-images=yes"}));
    const Json truth = truth_of("dark");
    for (const Json &image : truth["images"]) assert_close(image["ev"].get<double>(), -3, 0.5);
}

// 1000 pictures, each overlapping a few others: pairs are found for all of them.
void test_many_pictures(void **) {
    must_exit(done, {"simulate", "-o", work("many"), "--set", "no-images=yes", "--images", "1000", "--set",
                     "rows=28,hfov=4", "--set", "jitter=0.1,ev=0.5,mean-ev=-1,points=50000"});
    std::istringstream lines(text_of(work("many/points.txt")));
    std::vector<int> pairs(1000);
    size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        std::istringstream numbers(line);
        size_t a = 0, b = 0;
        numbers >> a >> b;
        ++pairs.at(a), ++pairs.at(b);
    }
    assert_int_equal(count, 50000);
    assert_true(*std::min_element(pairs.begin(), pairs.end()) > 0);
}

void test_refused_options(void **) {
    for (const Words &words :
         {Words{"--set", "objects=0.95"}, Words{"--set", "objects=nan"}, Words{"--set", "local-tone=5"},
          Words{"--set", "local-tone=nan"}, Words{"--set", "exif-rounding=0.1"}, Words{"--set", "mean-ev=9"},
          Words{"--set", "exif-manual=yes"}, Words{"--set", "exif-scatter=0.1"},
          Words{"--set", "exif-rounding=-1", "--exif"}})
        assert_refused(usage, simulate("s", words), {words[0]});
    assert_refused(usage, simulate("s", {"--exif", "--set", "no-images=yes"}), {"--exif", "--set no-images"});
    assert_refused(usage, simulate("s", {"--set", "center=1e9,0"}), {"--set center: the falloff must stay positive"});
    assert_refused(usage, simulate("s", {"--vignetting=-5,0,0"}), {"--vignetting: the falloff must stay positive"});
    assert_refused(usage, {"simulate", "-o", work("s"), "--response", "emor:1,,2"},
                   {"--response: ", "a value is missing before or after a comma"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_objects_in_pictures),
        CLI_TEST(test_objects_in_pairs),
        CLI_TEST(test_local_tone_in_pictures),
        CLI_TEST(test_local_tone_in_pairs),
        CLI_TEST(test_exif_tells_exposures),
        CLI_TEST(test_exif_is_rounded),
        CLI_TEST(test_exif_tells_one_manual_exposure),
        CLI_TEST(test_no_exposure_without_exif),
        CLI_TEST(test_mean_exposure),
        CLI_TEST(test_many_pictures),
        CLI_TEST(test_refused_options),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
