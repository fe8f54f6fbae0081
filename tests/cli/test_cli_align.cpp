// `lensprof align`: frames of simulated sequences whose overlapping pixels must agree afterwards, and refused input.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

constexpr uint32_t width = 160, height = 120, frame_count = 4;
constexpr double true_ev[frame_count] = {0.0, -0.8, 0.7, -1.4}, true_red[frame_count] = {1.0, 1.15, 0.9, 1.05};

double response(double x) { return std::pow(std::min(std::max(x, 0.0), 1.0), 1 / 2.2); }

// Light of the scene in one channel: soft blobs over three decades.
double light(uint32_t x, uint32_t y, uint32_t c) {
    double u = x / 23.0, v = y / 17.0;
    return 0.09 * std::exp(1.3 * std::sin(u + 0.3 * c) * std::cos(v - 0.2 * c) + 1.1 * std::sin(0.7 * v + u / 3));
}

std::string frame_name(size_t i) { return work("in/f" + std::to_string(i) + ".png"); }

// Frames of a stationary camera, each with its own exposure and red factor.
Words make_frames() {
    fs::create_directories(work("in"));
    Words files;
    for (size_t i = 0; i < frame_count; ++i) {
        Picture frame = make_noise(width, height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
        for (uint32_t y = 0; y < height; ++y)
            for (uint32_t x = 0; x < width; ++x)
                for (uint32_t c = 0; c < 3; ++c) {
                    double factor = std::exp2(true_ev[i]) * (c == 0 ? true_red[i] : 1.0);
                    frame.pixels[y * frame.row_bytes + 3 * x + c] =
                        static_cast<uint8_t>(std::lround(255 * response(light(x, y, c) * factor)));
                }
        write_picture(frame_name(i), frame);
        files.push_back(frame_name(i));
    }
    return files;
}

// RMS difference of two pictures, in levels, over pixels that were neither dark nor nearly saturated in both inputs.
double rms_difference(const Picture &a, const Picture &b, const Picture &source_a, const Picture &source_b) {
    double sum = 0, count = 0;
    for (size_t s = 0; s < a.pixels.size(); ++s) {
        auto good = [&](const Picture &p) { return p.pixels[s] >= 15 && p.pixels[s] <= 235; };
        if (!good(source_a) || !good(source_b) || !good(a) || !good(b)) continue;
        sum += std::pow(double(a.pixels[s]) - b.pixels[s], 2);
        count += 1;
    }
    assert_true(count > 1000);
    return std::sqrt(sum / count);
}

// All aligned frames look like frame `like`, which changes by rounding only.
void check_alike(const std::string &out, size_t like) {
    const std::string name = out + "/f" + std::to_string(like) + ".png";
    const Picture wanted = read_picture(frame_name(like));
    assert_true(rms_difference(read_picture(name), wanted, wanted, wanted) < 0.5);
    for (size_t i = 0; i < frame_count; ++i) {
        const Picture source = read_picture(frame_name(i));
        const Picture after = read_picture(out + "/f" + std::to_string(i) + ".png");
        assert_int_equal(after.sample, LENSPROF_SAMPLE_U8);
        assert_true(rms_difference(after, wanted, source, wanted) < 1.2);
        if (i != like) assert_true(rms_difference(source, wanted, source, wanted) > 8);
    }
}

void test_static_sequence(void **) {
    const Words frames = make_frames();
    for (const char *method : {"transfer", "transfer-function"}) {
        const std::string out = work(method);
        const Words words = Words{"align", "--fit", std::string("method=") + method} + frames;
        must_exit(done, words + Words{"--to", "first", "-o", out + "-first"});
        check_alike(out + "-first", 0);
        must_exit(done, words + Words{"--to", "last", "-o", out + "-last"});
        check_alike(out + "-last", frame_count - 1);
        must_exit(done, words + Words{"--to", "brightest", "-o", out + "-brightest"});
        check_alike(out + "-brightest", 2);
    }
}

// The mean is geometric: the frames agree, with a brightness between the darkest and the brightest.
void test_mean_and_json(void **) {
    const Words frames = make_frames();
    const Json json = json_of(Words{"align", "--json", "-o", work("mean")} + frames);
    assert_string_equal(json["to"].get<std::string>().c_str(), "mean");
    assert_true(json["usable"].get<bool>());
    assert_int_equal(json["frames"].size(), frame_count);
    const Picture one = read_picture(work("mean/f0.png")), other = read_picture(work("mean/f2.png"));
    assert_true(rms_difference(one, other, read_picture(frame_name(0)), read_picture(frame_name(2))) < 1.2);
    double scale = 0, product = 0;
    for (size_t i = 0; i < frame_count; ++i) {
        const double ev = json["frames"][i]["ev"].get<double>();
        assert_string_equal(json["frames"][i]["file"].get<std::string>().c_str(), frame_name(i).c_str());
        product += ev * true_ev[i];
        scale += true_ev[i] * true_ev[i];
    }
    for (size_t i = 0; i < frame_count; ++i)  // up to the exponent that pictures leave open
        assert_close(json["frames"][i]["ev"].get<double>(), product / scale * true_ev[i], 0.02);
    assert_true(json["residual"]["before_rms"].get<double>() > 10 * json["residual"]["noise"].get<double>());
}

// A rendered panorama: the camera moves and has a falloff, which the result does not have.
void test_moving_camera(void **) {
    must_exit(done, {"simulate", "-o", work("pano"), "--images", "5", "--size", "320x240", "--format", "png", "--set",
                     "ev=1,noise=1"});
    const std::string pto = work("pano/pano.pto");
    for (const char *method : {"transfer", "transfer-function"}) {
        const std::string out = work(std::string("aligned-") + method);
        const Json json = json_of({"align", "--fit", std::string("method=") + method, "--project", pto, "--to", "first",
                                   "-o", out, "--json"});
        assert_int_equal(json["frames"].size(), 5);
        assert_true(json["residual"]["heldout_median"].get<double>() < 2.0);
        // A fit of the aligned frames finds no falloff and equal exposures: nothing that is better than no correction.
        fs::copy(pto, out + "/pano.pto");
        const Json again = json_of({"build", out + "/pano.pto", "--no-store", "--json"}, not_usable);
        assert_string_equal(again["model"].get<std::string>().c_str(), "nothing");
        for (const Json &image : again["images"]) assert_close(image["ev"].get<double>(), 0.0, 0.1);
        const Json &k = again["vignetting"]["k"][0];
        assert_close(k[0].get<double>() + k[1].get<double>() + k[2].get<double>(), 0.0, 0.08);
    }
    must_exit(done, {"align", "--project", pto, "-o", work("one"), work("pano/img001.png")});
    assert_int_equal(std::distance(fs::directory_iterator(work("one")), fs::directory_iterator()), 1);
}

// White pixels stay white although they lack their true value, and dark frames are noisy: warnings name the frames
// concerned.
void test_limits_are_said(void **) {
    Words frames = make_frames();
    const Outcome first = run_words(Words{"align", "--to", "last", "-o", work("dark")} + frames);
    assert_int_equal(first.code, done);
    assert_true(contains(first.err, frames[2] + ": ") && contains(first.err, "use --to brightest to keep white"));
    const Outcome brightest = run_words(Words{"align", "--to", "brightest", "-o", work("bright")} + frames);
    assert_int_equal(brightest.code, done);
    assert_false(contains(brightest.err, "keep white"));
    fs::create_directories(work("pano"));
    must_exit(done, {"simulate", "-o", work("pano"), "--images", "3", "--size", "160x120", "--format", "png"});
    assert_refused(not_usable, {"align", work("pano/img000.png"), work("pano/img001.png"), "-o", work("out")},
                   {"--project"});
}

void test_refusals(void **) {
    const Words frames = make_frames();
    const Words two = {frames[0], frames[1]};
    write_picture(work("in/small.png"), make_noise(80, 60, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
    write_picture(work("in/noise.png"), make_noise(width, height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
    save_text(work("in/text.png"), "no picture");
    const Words out = {"-o", work("out")};
    auto refuse = [&](int code, const Words &words, const char *said) {
        assert_refused(code, Words{"align"} + words, {said});
    };
    refuse(usage, out, "no frames");
    refuse(usage, Words{frames[0]} + out, "one picture");
    refuse(unreadable, Words{work("in")} + out, "is a folder; give its pictures");
    refuse(unreadable, Words{frames[0], work("in/small.png")} + out, "80 x 60");
    refuse(not_usable, Words{frames[0], work("in/noise.png")} + out, "");
    refuse(unreadable, Words{frames[0], work("in/text.png")} + out, "text.png");
    refuse(unreadable, Words{frames[0], work("in/none.png")} + out, "none.png");
    refuse(usage, two + Words{"-o", work("in")}, "overwritten");
    refuse(usage, Words{frames[0], frames[0]} + out, "twice");
    refuse(usage, two + out + Words{"--to", "darkest"}, "--to");
    refuse(usage, two + out + Words{"--fit", "method=magic"}, "--fit method");
    refuse(usage, two + out + Words{"--fit", "gamma-from=known"}, "--fit gamma-from");
    refuse(usage, two + out + Words{"--fit", "max-side=32"}, "--fit max-side");
    refuse(unreadable, Words{"--project", work("in/none.pto")} + out, "none.pto");
    refuse(usage, two + Words{"-o", work("in/text.png")}, "text.png is not a folder");
    refuse(usage, two + Words{"-o", work("in/text.png/deeper")}, "text.png is not a folder");
}

// If no fit is possible, --json still prints the object, with the reason.
void test_object_without_a_fit(void **) {
    Picture white = make_noise(width, height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    std::fill(white.pixels.begin(), white.pixels.end(), uint8_t(255));
    for (const char *name : {"a.png", "b.png"}) write_picture(work(name), white);
    const Json json = json_of({"align", work("a.png"), work("b.png"), "-o", work("out"), "--json"}, not_usable);
    assert_false(json["usable"].get<bool>());
    assert_string_equal(code_of(json).c_str(), "few_pairs");
    assert_true(contains(text_of(json), "black"));
    assert_true(json["frames"] == Json::array() && json["residual"]["heldout_rms"].is_null());
    assert_false(fs::exists(work("out")));
}

// No input picture may be overwritten, however its name is spelled.
void test_inputs_stay(void **) {
    const Words frames = make_frames();
    fs::create_directories(work("other"));
    fs::create_directory_symlink(work("in"), work("link"));
    fs::copy(frames[1], work("other/f0.png"));
    fs::copy(frames[1], work("other/f1.png"));
    auto refuse = [&](const Words &words, const char *said) { assert_refused(usage, Words{"align"} + words, {said}); };
    refuse({frames[0], frames[1], "-o", work("other/../in")}, "overwritten");
    refuse({frames[0], frames[1], "-o", work("link")}, "overwritten");
    refuse({frames[0], work("other/f1.png"), "-o", work("other")}, "overwritten");
    refuse({frames[0], work("other/f0.png"), "-o", work("out")}, "two pictures");
    must_exit(done, {"simulate", "-o", work("pano"), "--images", "3", "--size", "160x120", "--format", "png"});
    fs::create_directories(work("far"));
    fs::copy(work("pano/img000.png"), work("far/img001.png"));  // a picture of the project under another picture's name
    std::string pto = text_of(work("pano/pano.pto"));
    pto.replace(pto.find("img000.png"), 10, "../far/img001.png");
    save_text(work("pano/far.pto"), pto);
    refuse({"--project", work("pano/far.pto"), work("far/img001.png"), "-o", work("pano")},
           "would overwrite an input "
           "picture");
}

void test_build_by_transfer_functions(void **) {
    must_exit(done, {"simulate", "-o", work("pano"), "--images", "5", "--size", "320x240", "--format", "png", "--set",
                     "ev=1"});
    const Json json =
        json_of({"build", work("pano/pano.pto"), "--db", work("p.db"), "--fit", "method=transfer-function", "--json"});
    assert_true(json["usable"].get<bool>());
    assert_true(json["residual"]["heldout_median"].get<double>() < 2.0);
    const Json profile = json_of({"profile", "show", "1", "--db", work("p.db"), "--json"});
    assert_string_equal(profile["provenance"]["method"].get<std::string>().c_str(), "transfer-function");
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_static_sequence), CLI_TEST(test_mean_and_json),
        CLI_TEST(test_moving_camera),   CLI_TEST(test_limits_are_said),
        CLI_TEST(test_refusals),        CLI_TEST(test_object_without_a_fit),
        CLI_TEST(test_inputs_stay),     CLI_TEST(test_build_by_transfer_functions),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
