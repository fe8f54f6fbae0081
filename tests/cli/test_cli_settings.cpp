// Pictures at several lens settings: a falloff and a profile for each.
#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "cli_runs.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/rotated_profile.hpp"

namespace {

using namespace cli_runs;

constexpr double kOpen = 2.8, kStopped = 8.0, kHfovDeg = 50.0;
const std::vector<double> kOpenFalloff{-0.55, 0.15, -0.12}, kStoppedFalloff{-0.12, 0.02, -0.03};
const Words quietly{"--no-store", "--fit", "stored=none", "--json"};
const Words six{"--images", "6", "--size", "400x300", "--seed", "5", "--exif", "--set", "noise=1"};

std::string numbered(size_t i) { return "img00" + std::to_string(i) + ".png"; }

// The exposure is unchanged: a smaller aperture has a longer time.
void state_aperture(const std::string &file, double f_number) {
    PictureMetadata metadata = read_metadata(file);
    metadata.exposure_time_s = *metadata.exposure_time_s * std::pow(f_number / *metadata.f_number, 2);
    metadata.key.aperture = metadata.f_number.emplace(f_number);
    assert_true(write_metadata(file, metadata));
}

// Pictures of one scene, alternating between two apertures.
std::string two_apertures(const char *overlap = "0.4") {
    const Words same = six + Words{"--set", std::string("overlap=") + overlap};
    render("open", Words{"--vignetting=-0.55,0.15,-0.12"} + same);
    render("stopped", Words{"--vignetting=-0.12,0.02,-0.03"} + same);
    for (size_t i = 1; i < 6; i += 2) {
        fs::copy_file(work("stopped/" + numbered(i)), work("open/" + numbered(i)),
                      fs::copy_options::overwrite_existing);
        state_aperture(work("open/" + numbered(i)), kStopped);
    }
    return work("open/pano.pto");
}

void assert_both_found(const Json &json) {
    assert_true(json["usable"] == true && json["equalizes"] == true);
    assert_int_equal(json["settings"].size(), 2);
    for (size_t n = 0; n < 2; n++) {
        const Json &setting = json["settings"][n];
        assert_true(setting["usable"] == true);
        assert_int_equal(setting["images"], 3);
        assert_close(setting["key"]["aperture"].get<double>(), n ? kStopped : kOpen, 1e-6);
        assert_true(setting["reference"] == (n == 0));
        const double error = falloff_error(setting["vignetting"]["k"][0], n ? kStoppedFalloff : kOpenFalloff);
        print_message("%s: falloff within %.4f\n", setting["label"].get<std::string>().c_str(), error);
        assert_true(error < 0.01);
    }
    for (size_t i = 0; i < 6; i++) assert_int_equal(json["images"][i]["setting"], i % 2);
    assert_true(json["settings"][0]["vignetting"] == json["vignetting"]);
}

void test_two_apertures(void **) {
    const std::string pto = two_apertures();
    assert_both_found(json_of(Words{"build", pto} + quietly));
    assert_both_found(json_of(Words{"build", pto, "--fit", "method=radiance"} + quietly));
    const std::string text = must_exit(done, {"build", pto, "--no-store"});
    assert_true(contains(text, "f/2.8, 3 pictures\n") && contains(text, "f/8, 3 pictures\n"));
}

void test_one_lens(void **) {
    const std::string pto = two_apertures();
    const Json each = json_of(Words{"build", pto} + quietly);
    const Outcome one = run_words(Words{"build", pto, "--one-lens"} + quietly);
    const Json json = parsed(one.out);
    assert_true(json["settings"].empty() && !json["images"][0].contains("setting"));
    assert_true(contains(one.err, "img001.png: lens, focal length, aperture or focus differ from"));
    assert_true(json["residual"]["heldout_median"].get<double>()
                > 2.0 * each["residual"]["heldout_median"].get<double>());
    // Values on the command line hold for all pictures.
    assert_true(json_of(Words{"build", pto, "--aperture", "4"} + quietly, one.code)["settings"].empty());
    // A method that fits one falloff only.
    const Outcome other = run_words(Words{"build", pto, "--fit", "method=transfer-function"} + quietly);
    assert_true(contains(other.err, "2 lens settings"));
    assert_true(parsed(other.out)["settings"].empty());
}

// A profile for each, under its own aperture, so that lookups find it.
void test_profiles(void **) {
    const std::string pto = two_apertures(), db = work("p.db");
    const Json json = json_of({"build", pto, "--db", db, "--json"});
    assert_int_equal(json["settings"][0]["profile"], 1);
    assert_int_equal(json["settings"][1]["profile"], 2);
    assert_int_equal(json["profile"], 1);
    for (size_t n = 0; n < 2; n++) {
        const Json stored = json_of({"profile", "show", std::to_string(n + 1), "--db", db, "--json"});
        assert_close(stored["key"]["aperture"].get<double>(), n ? kStopped : kOpen, 1e-6);
        assert_true(stored["vignetting"]["k"][0] == json["settings"][n]["vignetting"]["k"][0]);
        assert_int_equal(stored["provenance"]["images"], 3);
    }
}

// The resulting project has both falloffs, and apply uses the right one for each picture.
void test_project_with_both(void **) {
    const std::string pto = two_apertures(), out = work("open/result.pto");
    const Json json = json_of(Words{"build", pto, "--write", std::string("pto=") + out} + quietly);
    const std::string text = text_of(out);
    for (const char *part : {" Vb=0 Vc=0 Vd=0", " Vb=1 Vc=1 Vd=1"}) {
        size_t count = 0;
        for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) count++;
        assert_int_equal(count, 2);
    }
    // A picture without falloff, from the same scene.
    render("none", Words{"--vignetting=0,0,0", "--set", "overlap=0.4"} + six);
    must_exit(done, {"apply", "--pto", out, "--set", "exposure=keep", "-o", work("even")});
    for (size_t i = 0; i < 2; i++) {
        const Picture even = read_picture(work("even/" + numbered(i))),
                      truth = read_picture(work("none/" + numbered(i)));
        double square = 0.0, count = 0.0;
        for (size_t n = 0; n < even.pixels.size(); n++)
            if (truth.pixels[n] < 240) square += std::pow(even.pixels[n] - truth.pixels[n], 2), count++;
        const double rms = std::sqrt(square / count);
        print_message("%s: %.2f levels from the picture without falloff\n", numbered(i).c_str(), rms);
        assert_true(rms < 3.0);
    }
    // Read again, both are estimated again.
    assert_both_found(json_of(Words{"build", out, "--fit", "free=all"} + quietly));
}

