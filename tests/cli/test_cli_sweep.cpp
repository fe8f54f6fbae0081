// lensprof bracket on exposure sweeps: a folder with times.txt, more pictures than are in memory together, pcalib.txt.
#include "bracket_runs.hpp"

using namespace bracket_runs;

namespace {

// Grey frames of 0.3 EV from dark to bright; the first are black, the last are white.
constexpr size_t frame_count = 44;
constexpr double darkest_ev = -6.0, step_ev = 0.3;

double sweep_ev(size_t i) { return darkest_ev + step_ev * double(i); }
std::string frame_name(size_t i) { return "f" + std::to_string(100 + i); }
double root(double light) { return std::sqrt(light); }

Shot grey_shot(double ev) {
    Shot shot;
    shot.ev = ev;
    shot.layout = LENSPROF_LAYOUT_GREY;
    shot.width = 120, shot.height = 90;
    shot.response = root;
    return shot;
}

// Line of a frame; without exposure if `is_known` is false.
std::string line_of(size_t i, bool is_known = true, double off_ev = 0.0) {
    const std::string time = " " + std::to_string(1.5e9 + 0.05 * double(i));
    return frame_name(i) + time + (is_known ? " " + std::to_string(std::exp2(sweep_ev(i) + off_ev)) : "") + "\n";
}

std::string all_lines() {
    std::string text = "# name time exposure\n\n";
    for (size_t i = 0; i < frame_count; ++i) text += line_of(i);
    return text;
}

// Writes a folder of the sweep; the light of frames 0 and 1 is too low, that of the last two beyond white.
std::string sweep(const std::string &name, const std::string &times, uint32_t sample = LENSPROF_SAMPLE_U8) {
    const std::string folder = work(name);
    fs::create_directories(folder + "/images");
    for (size_t i = 0; i < frame_count; ++i) {
        const bool is_black = i < 2, is_white = i + 2 >= frame_count;
        Shot shot = grey_shot(is_black ? -60.0 : is_white ? 60.0 : sweep_ev(i));
        shot.sample = sample;
        if (is_black) shot.noise = 0.0;
        save_shot(folder + "/images/" + frame_name(i) + ".png", shot);
    }
    save_text(folder + "/times.txt", times);
    return folder;
}

// Three frames for what is refused before any is compared.
std::string small_sweep(const std::string &times) {
    const std::string folder = work("small");
    fs::create_directories(folder);
    for (size_t i = 0; i < 3; ++i) save_shot(folder + "/" + frame_name(i) + ".png", grey_shot(2.0 - 2.0 * double(i)));
    save_text(folder + "/times.txt", times);
    return folder;
}

std::vector<double> values_of(const std::string &path) {
    std::istringstream text(text_of(path));
    std::vector<double> values;
    for (double value; text >> value;) values.push_back(value);
    return values;
}

// As DSO reads it, and as accurate as the response: from the first sample of a response's table, level 8, to 250.
void assert_calibration(const std::string &path) {
    const std::string text = text_of(path);
    assert_int_equal(std::count(text.begin(), text.end(), '\n'), 1);
    const std::vector<double> values = values_of(path);
    assert_int_equal(values.size(), 256);
    assert_true(values[0] == 0.0 && values[255] == 255.0);
    for (size_t i = 1; i < 256; ++i) assert_true(float(values[i]) > float(values[i - 1]));
    double best = 255.0;
    for (double scale = 0.8; scale < 1.25; scale *= 1.002) {
        double worst = 0.0;
        for (size_t i = 8; i <= 245; ++i)
            worst = std::max(worst, std::fabs(255.0 * root(values[i] / 255.0 * scale) - double(i)));
        best = std::min(best, worst);
    }
    if (best > 1.5) fail_msg("%s: the response is off by %.2f levels", path.c_str(), best);
}

const Words few_pairs = {"--fit", "pairs=12000"};

void test_a_sweep(void **) {
    const std::string folder = sweep("sweep", all_lines());
    const Words command = Words{"bracket", folder, "-o", work("out"), "--json"} + few_pairs;
    const Outcome outcome = run_words(command);
    if (outcome.code != done) fail_msg("exit code %d: %s", outcome.code, outcome.err.c_str());
    const Json json = parsed(outcome.out);
    assert_int_equal(json["images"].size(), frame_count);
    assert_true(json["profile"].is_null());  // the camera has no name
    assert_string_equal(json["gamma_from"].get<std::string>().c_str(), "exif");
    assert_rises(json);
    size_t used = 0;
    for (const Json &image : json["images"]) used += image["pairs"].get<int>() > 0;
    assert_true(used > frame_count - 12);
    assert_true(contains(outcome.err, "left out"));
    assert_true(outcome.err.find("left out") == outcome.err.rfind("left out"));
    assert_true(contains(outcome.err, "f100.png") && contains(outcome.err, "f143.png"));
    assert_true(contains(outcome.err, "vignette.png"));
    assert_calibration(work("out/pcalib.txt"));
    const Bytes first = load(work("out/pcalib.txt"));
    const Outcome again = run_words(command);
    assert_true(load(work("out/pcalib.txt")) == first && again.err == outcome.err);
}

void test_sixteen_bits(void **) {
    const std::string folder = sweep("sixteen", all_lines(), LENSPROF_SAMPLE_U16);
    must_exit(done, Words{"bracket", folder, "-o", work("out"), "--no-store"} + few_pairs);
    assert_calibration(work("out/pcalib.txt"));
}

// A third of the exposures is missing; each then has a free exposure.
void test_missing_exposures(void **) {
    std::string times;
    for (size_t i = 0; i < frame_count; ++i) times += line_of(i, i % 3 != 1);
    const std::string folder = sweep("sweep", times);
    const Json json = json_of(Words{"bracket", folder, "--no-store", "--json", "-o", work("out")} + few_pairs);
    assert_calibration(work("out/pcalib.txt"));
    for (size_t i = 10; i < 30; ++i)
        assert_close(found_ev(json, i) - found_ev(json, 10), sweep_ev(i) - sweep_ev(10), 0.06);
}

// Flicker within the stated error is nothing to report; one wrong exposure is.
void test_wrong_exposures(void **) {
    std::string flicker, wrong;
    for (size_t i = 0; i < frame_count; ++i) {
        flicker += line_of(i, true, i % 2 ? 0.04 : -0.04);
        wrong += line_of(i, true, i == 20 ? 2.0 : 0.0);
    }
    const std::string folder = sweep("sweep", flicker);
    const Words command = Words{"bracket", folder, "--no-store", "--json", "-o", work("out")} + few_pairs;
    const Json good = json_of(command);
    assert_string_equal(text_of(good).c_str(), "");
    assert_calibration(work("out/pcalib.txt"));
    save_text(folder + "/times.txt", wrong);
    const Json doubtful = json_of(command);
    assert_true(contains(text_of(doubtful), frame_name(20)));
    assert_calibration(work("out/pcalib.txt"));
}

void test_a_given_file(void **) {
    const std::string folder = small_sweep("");
    const Words files = {folder + "/f100.png", folder + "/f101.png"};
    const std::string times = work("exposures.csv");
    save_text(times, "images/f100.png 1 4\nf101 2 1 # comment\nf102.png 3 0.25\n");
    const Json json = json_of(bracket(files, no_store + Words{"--times", times}));
    assert_close(found_ev(json, 1), -2.0, 0.05);
    save_text(folder + "/times.txt", "f100 1 4e6\nf101 2 1e6\nf102 3 25e4\n");
    const Outcome outcome = run_words(Words{"bracket", folder} + no_store);
    assert_int_equal(outcome.code, done);
    assert_true(contains(outcome.err, "unusual for milliseconds"));
    assert_close(found_ev(parsed(outcome.out), 2), -4.0, 0.05);
}

void test_refused_times(void **) {
    const struct {
        const char *times;
        Words named;
    } cases[] = {
        {"f100 1 4\nf101 2 1\nf102 3 1\nf103 4 1\n", {"line 4", "f103"}},
        {"f100 1 4\nf102 3 1\n", {"f101.png", "add a line"}},
        {"f100 1 4\nf101 2 1\nf100 3 1\n", {"line 3", "line 1", "f100"}},
        {"f100 1 4\nf101 1 1\nf102 3 1\n", {"line 2", "time stamp", "line 1"}},
        {"f100 1 4\n# x\nf101 2 -1\nf102 3 1\n", {"line 3", "-1", "above 0"}},
        {"f100 1 0\nf101 2 1\nf102 3 1\n", {"line 1", "above 0"}},
        {"f100 1 4\nf101 2 1e-30\nf102 3 1\n", {"line 2", "1e-30", "no camera"}},
        {"f100 1 inf\nf101 2 1\nf102 3 1\n", {"line 1", "inf"}},
        {"f100 1 nan\nf101 2 1\nf102 3 1\n", {"line 1", "nan"}},
        {"f100 1 4ms\nf101 2 1\nf102 3 1\n", {"line 1", "4ms"}},
        {"f100 1 4 5\nf101 2 1\nf102 3 1\n", {"line 1", "4 words"}},
        {"f100\n", {"line 1", "1 word"}},
        {"# nothing\n", {"states no picture"}},
    };
    for (const auto &wrong : cases) {
        const std::string folder = small_sweep(wrong.times);
        Words named = wrong.named;
        named.push_back(folder + "/times.txt");
        assert_refused(unreadable, Words{"bracket", folder, "--no-store"}, named);
    }
}

void test_refused_folders(void **) {
    const std::string good = "f100 1 4\nf101 2 1\nf102 3 0.25\n", folder = small_sweep(good);
    save(folder + "/f102.png", [&] {
        Bytes cut = load(folder + "/f102.png");
        cut.resize(cut.size() / 2);
        return cut;
    }());
    assert_refused(unreadable, Words{"bracket", folder, "--no-store"}, {"f102.png"});
    Shot other = grey_shot(0.0);
    other.width = 100;
    save_shot(folder + "/f102.png", other);
    assert_refused(unreadable, Words{"bracket", folder, "--no-store"}, {"f102.png", "100 x 90"});
    for (size_t i = 1; i < 3; ++i) fs::remove(folder + "/" + frame_name(i) + ".png");
    save_text(folder + "/times.txt", "f100 1 4\n");
    assert_refused(usage, Words{"bracket", folder, "--no-store"}, {"at least two"});
    fs::remove(folder + "/f100.png");
    assert_refused(usage, Words{"bracket", folder, "--no-store"}, {folder});
    assert_refused(usage, Words{"bracket", scene("img000.png"), scene("img001.png"), "--times", work("none.txt")},
                   {"none.txt"});
}

// More pictures than are in memory together, none of which shows anything.
void test_black_frames_alone(void **) {
    Words files;
    for (size_t i = 0; i < 30; ++i) {
        files.push_back(shot_name(i));
        Shot black = grey_shot(-60.0);
        black.noise = 0.0;
        save_shot(files.back(), black);
    }
    assert_refused(not_usable, Words{"bracket", "--no-store"} + files, {"entirely black or white"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_a_sweep),         CLI_TEST(test_sixteen_bits),       CLI_TEST(test_missing_exposures),
        CLI_TEST(test_wrong_exposures), CLI_TEST(test_a_given_file),       CLI_TEST(test_refused_times),
        CLI_TEST(test_refused_folders), CLI_TEST(test_black_frames_alone),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
