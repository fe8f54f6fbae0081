// `lensprof calibrate` of frames of a moving camera: a folder of rendered frames, and videos that ffmpeg makes of them.
#include <functional>
#include <map>
#include <sstream>

#include "clip_scenes.hpp"

#include "photo/clip/camera_motion.hpp"
#include "photo/video/video.hpp"

using namespace clip_scenes;

namespace {

constexpr uint32_t frames = 48;

// Builds without libav or OpenCV do not read clips.
void skip_without_video() {
    if (!can_read_video()) skip();
}

std::vector<std::vector<double>> numbers_in(const std::string &path) {
    std::vector<std::vector<double>> lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        lines.emplace_back();
        for (double value; words >> value;) lines.back().push_back(value);
    }
    return lines;
}

// The largest error of the exposures in times.txt, EV.
double exposure_error(const std::string &out, uint32_t count) {
    const auto lines = numbers_in(in_folder(out) + "/times.txt");
    assert_int_equal(lines.size(), count);
    double sum = 0.0, largest = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        assert_int_equal(lines[i].size(), 3);
        sum += std::log2(lines[i][2]) - true_ev(i);
    }
    for (uint32_t i = 0; i < count; i++)
        largest = std::max(largest, std::abs(std::log2(lines[i][2]) - true_ev(i) - sum / count));
    return largest;
}

// The share of the frames of exposures.json whose error, relative to the mean, is within 1.96 standard errors.
double share_within_errors(const std::string &out, uint32_t step) {
    const Json json = parsed(text_of(in_folder(out) + "/exposures.json"))["frames"];
    std::vector<double> errors;
    double sum = 0.0, within = 0.0;
    for (size_t i = 0; i < json.size(); i++) {
        errors.push_back(json[i]["ev"].get<double>() - true_ev(static_cast<uint32_t>(i) * step));
        sum += errors.back();
    }
    const auto count = static_cast<double>(errors.size());
    for (size_t i = 0; i < errors.size(); i++)
        within += std::abs(errors[i] - sum / count) < 1.96 * json[i]["ev_sigma"].get<double>();
    return within / count;
}

void assert_model(const std::string &out) {
    std::vector<double> response;
    for (const auto &line : numbers_in(in_folder(out) + "/pcalib.txt"))
        response.insert(response.end(), line.begin(), line.end());
    assert_int_equal(response.size(), 256);
    for (size_t i = 1; i < response.size(); i++) assert_true(response[i] > response[i - 1]);
    for (const size_t level : {size_t(60), size_t(120), size_t(180)})
        assert_close(255.0 * std::pow(response[level] / response[255], 1.0 / gamma_of_camera), double(level), 3.0);
    const Picture map = read_picture(in_folder(out) + "/vignette.png");
    assert_true(map.width == width && map.height == height && map.sample == LENSPROF_SAMPLE_U16);
    for (const uint32_t x : {0u, 40u, width / 2, width - 1}) {
        const double found = sample_value(map.sample, &map.pixels[30 * map.row_bytes], x);
        assert_close(found, true_falloff(x, 30), 0.015);
    }
}

// Response, falloff and exposures of a folder as cameras of visual odometry record it.
void test_folder(void **) {
    skip_without_video();
    fs::create_directories(folder / "levelled");
    save_text(in_folder("levelled/frame_00099.png"), "of a longer clip");
    save_text(in_folder("levelled/notes.txt"), "kept");
    const Json json = json_of({"calibrate", in_folder("moving"), "-o", in_folder("out"), "--frames",
                               in_folder("levelled"), "--overwrite", "--report", in_folder("out/page.html"), "--json"});
    assert_false(fs::exists(in_folder("levelled/frame_00099.png")));
    assert_true(fs::exists(in_folder("levelled/notes.txt")));
    assert_int_equal(json["clip"]["measured"].get<int>(), frames);
    assert_int_equal(json["clip"]["segments"].get<int>(), 1);
    assert_string_equal(json["gamma_from"].get<std::string>().c_str(), "exif");
    assert_true(json["clip"]["times_rms_ev"].get<double>() < 0.02);
    assert_true(exposure_error("out", frames) < 0.02);
    assert_model("out");
    const std::string page = text_of(in_folder("out/page.html"));
    assert_true(contains(page, "Calibration from the frames of a clip"));
    assert_true(contains(page, "\"frame 48\"") && contains(page, "\"falloffs\":[{"));
    // The same wall at different exposures looks the same in levelled frames.
    const Picture first = read_picture(in_folder("levelled") + "/frame_00010.png"),
                  later = read_picture(in_folder("levelled") + "/frame_00014.png");
    double difference = 0.0;
    size_t count = 0;
    for (uint32_t y = 60; y < 180; y++)
        for (uint32_t x = 60; x < 240; x++, count++) {
            const double y_moved = y + 15.0 * (std::sin(9 / 9.0) - std::sin(13 / 9.0));
            difference += later.pixels[size_t(std::lround(y_moved)) * later.row_bytes + 3 * (x - 36)]
                          - double(first.pixels[y * first.row_bytes + 3 * x]);
        }
    assert_close(difference / double(count), 0.0, 2.0);
}