// A picture without an aperture joins neither of the two settings, at any position, and does not connect them.
void test_an_aperture_that_is_not_known(void **) {
    for (size_t unknown : {0, 5}) {
        empty_work(nullptr);
        const std::string pto = two_apertures(), file = work("open/" + numbered(unknown));
        assert_true(write_picture(file, read_picture(file)));  // without EXIF
        const Json json = json_of(Words{"build", pto} + quietly);
        assert_int_equal(json["settings"].size(), 3);
        for (size_t i = 0; i < 6; i++) {
            if (i == unknown) continue;
            const Json &setting = json["settings"][json["images"][i]["setting"].get<size_t>()];
            assert_close(setting["key"]["aperture"].get<double>(), i % 2 ? kStopped : kOpen, 1e-6);
            assert_true(falloff_error(setting["vignetting"]["k"][0], i % 2 ? kStoppedFalloff : kOpenFalloff) < 0.02);
        }
    }
}

// Turns a picture as a program does, so that EXIF orientation `turn` (6 or 8) turns it back, with its line in the
// project; that orientation is written only if `is_stated`.
void turn_picture(const std::string &pto, size_t number, uint16_t turn, bool is_stated) {
    const std::string file = work("open/" + numbered(number));
    const PictureMetadata metadata = read_metadata(file);
    const Picture from = read_picture(file);
    Picture to = from;
    std::swap(to.width, to.height), std::swap(to.frame_width, to.frame_height);
    const size_t bytes = from.row_bytes / from.width;
    to.row_bytes = bytes * to.width;
    for (uint32_t y = 0; y < to.height; y++)
        for (uint32_t x = 0; x < to.width; x++) {
            const uint32_t u = turn == 6 ? to.height - 1 - y : y, v = turn == 6 ? x : to.width - 1 - x;
            std::memcpy(&to.pixels[y * to.row_bytes + bytes * x], &from.pixels[v * from.row_bytes + bytes * u], bytes);
        }
    write_picture(file, to);
    auto image = Exiv2::ImageFactory::open(file);
    image->readMetadata();
    if (is_stated) image->exifData()["Exif.Image.Orientation"] = turn;
    image->writeMetadata();
    assert_true(write_metadata(file, metadata));
    std::string text = text_of(pto), line, changed;
    std::istringstream lines(text);
    while (std::getline(lines, line)) {
        if (line[0] == 'i' && contains(line, "n\"" + numbered(number))) {
            const double degree = std::acos(-1.0) / 180.0, ratio = double(from.height) / from.width;
            std::istringstream words(line);
            line.clear();
            for (std::string word; words >> word;) {
                if (word[0] == 'w') word = "w" + std::to_string(to.width);
                if (word[0] == 'h') word = "h" + std::to_string(to.height);
                if (word[0] == 'v')
                    word = "v" + std::to_string(2 / degree * std::atan(ratio * std::tan(kHfovDeg / 2 * degree)));
                if (word[0] == 'r') word = "r" + std::to_string(std::stod(word.substr(1)) + (turn == 6 ? 90 : -90));
                line += word + " ";
            }
        }
        changed += line + "\n";
    }
    save_text(pto, changed);
}

