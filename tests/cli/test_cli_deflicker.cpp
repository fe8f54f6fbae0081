// `lensprof deflicker`: rendered timelapses whose copies must be level, settings for raw converters, and refused input.
#include "cli_runs.hpp"
#include "photo/deflicker/frames.hpp"
#include "photo/deflicker/offsets.hpp"

using namespace cli_runs;

namespace {

constexpr uint32_t frame_width = 120, frame_height = 80;

double encoded(double x) {
    x = std::min(std::max(x, 0.0), 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

double irradiance(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

double texture(double x, double y) {
    return 0.16 * std::exp(0.5 * std::sin(x / 6.0 + y / 17.0) + 0.5 * std::cos(y / 5.0 - x / 29.0));
}

std::string name_of(const std::string &folder, size_t i, const char *extension = ".png") {
    return work(folder + "/f" + std::to_string(i) + extension);
}

void write_frame(const std::string &file, double ev, double shift = 0.0, uint32_t sample = LENSPROF_SAMPLE_U8) {
    Picture frame = make_noise(frame_width, frame_height, sample, LENSPROF_LAYOUT_RGB);
    for (uint32_t y = 0; y < frame_height; y++)
        for (uint32_t x = 0; x < frame_width; x++)
            for (uint32_t c = 0; c < 3; c++) {
                const double value = encoded(texture(x - shift, y) * std::exp2(ev)),
                             noise = (x * 7 + y * 13 + c) % 5 / 5.0;
                uint8_t *const row = frame.pixels.data() + y * frame.row_bytes;
                if (sample == LENSPROF_SAMPLE_U8)
                    row[3 * x + c] = static_cast<uint8_t>(std::min(255.0 * value + noise, 255.0));
                else
                    reinterpret_cast<uint16_t *>(row)[3 * x + c] = static_cast<uint16_t>(65535.0 * value);
            }
    write_picture(file, frame);
}

double flicker_ev(size_t i) { return 0.15 * std::sin(2.3 * double(i)) + 0.05 * std::cos(5.1 * double(i)); }

// Names of the frames of a folder made for this test, of a camera that is at `place`(frame), px.
template <class Place>
Words make_frames_at(const std::string &folder, size_t count, const Place &place, const char *extension = ".png") {
    fs::create_directories(work(folder));
    Words files;
    for (size_t i = 0; i < count; i++) {
        files.push_back(name_of(folder, i, extension));
        write_frame(files.back(), flicker_ev(i), place(double(i)));
    }
    return files;
}

Words make_frames(const std::string &folder, size_t count, double shift = 0.0, const char *extension = ".png") {
    return make_frames_at(
        folder, count, [&](double i) { return shift * i; }, extension);
}

double mean_ev(const std::string &file) {
    const Picture picture = read_picture(file);
    double sum = 0.0;
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t n = 0; n < picture.width * 3; n++)
            sum += irradiance(sample_value(picture.sample, picture.pixels.data() + y * picture.row_bytes, n));
    return std::log2(sum);
}

void test_copies_are_level(void **) {
    const Words files = make_frames("flicker", 16);
    const Json json = json_of(
        {"deflicker", work("flicker"), "-o", work("level"), "--to", "mean", "--json", "--chart", work("c.svg")});
    assert_true(json["largest_step_ev"]["before"].get<double>() > 0.1);
    assert_true(json["largest_step_ev"]["after"].get<double>() < 0.01);
    double before = mean_ev(name_of("level", 0));
    for (size_t i = 0; i < files.size(); i++) {
        const double after = mean_ev(name_of("level", i));
        assert_close(after, before, 0.01);
        assert_close(json["frames"][i]["ev"].get<double>(), flicker_ev(i) - flicker_ev(0), 0.006);
        before = after;
    }
    assert_true(contains(std::string(reinterpret_cast<const char *>(load(work("c.svg")).data()), 200), "<svg"));
}

// Natural order, not that of the characters: f9 before f10.
void test_order(void **) {
    assert_true(lensprof::comes_before("f9.jpg", "f10.jpg"));
    assert_false(lensprof::comes_before("f10.jpg", "f9.jpg"));
    assert_true(lensprof::comes_before("a1b2", "a1b10"));
    assert_true(lensprof::comes_before("a01", "a2"));
    assert_true(lensprof::comes_before("IMG_1", "IMG_1a"));
    make_frames("order", 12);
    const Json json = json_of({"deflicker", work("order"), "--write", "csv", "-o", work("order-out"), "--json"});
    assert_string_equal(fs::path(json["frames"][11]["file"].get<std::string>()).filename().c_str(), "f11.png");
}

// A second run writes only what is missing, and the same bytes whatever the number of threads.
void test_continues_and_is_deterministic(void **) {
    make_frames("again", 8);
    const Words words = {"deflicker", work("again"), "-o", work("again-out")};
    must_exit(done, words + Words{"--threads", "1"});
    const Bytes first = load(name_of("again-out", 3));
    fs::remove(name_of("again-out", 5));
    const Outcome second = run_words(words + Words{"--threads", "3"});
    assert_int_equal(second.code, done);
    assert_true(contains(second.err, "7 copies of an earlier run kept"));
    assert_true(fs::exists(name_of("again-out", 5)));
    must_exit(done, words + Words{"--threads", "4", "--overwrite"});
    assert_true(load(name_of("again-out", 3)) == first);
    must_exit(done, words + Words{"--to", "first"});  // another target replaces them
    assert_close(mean_ev(name_of("again-out", 3)), mean_ev(name_of("again", 0)), 0.006);
}

void test_targets(void **) {
    make_frames("to", 6);
    const Words words = {"deflicker", work("to"), "-o", work("to-out"), "--json", "--overwrite"};
    for (const char *to : {"mean", "first", "f4.png", "smooth"}) json_of(words + Words{"--to", to});
    std::ofstream(work("curve.csv"))
        << "file,ev\nf5.png,0.5\nf4.png,0.4\nf3.png,0.3\nf2.png,0.2\nf1.png,0.1\nf0.png,0\n";
    const Json json = json_of(words + Words{"--to", work("curve.csv")});
    for (size_t i = 0; i < 6; i++) assert_close(json["frames"][i]["wanted_ev"].get<double>(), 0.1 * double(i), 1e-9);
    assert_close(mean_ev(name_of("to-out", 5)) - mean_ev(name_of("to-out", 0)), 0.5, 0.01);
}

void test_sixteen_bits_stay(void **) {
    fs::create_directories(work("deep"));
    for (size_t i = 0; i < 4; i++) write_frame(name_of("deep", i, ".tif"), flicker_ev(i), 0.0, LENSPROF_SAMPLE_U16);
    must_exit(done, {"deflicker", work("deep"), "-o", work("deep-out"), "--to", "mean"});
    const Picture picture = read_picture(name_of("deep-out", 2, ".tif"));
    assert_int_equal(picture.sample, LENSPROF_SAMPLE_U16);
    assert_close(mean_ev(name_of("deep-out", 2, ".tif")), mean_ev(name_of("deep-out", 1, ".tif")), 0.003);
}

// Offsets go below what the user has set, and a second run replaces only its own.
void test_settings_of_converters(void **) {
    const std::string own = xmp_with_offset("", 0.25, "a.xmp");
    assert_true(contains(own, "Exposure2012=\"+0.2500\""));
    assert_true(contains(xmp_with_offset(own, -0.5, "a.xmp"), "Exposure2012=\"-0.5000\""));
    const std::string user =
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"
        "<rdf:Description rdf:about=\"\" xmlns:crs=\"http://ns.adobe.com/camera-raw-settings/1.0/\" "
        "crs:Exposure2012=\"+1.00\" crs:Contrast2012=\"7\"/></rdf:RDF></x:xmpmeta>";
    const std::string once = xmp_with_offset(user, 0.25, "a.xmp");
    assert_true(contains(once, "Exposure2012=\"+1.2500\"") && contains(once, "Contrast2012=\"7\""));
    assert_true(contains(xmp_with_offset(once, 0.125, "a.xmp"), "Exposure2012=\"+1.1250\""));
    assert_failure(LENSPROF_ERROR_READ, "not an XMP file", [] { xmp_with_offset("GIF89a", 0.1, "a.xmp"); });
    const std::string pp3 =
        pp3_with_offset("[Version]\nVersion=346\n\n[Exposure]\nAuto=false\nCompensation=0.5\n", 0.25, "a.pp3");
    assert_true(contains(pp3, "Compensation=0.7500") && contains(pp3, "Auto=false") && contains(pp3, "Version=346"));
    assert_true(contains(pp3_with_offset(pp3, 0.0, "a.pp3"), "Compensation=0.5000"));
    assert_true(contains(pp3_with_offset("", -0.125, "a.pp3"), "[Exposure]\nCompensation=-0.1250"));
    make_frames("raw", 4);
    must_exit(done, {"deflicker", work("raw"), "--write", "xmp,pp3,csv", "-o", work("raw-out"), "--to", "first"});
    const Bytes file = load(work("raw-out/f2.xmp"));
    const std::string text(file.begin(), file.end());
    const double wanted = flicker_ev(0) - flicker_ev(2);
    const size_t at = text.find("Exposure2012=\"") + 14;
    assert_close(std::stod(text.substr(at)), wanted, 0.006);
    assert_true(fs::exists(work("raw-out/f3.png.pp3")) && fs::exists(work("raw-out/exposures.csv")));
    assert_false(fs::exists(work("raw-out/f2.png")));
}

void test_frames_left_out(void **) {
    make_frames("odd", 9);
    Bytes cut = load(name_of("odd", 4));
    cut.resize(cut.size() / 2);
    save(name_of("odd", 4), cut);
    Picture small = make_noise(40, 30, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    write_picture(name_of("odd", 6), small);
    Picture black = make_noise(frame_width, frame_height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB);
    std::fill(black.pixels.begin(), black.pixels.end(), uint8_t(0));
    write_picture(name_of("odd", 0), black);
    const Outcome outcome = run_words({"deflicker", work("odd"), "-o", work("odd-out")});
    assert_int_equal(outcome.code, unreadable);
    assert_true(contains(outcome.err, "f4.png") && contains(outcome.err, "40 x 30 pixels"));
    assert_true(contains(outcome.err, "too dark to be measured: f0.png"));
    assert_true(fs::exists(name_of("odd-out", 0)) && fs::exists(name_of("odd-out", 8)));
    assert_false(fs::exists(name_of("odd-out", 4)) || fs::exists(name_of("odd-out", 6)));
}

// A damaged frame, wherever it is, is left out and named; the verdict on the camera is that of the others.
void test_damaged_jpeg(void **) {
    const auto check = [](size_t count, size_t damaged, double shift) {
        const std::string name = "cut" + std::to_string(count) + "-" + std::to_string(damaged);
        make_frames(name, count, shift, ".jpg");
        Bytes cut = load(name_of(name, damaged, ".jpg"));
        cut.resize(cut.size() / 2);
        save(name_of(name, damaged, ".jpg"), cut);
        const Outcome outcome = run_words({"deflicker", work(name), "-o", work(name + "-out")});
        assert_int_equal(outcome.code, unreadable);
        assert_true(contains(outcome.err, "f" + std::to_string(damaged) + ".jpg: ")
                    && contains(outcome.err, "; left out"));
        assert_int_equal(contains(outcome.err, "the camera moves by 0."), shift > 0.0);
        for (size_t i = 0; i < count; i++)
            assert_int_equal(fs::exists(name_of(name + "-out", i, ".jpg")), i != damaged);
    };
    check(12, 5, 0.0);
    check(12, 11, 0.8);
    check(24, 5, 0.8);
    check(24, 0, 0.0);
    check(25, 24, 0.8);
}

// A camera that walks is named, also where it could be followed; a tripod that is bumped or in the wind is not, nor a
// slider.
void test_walking_camera(void **) {
    const auto message_of = [](const std::string &folder, double (*place)(double)) {
        make_frames_at(folder, 26, place);
        const Outcome outcome = run_words({"deflicker", work(folder), "-o", work(folder + "-out"), "--write", "csv"});
        assert_int_equal(outcome.code, done);
        return outcome.err;
    };
    for (const std::string &named : {message_of("hand", [](double i) { return 0.35 * i + 0.5 * std::sin(1.7 * i); }),
                                     message_of("pan", [](double i) { return 0.8 * i; })}) {
        assert_true(contains(named, "f0.png: the camera moves by 0."));
        assert_true(contains(named, "those of `lensprof calibrate FOLDER --moving`"));
    }
    for (const std::string &quiet : {message_of("slider", [](double i) { return 0.35 * i; }),
                                     message_of("bump", [](double i) { return i > 9.0 ? 12.0 : 0.0; }),
                                     message_of("wind", [](double i) { return 0.7 * std::sin(2.3 * i); })})
        assert_false(contains(quiet, "the camera moves"));
}

void test_refusals(void **) {
    const Words files = make_frames("bad", 3), moving = make_frames("moving", 14, 5.0);
    const Words to = {"-o", work("bad-out")};
    assert_refused(usage, {"deflicker"}, {"at least two frames"});
    assert_refused(unreadable, Words{"deflicker", files[0], work("missing.png")} + to, {"missing.png"});
    assert_refused(not_usable, Words{"deflicker", files[0]} + to, {"single frame"});
    assert_refused(usage, Words{"deflicker", files[0], files[0]} + to, {"given twice"});
    assert_refused(not_usable, Words{"deflicker", work("moving")} + to, {"not stationary", "lensprof calibrate"});
    assert_refused(usage, Words{"deflicker", work("bad"), "--to", "f9.png"} + to, {"f9.png"});
    assert_refused(usage, Words{"deflicker", work("bad"), "--keep-light"} + to, {"EXIF", "--to smooth"});
    assert_refused(usage, Words{"deflicker", work("bad"), "--keep-light", "--to", "mean"} + to, {"exclude"});
    assert_refused(usage, Words{"deflicker", work("bad"), "--region", "1,2,3"} + to, {"--region"});
    assert_refused(usage, Words{"deflicker", work("bad"), "--region", "500,0,9,9"} + to, {"--region", "120 x 80"});
    assert_refused(usage, Words{"deflicker", work("bad"), "--chart", work("c.gif")} + to, {"c.gif"});
    assert_refused(usage, {"deflicker", work("bad"), "-o", work("bad")}, {"would be overwritten"});
    std::ofstream(work("few.csv")) << "0.1\n0.2\n";
    std::ofstream(work("words.csv")) << "ev\nbright\n";
    const Words few = {"deflicker", work("bad"), "--to", work("few.csv")};
    assert_refused(unreadable, few + to, {"few.csv", "2 values", "3 frames"});
    assert_refused(unreadable, Words{"deflicker", work("bad"), "--to", work("words.csv")} + to, {"line 2"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_copies_are_level),
        CLI_TEST(test_order),
        CLI_TEST(test_continues_and_is_deterministic),
        CLI_TEST(test_targets),
        CLI_TEST(test_sixteen_bits_stay),
        CLI_TEST(test_settings_of_converters),
        CLI_TEST(test_frames_left_out),
        CLI_TEST(test_damaged_jpeg),
        CLI_TEST(test_walking_camera),
        CLI_TEST(test_refusals),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