void test_video(void **) {
    skip_without_video();
    const std::string clip = encoded("moving", "clip.mkv", "-c:v ffv1 -pix_fmt yuv444p");
    const std::string text = must_exit(done, {"calibrate", clip, "-o", in_folder("seen"), "--no-store", "--times",
                                              in_folder("moving") + "/times.txt"});
    assert_true(contains(text, "48 frames of 320 x 240 pixels, 48 measured"));
    assert_true(exposure_error("seen", frames) < 0.02);
    assert_model("seen");
    assert_true(share_within_errors("seen", 1) > 0.9);
    // Every other frame.
    const Outcome unknown = run_words({"calibrate", clip, "-o", in_folder("part"), "--fps", "12.5"});
    assert_int_equal(unknown.code, done);
    assert_int_equal(numbers_in(in_folder("part") + "/times.txt").size(), frames / 2);
    assert_true(share_within_errors("part", 2) > 0.8);
    assert_true(contains(unknown.err, "the exposure times are unknown; the exponent"));
    assert_true(contains(unknown.err, "states no camera, so that no profile is stored"));
}

// A given response determines the exponent without exposure times. One of another shape is refused.
void test_known_response(void **) {
    skip_without_video();
    const auto words_with = [](const std::string &response, const std::string &out) {
        return Words{
            "calibrate", in_folder("moving/images"), "--moving", "-o", in_folder(out), "--no-store", "--response",
            response};
    };
    const Outcome named = run_words(words_with("gamma:2.2", "named"));
    assert_int_equal(named.code, done);
    assert_false(contains(named.err, "exponent"));
    assert_true(exposure_error("named", frames) < 0.02);
    assert_model("named");
    must_exit(done, words_with(in_folder("named/pcalib.txt"), "of_file"));
    assert_true(exposure_error("of_file", frames) < 0.02);
    assert_refused(usage, words_with(in_folder("of_file/pcalib.txt"), "of_file"), {"pcalib.txt: would be overwritten"});
    assert_refused(
        not_usable,
        {"calibrate", in_folder("moving"), "-o", in_folder("nothing"), "--no-store", "--response", "gamma:1.5"},
        {"the given response and times contradict each other", "times as large in EV"});
    assert_refused(not_usable, words_with("film", "nothing"),
                   {"the given response leaves a residual of", "give the response of this camera at these settings"});
    save_text(in_folder("short.txt"), "0 1 2\n");
    assert_refused(unreadable, words_with(in_folder("short.txt"), "nothing"), {"short.txt"});
    assert_refused(unreadable, words_with(in_folder("moving/images/00000.png"), "nothing"), {"00000.png"});
    assert_refused(usage, words_with(in_folder("missing.txt"), "nothing"), {"--response", "or an existing file"});
    assert_refused(usage, {"calibrate", in_folder("moving/images"), "-o", in_folder("nothing"), "--response", "srgb"},
                   {"--response: is for clips", "add --moving"});
    assert_false(fs::exists(in_folder("nothing")));
}