// Six pictures whose falloff has its centre far from the middle.
std::string off_centre() {
    render("open", Words{"--vignetting=-0.55,0.15,-0.12", "--set=center=0.1,-0.06", "--set", "overlap=0.5"} + six);
    return work("open/pano.pto");
}

double centre_error(const Json &centre, double x, double y) {
    return std::hypot(centre[0].get<double>() - x, centre[1].get<double>() - y);
}

// Frames that a program has rotated share the falloff of the others, whose centre turns with them.
void test_turned_frames(void **) {
    const std::string pto = off_centre(), out = work("open/result.pto");
    for (const size_t i : {1, 3, 4}) turn_picture(pto, i, i == 3 ? 8 : 6, true);
    const Json json = json_of(Words{"build", pto, "--write", std::string("pto=") + out} + quietly);
    assert_true(json["settings"].empty() && json["usable"] == true);
    assert_true(falloff_error(json["vignetting"]["k"][0], kOpenFalloff) < 0.01);
    assert_true(centre_error(json["vignetting"]["center"], 0.1, -0.06) < 0.01);
    // Read again, each picture has the falloff as it is in its own frame.
    render("none", Words{"--vignetting=0,0,0", "--set", "overlap=0.5"} + six);
    must_exit(done, {"apply", "--pto", out, "--set", "exposure=keep", "-o", work("even")});
    for (const size_t i : {0, 1, 3}) {
        const Picture even = read_picture(work("even/" + numbered(i))),
                      truth = read_picture(work("none/" + numbered(i)));
        const uint16_t turn = i == 0 ? 1 : i == 3 ? 8 : 6;
        const size_t bytes = truth.row_bytes / truth.width;
        double square = 0.0, count = 0.0;
        for (uint32_t y = 0; y < even.height; y++)
            for (uint32_t x = 0; x < even.width; x++) {
                const uint32_t u = turn == 1   ? x
                                   : turn == 6 ? even.height - 1 - y
                                               : y,
                               v = turn == 1   ? y
                                   : turn == 6 ? x
                                               : even.width - 1 - x;
                const uint8_t *a = &even.pixels[y * even.row_bytes + bytes * x],
                              *b = &truth.pixels[v * truth.row_bytes + bytes * u];
                if (*b < 240) square += std::pow(*a - *b, 2), count++;
            }
        const double rms = std::sqrt(square / count);
        print_message("%s: %.2f levels from the picture without falloff\n", numbered(i).c_str(), rms);
        assert_true(rms < 3.0);
    }
}