// A pan through a lens without falloff, with the response of a power, shows exposures alone: files of response and
// falloff are not written.
void test_exposures_only(void **) {
    skip_without_video();
    const Wall wall;
    fs::create_directories(folder / "even");
    for (uint32_t i = 0; i < 24; i++) {
        Picture frame = rendered_black();
        uint32_t state = i + 1;
        for (uint32_t y = 0; y < height; y++)
            for (uint32_t x = 0; x < width; x++)
                for (size_t c = 0; c < 3; c++) {
                    state = state * 1664525u + 1013904223u;
                    const double light =
                        std::min(0.5 * wall.at(x + 6.0 * i, y + 20.0, c) * std::exp2(0.15 * true_ev(i)), 1.0);
                    const double level = 255.0 * std::pow(light, 1.0 / gamma_of_camera) + (state >> 24) / 256.0;
                    frame.pixels[y * frame.row_bytes + 3 * x + c] = static_cast<uint8_t>(std::min(level, 255.0));
                }
        write_picture(in_folder("even/" + frame_name(i)), frame);
    }
    const Outcome outcome =
        run_words({"calibrate", in_folder("even"), "--moving", "-o", in_folder("exposed"), "--no-store"});
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "[exposures_only]"));
    assert_true(contains(outcome.err, "pcalib.txt and vignette.png are not written"));
    assert_true(fs::exists(in_folder("exposed/times.txt")));
    assert_false(fs::exists(in_folder("exposed/pcalib.txt")) || fs::exists(in_folder("exposed/vignette.png")));
}

// Times connect the scenes before and after a cut; without them each has its own mean.
void test_scenes(void **) {
    skip_without_video();
    constexpr uint32_t first_scene = 20, skipped = 14;
    fs::create_directories(folder / "scenes/images");
    std::ofstream times(in_folder("scenes/times.txt"));
    std::vector<double> ev;
    for (uint32_t i = 0; i < frames; i += i + 1 == first_scene ? skipped + 1 : 1) {
        fs::copy_file(in_folder("moving/images/" + frame_name(i)), in_folder("scenes/images/" + frame_name(i)));
        times << i << " " << i / 25.0 << " " << 10.0 * std::exp2(true_ev(i)) << "\n";
        ev.push_back(true_ev(i));
    }
    times.close();
    const Json json = json_of({"calibrate", in_folder("scenes"), "-o", in_folder("joined"), "--json"});
    assert_int_equal(json["clip"]["segments"].get<int>(), 2);
    const auto step_of = [&](const Json &found) {  // from the first scene to the second
        const Json &of_frames = found["clip"]["frames"];
        return of_frames[30]["ev"].get<double>() - of_frames[10]["ev"].get<double>();
    };
    assert_close(step_of(json), ev[30] - ev[10], 0.03);
    fs::remove(in_folder("scenes/times.txt"));
    const Json apart =
        json_of({"calibrate", in_folder("scenes"), "--moving", "-o", in_folder("apart"), "--no-store", "--json"});
    assert_int_equal(apart["clip"]["segments"].get<int>(), 2);
    assert_true(std::abs(step_of(apart) - (ev[30] - ev[10])) > 0.1);
}

Picture plain(uint8_t red, uint8_t green, uint8_t blue) {
    Picture frame = rendered_black();
    for (size_t i = 0; i < frame.pixels.size(); i += 3)
        frame.pixels[i] = red, frame.pixels[i + 1] = green, frame.pixels[i + 2] = blue;
    return frame;
}

// A stationary camera: levelled frames have one brightness.
void test_deflicker(void **) {
    skip_without_video();
    write_frames("tripod", 24, 0.0, false);
    const std::string clip = encoded("tripod", "tripod.mkv", "-c:v ffv1 -pix_fmt yuv444p");
    must_exit(done, {"deflicker", clip, "-o", in_folder("even"), "--to", "mean", "--response", "gamma:2.2"});
    const auto middle_of = [&](uint32_t number) {
        char name[32];
        std::snprintf(name, sizeof name, "/frame_%05u.png", number);
        const Picture frame = read_picture(in_folder("even") + name);
        double sum = 0.0;  // of pixels that no frame saturates
        for (uint32_t y = 180; y < 240; y++)
            for (uint32_t x = 0; x < 60; x++) sum += frame.pixels[y * frame.row_bytes + 3 * x];
        return sum / (60 * 60);
    };
    for (const uint32_t number : {6u, 13u, 24u}) assert_close(middle_of(number), middle_of(1), 1.5);
    const Outcome moving =
        run_words({"deflicker", encoded("moving", "m.mkv", "-c:v ffv1 -pix_fmt yuv444p"), "-o", in_folder("uneven")});
    assert_int_equal(moving.code, not_usable);
    assert_true(contains(moving.err, "`lensprof calibrate`"));
}

// Plain frames before the motion do not show a stationary camera.
void test_moves_after_a_title(void **) {
    skip_without_video();
    constexpr uint32_t title_frames = 95;  // more than the first three seconds
    fs::create_directories(folder / "titled/images");
    write_picture(in_folder("title.png"), plain(90, 90, 90));
    write_frames("slow", 24, 5.0, false);
    for (uint32_t i = 0; i < title_frames + 24; i++)
        fs::copy_file(
            i < title_frames ? in_folder("title.png") : in_folder("slow/images/" + frame_name(i - title_frames)),
            in_folder("titled/images/" + frame_name(i)));
    const std::string clip = encoded("titled", "titled.mkv", "-c:v ffv1 -pix_fmt yuv444p");
    assert_refused(not_usable, {"deflicker", clip, "-o", in_folder("uneven")},
                   {"the camera moves by", "`lensprof calibrate`"});
}

// Nothing that is read is replaced, and nothing else without permission, unless an earlier run wrote it.
void test_what_is_kept(void **) {
    skip_without_video();
    fs::create_directories(folder / "kept");
    fs::create_directories(folder / "linked/images");
    for (uint32_t i = 0; i < 12; i++) {
        char name[32];
        std::snprintf(name, sizeof name, "/frame_%05u.png", i + 1);
        fs::copy_file(in_folder("moving/images/" + frame_name(i)), in_folder("kept") + name);
        fs::create_hard_link(in_folder("kept") + name, in_folder("linked/images") + name);
    }
    Json listed = {
        {"frames", {{{"file_path", "../kept/frame_00001.png"}}, {{"file_path", "../kept/frame_00002.png"}}}}};
    fs::create_directories(folder / "list");
    save_text(in_folder("list/transforms.json"), listed.dump());
    save_text(in_folder("kept.txt"), text_of(in_folder("moving/times.txt")));
    fs::create_directories(folder / "theirs");
    save_text(in_folder("theirs/times.txt"), "theirs\n");
    fs::copy(in_folder("moving"), in_folder("own"), fs::copy_options::recursive);
    const auto refused = [](const Words &words, const std::string &output, const Words &named) {
        assert_refused(usage, Words{"calibrate"} + words + Words{"--no-store", "-o", in_folder(output)}, named);
    };
    const Words moving = {in_folder("kept"), "--moving", "--overwrite"};
    refused(moving + Words{"--frames", in_folder("kept") + "/"}, "none", {"is the input"});
    refused(moving + Words{"--frames", in_folder("linked/images")}, "none", {".png: is a frame of the input"});
    refused({in_folder("list"), "--frames", in_folder("linked"), "--overwrite"}, "none", {".png: is a frame of the"});
    refused({in_folder("moving"), "--frames", in_folder("kept")}, "none", {"kept/frame_00001.png: exists"});
    refused({in_folder("own"), "--overwrite"}, "own", {"own/times.txt: would be overwritten"});
    refused(moving + Words{"--times", in_folder("theirs/times.txt")}, "theirs", {"theirs/times.txt: would be"});
    refused({in_folder("moving")}, "theirs", {"theirs/times.txt: exists, and no earlier run wrote it", "--overwrite"});
    const std::string clip = encoded("moving", "k.mkv", "-c:v ffv1 -pix_fmt yuv444p");
    refused({clip, "--frames", in_folder("k.mp4")}, "k.mp4", {"k.mp4: another output has this name"});
    refused({clip, "--frames", in_folder("k.mp4")}, "k.mp4/below", {"k.mp4: another output has this name"});
    refused({clip, "--frames", in_folder("o/times.txt")}, "o", {"times.txt: another output has this name"});
}