// Centre, grid and image circle of a profile for a picture that orientation 6 or 8 turns back, or that may have been
// rotated either way.
void test_turned_profile(void **) {
    const struct {
        uint16_t turn;
        double x, y;
        std::vector<float> nodes;
    } turns[] = {{1, 0.1, -0.06, {1, 2, 3, 4, 5, 6}},
                 {6, -0.06, -0.1, {3, 6, 2, 5, 1, 4}},
                 {8, 0.06, 0.1, {4, 1, 5, 2, 6, 3}},
                 {0, 0.0, 0.0, {3.5, 3.5, 3.5, 3.5, 3.5, 3.5}}};
    for (const auto &expected : turns) {
        lensprof_profile profile;
        lensprof_profile_init(&profile);
        profile.vignetting[0].center[0] = 0.1, profile.vignetting[0].center[1] = -0.06;
        profile.grid.columns = 3, profile.grid.rows = 2, profile.grid.channels = 1;
        for (int n = 0; n < 6; n++) profile.grid.attenuation[n] = static_cast<float>(n + 1);
        profile.image_circle = {{0.1, -0.06}, 0.8};
        turn_profile(expected.turn, profile);
        assert_close(profile.vignetting[0].center[0], expected.x, 1e-12);
        assert_close(profile.vignetting[0].center[1], expected.y, 1e-12);
        assert_close(profile.image_circle.center[0], expected.x, 1e-12);
        assert_close(profile.image_circle.center[1], expected.y, 1e-12);
        assert_close(profile.image_circle.radius, expected.turn ? 0.8 : 0.8 - std::hypot(0.1, 0.06), 1e-12);
        assert_int_equal(profile.grid.columns, expected.turn == 1 ? 3 : 2);
        for (size_t n = 0; n < 6; n++) assert_close(profile.grid.attenuation[n], expected.nodes[n], 0);
    }
}

// Frames whose turn is not stated share the falloff around the middle.
void test_frames_turned_either_way(void **) {
    render("open", Words{"--vignetting=-0.55,0.15,-0.12", "--set=center=0,0", "--set", "overlap=0.5"} + six);
    const std::string pto = work("open/pano.pto");
    for (const size_t i : {1, 3, 4}) turn_picture(pto, i, i == 3 ? 8 : 6, false);
    const Outcome run = run_words(Words{"build", pto} + quietly);
    const Json json = parsed(run.out);
    assert_int_equal(run.code, done);
    assert_true(contains(run.err, "which way the portrait pictures were rotated"));
    assert_true(json["settings"].empty());
    assert_true(centre_error(json["vignetting"]["center"], 0.0, 0.0) == 0.0);
    assert_true(falloff_error(json["vignetting"]["k"][0], kOpenFalloff) < 0.01);
}

// Settings from the project's links alone, without EXIF.
void test_links_of_a_project(void **) {
    const std::string copy = copy_of("scene");
    edit(copy + "/pano.pto", "Vb=0 Vc=0 Vd=0( .*img002)", "Vb0 Vc0 Vd0$1");
    const Json json = json_of(Words{"build", copy + "/pano.pto", "--no-store", "--json"} + quick);
    assert_int_equal(json["settings"].size(), 2);
    assert_int_equal(json["images"][2]["setting"], 1);
    assert_true(contains(json["settings"][1]["label"], "f/2.8, from img002.png"));
}

// A setting that its pictures do not determine is named and not stored; the other one is.
void test_a_setting_that_is_not_shown(void **) {
    const std::string pto = two_apertures("0.75"), db = work("one.db");
    // Only the middle of the stopped down pictures remains.
    std::string text = text_of(pto);
    for (size_t i = 1; i < 6; i += 2) {
        const size_t name = text.find("n\"" + numbered(i));
        text.insert(name, "S100,220,75,165 ");
    }
    save_text(pto, text);
    const Outcome run = run_words({"build", pto, "--db", db, "--json"});
    const Json json = parsed(run.out);
    assert_int_equal(run.code, done);
    assert_true(json["settings"][0]["usable"] == true && json["settings"][0]["profile"] == 1);
    assert_true(json["settings"][1]["usable"] == false);
    assert_true(json["settings"][1]["profile"].is_null());
    assert_true(contains(run.err, "f/8: not stored as a profile"));
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        CLI_TEST(test_an_aperture_that_is_not_known),
        CLI_TEST(test_two_apertures),
        CLI_TEST(test_one_lens),
        CLI_TEST(test_profiles),
        CLI_TEST(test_project_with_both),
        CLI_TEST(test_turned_frames),
        CLI_TEST(test_turned_profile),
        CLI_TEST(test_frames_turned_either_way),
        CLI_TEST(test_links_of_a_project),
        CLI_TEST(test_a_setting_that_is_not_shown),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