// Grey frames of 16 bits are written as JPEG, and a folder may have any name; a second run replaces its own files.
void test_deep_grey_frames(void **) {
    skip_without_video();
    const std::string name = in_folder("caf\xe9");
    fs::create_directories(name);
    for (uint32_t i = 0; i < 24; i++) {
        const Picture colour = read_picture(in_folder("moving/images/" + frame_name(i)));
        Picture grey;
        grey.width = grey.frame_width = width, grey.height = grey.frame_height = height;
        grey.layout = LENSPROF_LAYOUT_GREY, grey.sample = LENSPROF_SAMPLE_U16;
        grey.row_bytes = size_t(2) * width;
        grey.pixels.resize(grey.row_bytes * height);
        for (size_t n = 0; n < size_t(width) * height; n++) {
            const auto level = static_cast<uint16_t>(257 * colour.pixels[3 * n + 1]);
            std::memcpy(&grey.pixels[2 * n], &level, sizeof level);
        }
        write_picture(name + "/" + frame_name(i), grey);
    }
    const Words words = {"calibrate", name, "--moving", "--no-store", "-o", in_folder("grey")};
    must_exit(done, words + Words{"--frames", in_folder("grey_frames"), "--codec", "jpeg"});
    const Picture levelled = read_picture(in_folder("grey_frames/frame_00001.jpg"));
    assert_true(levelled.layout == LENSPROF_LAYOUT_GREY && levelled.width == width && levelled.height == height);
    assert_true(contains(text_of(in_folder("grey/exposures.svg")), "</svg>"));
    assert_true(fs::exists(in_folder("grey/vignette.png")));
    must_exit(done, words);
}

// Exposure times of the frames of "moving"; NaN: none.
void write_times(const std::string &name, const std::function<double(uint32_t)> &ev) {
    std::ofstream times(in_folder(name));
    for (uint32_t i = 0; i < frames; i++) {
        times << i << " " << i;
        if (std::isfinite(ev(i))) times << " " << 10.0 * std::exp2(ev(i));
        times << "\n";
    }
}

Words words_with_times(const std::string &times) {
    return {"calibrate", in_folder("moving"), "-o", in_folder("slip"), "--no-store", "--times", in_folder(times)};
}

// One wrong exposure time, also the first or last, is named and not used; many are refused.
void test_wrong_lines(void **) {
    skip_without_video();
    for (const auto &slip : {std::pair{16u, -3.0}, {frames - 1, -0.4}}) {
        write_times("slip.txt", [&](uint32_t i) { return true_ev(i) + (i == slip.first ? slip.second : 0.0); });
        const Outcome outcome = run_words(words_with_times("slip.txt"));
        assert_int_equal(outcome.code, done);
        assert_true(contains(outcome.err, "are not used: frame " + std::to_string(slip.first + 1) + "\n"));
        assert_true(exposure_error("slip", frames) < 0.02);
        assert_model("slip");
    }
    write_times("slip.txt", [](uint32_t i) { return true_ev(i) + (i % 5 == 2 ? 1.0 : 0.0); });
    assert_refused(not_usable, words_with_times("slip.txt"), {"given exposure"});
}

// Few known exposures, right within 0.04 EV, are neither refused nor left out: they do not show what is wrong.
void test_few_lines(void **) {
    skip_without_video();
    const std::map<uint32_t, double> errors{{0, 0.04}, {1, -0.04}, {22, 0.04}, {47, -0.04}};
    write_times("few_known.txt", [&](uint32_t i) { return errors.count(i) ? true_ev(i) + errors.at(i) : NAN; });
    const Outcome outcome = run_words(words_with_times("few_known.txt"));
    assert_int_equal(outcome.code, done);
    assert_false(contains(outcome.err, "not used"));
    assert_true(exposure_error("slip", frames) < 0.1);
}

void test_refusals(void **) {
    skip_without_video();
    write_frames("still", 12, 0.0, false);
    const Outcome still = run_words({"calibrate", in_folder("still"), "-o", in_folder("nothing")});
    assert_int_equal(still.code, not_usable);
    assert_true(contains(still.err, "does not move in the first 12 frames"));
    assert_true(contains(still.err, "`lensprof deflicker`"));
    assert_false(fs::exists(in_folder("nothing")));
    std::ofstream sweep(in_folder("still/times.txt"));
    for (uint32_t i = 0; i < 12; i++) sweep << i << " " << i << " " << std::exp2(0.5 * i) << "\n";
    sweep.close();
    assert_refused(not_usable, {"calibrate", in_folder("still"), "-o", in_folder("nothing")},
                   {"differ by 5.5 EV: of a sweep of exposures `lensprof bracket` measures the response"});
    assert_refused(usage,
                   {"calibrate", in_folder("moving"), "-o", in_folder("nothing"), "--report",
                    in_folder("moving/times.html"), "--times", in_folder("moving/times.html")},
                   {"times.html"});
    std::ofstream(in_folder("few.txt")) << "0 0.0 10\n1 0.04 11\n";
    write_frames("brief", 12, 9.0, false);
    const Outcome photographs = run_words({"calibrate", in_folder("brief/images"), "-o", in_folder("pictures")});
    assert_true(contains(photographs.err, "has numbered pictures without EXIF"));
    assert_true(contains(photographs.err, "--moving"));
    const Outcome few =
        run_words({"calibrate", in_folder("brief"), "-o", in_folder("nothing"), "--times", in_folder("few.txt")});
    assert_int_equal(few.code, unreadable);
    assert_true(contains(few.err, "few.txt: has 2 lines, but the clip has 12 frames"));
    for (const std::string exposure : {"1e300", "1e-25", "-3"}) {
        save_text(in_folder("wild.txt"), "0 0 10\n1 1 " + exposure + "\n");
        assert_refused(unreadable,
                       {"calibrate", in_folder("moving"), "-o", in_folder("nothing"), "--times", in_folder("wild.txt")},
                       {"wild.txt: line 2: the exposure time is " + exposure, "correct it, or omit it if unknown"});
    }
    write_times("swapped.txt", [](uint32_t i) { return true_ev(frames - 1 - i); });
    const Outcome wrong =
        run_words({"calibrate", in_folder("moving"), "-o", in_folder("nothing"), "--times", in_folder("swapped.txt")});
    assert_int_equal(wrong.code, not_usable);
    assert_true(contains(wrong.err, "the given exposure times differ from what the frames show by"));
    assert_false(fs::exists(in_folder("nothing")));
    for (const uint32_t lines : {1u, 4u}) {
        write_times("late.txt", [&](uint32_t i) { return true_ev(i < lines ? 0 : i - lines); });
        assert_refused(not_usable,
                       {"calibrate", in_folder("moving"), "-o", in_folder("nothing"), "--times", in_folder("late.txt")},
                       {"fit the frames better if they are moved up by " + std::to_string(lines) + " line"});
    }
    assert_true(
        contains(run_words({"calibrate", in_folder("moving"), in_folder("brief"), "-o", in_folder("nothing")}).err,
                 "moving: is a clip, which is calibrated alone"));
    const char *const temporary = std::getenv("TMPDIR");
    const std::string usual = temporary ? temporary : "/tmp";
    setenv("TMPDIR", in_folder("none").c_str(), 1);  // where scene points wait
    assert_refused(failed, {"calibrate", in_folder("brief"), "-o", in_folder("nothing"), "--no-store"},
                   {"none: No such file", "set TMPDIR to a folder with space"});
    setenv("TMPDIR", usual.c_str(), 1);
    std::ofstream(in_folder("junk.mp4")) << "not a video";
    assert_true(contains(run_words({"calibrate", in_folder("junk.mp4"), "-o", in_folder("nothing")}).err,
                         "junk.mp4: is not a video, or its beginning is damaged"));
    for (const Words &option : {Words{"--moving"}, {"--fps", "5"}, {"--frames", in_folder("levelled")}})
        assert_true(
            contains(run_words(Words{"calibrate", in_folder("few.txt"), "-o", in_folder("nothing")} + option).err,
                     option[0] + ": is for clips; give one video"));
}

// Frames that a look at the beginning of a clip decodes: one in six, in uneven steps.
bool is_looked_at(uint32_t i) {
    const uint32_t at = i % 30;
    return at == 0 || at == 5 || at == 12 || at == 16 || at == 24;
}

// A stationary camera is named after a look at one frame in six: the others, which are damaged here, are not decoded.
// A clip that moves after a still second is a clip.
void test_still_start(void **) {
    skip_without_video();
    write_frames("tripod_seen", 12, 0.0, false);
    fs::create_directories(folder / "long_still");
    const std::string damaged = text_of(in_folder("tripod_seen/images/00001.png")).substr(0, 3000);
    for (uint32_t i = 0; i < 130; i++) {
        const std::string name = in_folder("long_still/" + frame_name(i));
        if (is_looked_at(i))
            fs::copy_file(in_folder("tripod_seen/images/" + frame_name(i / 6 % 12)), name);
        else
            save_text(name, damaged);
    }
    const Outcome still =
        run_words({"calibrate", in_folder("long_still"), "--moving", "-o", in_folder("nothing"), "--no-store"});
    assert_int_equal(still.code, not_usable);
    assert_true(contains(still.err, "does not move in the first 120 frames, which"));
    fs::create_directories(folder / "late_start");
    for (uint32_t i = 0; i < 24 + frames; i++)
        fs::copy_file(in_folder("moving/images/" + frame_name(i < 24 ? 0 : i - 24)),
                      in_folder("late_start/" + frame_name(i)));
    must_exit(done, {"calibrate", in_folder("late_start"), "--moving", "-o", in_folder("late"), "--no-store"});
}

// A shake whose period is the mean step of the look, or part of it, is motion: all frames are decoded, up to the first
// damaged one.
void test_periodic_shake(void **) {
    skip_without_video();
    const std::string damaged = text_of(in_folder("moving/images/00001.png")).substr(0, 3000);
    for (const std::vector<uint32_t> &shake : {std::vector<uint32_t>{0, 1, 2, 3, 2, 1}, {0, 1, 2}, {0, 2}}) {
        const std::string name = "shake" + std::to_string(shake.size());
        fs::create_directories(folder / name);
        for (uint32_t i = 0; i < 130; i++) {
            const std::string frame = in_folder(name + "/" + frame_name(i));
            if (i <= 12 || i % 6 == 0 || is_looked_at(i))
                fs::copy_file(in_folder("moving/images/" + frame_name(shake[i % shake.size()])), frame);
            else
                save_text(frame, damaged);
        }
        assert_refused(unreadable, {"calibrate", in_folder(name), "--moving", "-o", in_folder("nothing"), "--no-store"},
                       {"00013.png"});
    }
}

// Frames of one colour do not show that the camera is stationary: those before the motion do not matter, and a clip of
// nothing else is named.
void test_plain_frames(void **) {
    skip_without_video();
    constexpr uint32_t plain_frames = 150;
    fs::create_directories(folder / "lead_in");
    write_picture(in_folder("grey.png"), plain(128, 128, 128));
    write_picture(in_folder("blue.png"), plain(20, 40, 200));
    write_picture(in_folder("black.png"), rendered_black());
    for (uint32_t i = 0; i < plain_frames + frames; i++)
        fs::copy_file(i < plain_frames ? in_folder(i < plain_frames / 2 ? "grey.png" : "blue.png")
                                       : in_folder("moving/images/" + frame_name(i - plain_frames)),
                      in_folder("lead_in/" + frame_name(i)));
    const Json json =
        json_of({"calibrate", in_folder("lead_in"), "--moving", "-o", in_folder("led"), "--no-store", "--json"});
    assert_int_equal(json["clip"]["measured"].get<int>(), frames);
    for (const std::string colour : {"black", "grey"}) {
        fs::create_directories(folder / ("all_" + colour));
        for (uint32_t i = 0; i < 10; i++)
            fs::copy_file(in_folder(colour + ".png"), in_folder("all_" + colour + "/" + frame_name(i)));
        assert_refused(not_usable,
                       {"calibrate", in_folder("all_" + colour), "--moving", "-o", in_folder("nothing"), "--no-store"},
                       {"all 10 frames are black, white or of one colour", "give a clip of a camera that moves"});
    }
}

// Black frames, counted where they are advanced to and where they are decoded.
struct BlackFrames : FrameSource {
    struct Count {
        uint64_t advanced = 0, decoded = 0;
    };

    explicit BlackFrames(Count &counts) : count(counts) {}
    const VideoInfo &info() const override { return facts; }
    std::string name_of(uint64_t) const override { return {}; }
    std::vector<std::string> files() const override { return {}; }
    std::unique_ptr<FrameSource> again() const override { return std::make_unique<BlackFrames>(count); }

    bool next(VideoFrame &frame) override {
        frame.number = count.advanced, frame.seconds = double(count.advanced) / 25.0;
        return count.advanced++ < 5000;
    }

    void read(Picture &picture) override {
        picture = rendered_black();
        count.decoded++;
    }

    Count &count;
    VideoInfo facts;
};

// The look at the beginning of a long black clip ends.
void test_look_is_bounded(void **) {
    skip_without_video();
    BlackFrames::Count count;
    const BlackFrames source(count);
    assert_int_equal(find_still_start(source).frames, 0);
    assert_in_range(count.advanced, 200, 250);
    assert_in_range(count.decoded, 30, 50);
}

// Wrong times are named before later frames are read, here damaged ones: by the number of lines, and by their changes.
void test_wrong_times_are_named_early(void **) {
    skip_without_video();
    constexpr uint32_t count = 310, swing = frames - 1;  // to and fro
    const auto place = [](uint32_t i) { return i % (2 * swing) < swing ? i % swing : swing - i % swing; };
    fs::create_directories(folder / "swing");
    for (uint32_t i = 0; i < count; i++) {
        const std::string name = in_folder("swing/" + frame_name(i));
        if (i < 302)
            fs::copy_file(in_folder("moving/images/" + frame_name(place(i))), name);
        else
            save_text(name, text_of(in_folder("moving/images/00000.png")).substr(0, 3000));
    }
    const auto refusal = [&](uint32_t lines, double (*ev)(uint32_t)) {
        std::ofstream times(in_folder("swing.txt"));
        for (uint32_t i = 0; i < lines; i++) times << i << " " << i << " " << 10.0 * std::exp2(ev(i)) << "\n";
        times.close();
        const Outcome outcome = run_words({"calibrate", in_folder("swing"), "--moving", "-o", in_folder("nothing"),
                                           "--times", in_folder("swing.txt"), "--no-store"});
        assert_true(outcome.code != done);
        return outcome.err;
    };
    assert_true(contains(refusal(count - 1, true_ev), "swing.txt: has 309 lines, but the clip has 310 frames"));
    assert_true(contains(refusal(count, [](uint32_t i) { return std::cos(i * i / 7.0); }),
                         "the given exposure times differ from what the frames show by"));
    assert_true(contains(refusal(count, [](uint32_t i) { return 0.0 * i; }), "the given exposure times differ"));
    const std::string right =
        refusal(count, [](uint32_t i) { return true_ev(i % (2 * swing) < swing ? i % swing : swing - i % swing); });
    assert_false(contains(right, "exposure times"));
    assert_true(contains(right, "00302.png"));
}

int set_up(void **state) {
    if (make_folder(state) != 0) return 1;
    write_frames("moving", frames, 9.0, true);
    return 0;
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_folder),           cmocka_unit_test(test_video),
        cmocka_unit_test(test_scenes),           cmocka_unit_test(test_deflicker),
        cmocka_unit_test(test_refusals),         cmocka_unit_test(test_what_is_kept),
        cmocka_unit_test(test_deep_grey_frames), cmocka_unit_test(test_still_start),
        cmocka_unit_test(test_periodic_shake),   cmocka_unit_test(test_plain_frames),
        cmocka_unit_test(test_look_is_bounded),  cmocka_unit_test(test_wrong_times_are_named_early),
        cmocka_unit_test(test_known_response),   cmocka_unit_test(test_moves_after_a_title),
        cmocka_unit_test(test_wrong_lines),      cmocka_unit_test(test_few_lines),
        cmocka_unit_test(test_exposures_only),
    };
    return cmocka_run_group_tests(tests, set_up, remove_folder);
}
