// `build` of pictures and folders without a project.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>

#include "photo/pictures/picture.hpp"
#include "photo/registration/registration.hpp"

#include "cli_runs.hpp"
#include "picture_files.hpp"

using namespace cli_runs;

namespace {

void simulate(const std::string &name, const Words &more) {
    const bool is_sized = std::find(more.begin(), more.end(), "--size") != more.end();
    render(name, Words{"--set", "noise=1"} + (is_sized ? Words() : Words{"--size", "480x360"}) + more);
}

// If the program was built without OpenCV, only its message can be tested.
bool is_missing() {
    if (can_register()) return false;
    simulate("none", {"--images", "2"});
    const Outcome refused = run_words({"build", work("none"), "--no-store"});
    assert_int_equal(refused.code, usage);
    assert_true(contains(refused.err, "built without OpenCV"));
    return true;
}

double corner_of(const Json &json) {
    const Json &k = json["vignetting"]["k"][0];
    return 1.0 + k[0].get<double>() + k[1].get<double>() + k[2].get<double>();
}

const Words quietly{"--no-store", "--fit", "stored=none", "--json"};

void assert_alike(const Json &one, const Json &other) {
    assert_true(one["usable"] == true && other["usable"] == true);
    assert_close(corner_of(one), corner_of(other), 0.02);
    assert_int_equal(one["images"].size(), other["images"].size());
    for (size_t i = 0; i < one["images"].size(); i++)
        assert_close(one["images"][i]["ev"].get<double>(), other["images"][i]["ev"].get<double>(), 0.03);
}

// The same result as with the true project; the project that was found gives it again.
void test_a_folder_is_as_good_as_its_project(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "6", "--seed", "11"});
    const std::string pto = work("row/pano.pto"), found = work("found.pto");
    const Json given = json_of(Words{"build", pto} + quietly);
    const Outcome run = run_words(Words{"build", work("row"), "--write", std::string("project=") + found} + quietly);
    assert_int_equal(run.code, done);
    assert_true(contains(run.err, "6 pictures overlap"));
    const Json own = parsed(run.out);
    assert_true(own["images"][0]["file"] == "img000.png");
    assert_alike(given, own);
    assert_alike(own, json_of(Words{"build", found} + quietly));
    assert_true(contains(text_of(found), "n\"row/img003.png\""));
    assert_true(contains(text_of(found), "\nc n0 N1 "));
    // A repeated run gives the same, and so do files instead of the folder.
    const Json again = json_of(Words{"build", work("row")} + quietly);
    assert_true(again["vignetting"] == own["vignetting"]);
    Words files{"build"};
    for (const char *name : {"img000.png", "img001.png", "img002.png", "img003.png", "img004.png", "img005.png"})
        files = files + Words{work(std::string("row/") + name)};
    assert_true(json_of(files + quietly)["vignetting"] == own["vignetting"]);
}

// Pictures that look different: exposures 4 EV apart, white balances, a strong falloff.
void test_pictures_that_look_unlike(void **) {
    if (is_missing()) return;
    simulate("unlike", {"--images", "5", "--set", "ev=4,wb=0.3", "--vignetting=-0.8,0.5,-0.3", "--seed", "5"});
    const Json json = json_of(Words{"build", work("unlike")} + quietly);
    assert_true(json["usable"] == true);
    for (const Json &image : json["images"]) assert_true(image["joined"] == true);
}

// Two panoramas, an unrelated picture, a damaged one, a copy, and one of another size.
void test_a_folder_of_many_things(void **) {
    if (is_missing()) return;
    simulate("mixed", {"--images", "5", "--seed", "21"});
    simulate("other", {"--images", "3", "--seed", "22"});
    simulate("single", {"--images", "2", "--seed", "23"});
    simulate("small", {"--images", "4", "--seed", "21", "--size", "400x300"});
    for (int i = 0; i < 3; i++)
        fs::copy_file(work("other/img00" + std::to_string(i) + ".png"), work("mixed/x" + std::to_string(i) + ".png"));
    fs::copy_file(work("single/img000.png"), work("mixed/y.png"));
    fs::copy_file(work("mixed/img001.png"), work("mixed/copy.png"));
    fs::copy_file(work("small/img002.png"), work("mixed/small.png"));
    save_text(work("mixed/damaged.png"), text_of(work("mixed/img002.png")).substr(0, 5000));
    const Outcome run = run_words(Words{"build", work("mixed")} + quietly);
    assert_int_equal(run.code, done);
    const Json json = parsed(run.out);
    assert_int_equal(json["images"].size(), 5);
    assert_true(contains(run.err, "x0.png, x1.png, x2.png: left out: part of another group"));
    assert_true(contains(run.err, "y.png: left out: no overlap"));
    assert_true(contains(run.err, "damaged.png"));
    assert_true(contains(run.err, "a copy of copy.png"));
    assert_true(contains(run.err, "small.png: left out: no two pictures of its camera, size or processing overlap"));
    std::map<std::string, std::string> left_out;
    for (const Json &one : json["left_out"]) left_out[one["file"]] = one["reason"];
    assert_int_equal(left_out.size(), 7);
    assert_true(contains(left_out["x1.png"], "another group") && contains(left_out["y.png"], "no overlap"));
    assert_true(contains(left_out["small.png"], "of its camera") && contains(left_out["damaged.png"], "damaged.png"));
    assert_true(json["seconds"]["register"].get<double>() > 0.0);
    const Outcome table = run_words({"build", work("mixed"), "--no-store"});
    assert_true(table.code == done && contains(table.out, "pictures  5 of 12 used\n"));
    const Outcome all = run_words({"build", work("other"), "--no-store"});
    assert_true(all.code == done && !contains(all.out, "pictures  "));
}

// `build` of a row of pictures, one of which has another size.
Outcome build_with_one_smaller(const std::string &name, const Words &row, const std::string &picture) {
    simulate(name, row);
    simulate(name + "_small", row + Words{"--size", "400x300"});
    fs::copy_file(work(name + "_small/" + picture), work(name + "/" + picture), fs::copy_options::overwrite_existing);
    return run_words(Words{"build", work(name)} + quietly);
}

// The picture that joins two parts of a row has another size: the larger part is used, and the reasons mention the
// size.
void test_another_camera_in_a_chain(void **) {
    if (is_missing()) return;
    const Outcome run = build_with_one_smaller("chain", {"--images", "6", "--seed", "61"}, "img002.png");
    assert_int_equal(run.code, done);
    assert_int_equal(parsed(run.out)["images"].size(), 3);
    assert_true(contains(run.err,
                         "img000.png, img001.png: left out: part of another group: only pictures of another "
                         "camera"));
    assert_true(contains(run.err, "img002.png: left out: no two pictures of its camera, size or processing overlap"));
}

// If only a picture of another size connects a picture to the others, the reason does not blame the picture's own size.
void test_one_picture_behind_another_camera(void **) {
    if (is_missing()) return;
    const Outcome run = build_with_one_smaller("end", {"--images", "5", "--seed", "62"}, "img001.png");
    assert_int_equal(run.code, done);
    assert_true(contains(run.err, "img001.png: left out: no two pictures of its camera, size or processing overlap"));
    assert_true(contains(run.err,
                         "img000.png: left out: only pictures of another camera, size or processing connect "
                         "it"));
}

// A bracket shows no falloff: the message names the commands for it. Together with a row of pictures it is left out,
// whatever its length.
void test_a_bracket(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "3", "--seed", "71"});
    fs::create_directory(work("still"));
    for (int i = 0; i < 4; i++) {
        simulate("shot" + std::to_string(i),
                 {"--images", "2", "--seed", "72", "--set", "mean-ev=" + std::to_string(i - 2)});
        fs::copy_file(work("shot" + std::to_string(i) + "/img000.png"), work("still/s" + std::to_string(i) + ".png"));
    }
    assert_refused(not_usable, {"build", work("still"), "--no-store"}, {"did not move", "lensprof bracket", "align"});
    const Json json =
        json_of({"calibrate", work("still"), "-o", work("still_out"), "--no-store", "--json"}, not_usable);
    assert_true(json["panoramas"][0]["camera"] == "stood still" && json["panoramas"][0]["result"].is_null());
    for (int i = 0; i < 4; i++)
        fs::copy_file(work("still/s" + std::to_string(i) + ".png"), work("row/s" + std::to_string(i) + ".png"));
    const Outcome run = run_words(Words{"build", work("row")} + quietly);
    assert_int_equal(run.code, done);
    assert_int_equal(parsed(run.out)["images"].size(), 3);
    assert_true(contains(run.err, "s3.png: left out: part of another group, whose camera did not move"));
}

// If a third of each picture is fixed to the frame, as through a windscreen, the camera still counts as rotating.
void test_behind_a_dashboard(void **) {
    if (is_missing()) return;
    simulate("drive", {"--images", "5", "--seed", "75", "--set", "overlap=0.5"});
    simulate("board", {"--images", "2", "--seed", "76", "--scene", "foliage"});
    const Picture board = read_picture(work("board/img000.png"));
    for (int i = 0; i < 5; i++) {
        const std::string file = work("drive/img00" + std::to_string(i) + ".png");
        Picture picture = read_picture(file);
        const size_t from = picture.row_bytes * (picture.height * 65 / 100);
        std::copy(board.pixels.begin() + static_cast<std::ptrdiff_t>(from), board.pixels.end(),
                  picture.pixels.begin() + static_cast<std::ptrdiff_t>(from));
        write_picture(file, picture);
    }
    const Outcome run = run_words(Words{"build", work("drive")} + quietly);
    assert_true(contains(run.err, "5 pictures overlap") && contains(run.err, "a rotating camera"));
}

// A panorama of brackets: the camera is stationary within a stack and rotates between stacks; all belong together.
void test_stacks(void **) {
    if (is_missing()) return;
    fs::create_directory(work("stacks"));
    for (int ev : {-2, 0, 1}) {
        const std::string name = "ev" + std::to_string(ev);
        simulate(name, {"--images", "4", "--seed", "73", "--set", "ev=0.01,mean-ev=" + std::to_string(ev)});
        for (int i = 0; i < 4; i++)
            fs::copy_file(work(name + "/img00" + std::to_string(i) + ".png"),
                          work("stacks/v" + std::to_string(i) + "_" + name + ".png"));
    }
    const Json json = json_of(Words{"build", work("stacks")} + quietly);
    assert_int_equal(json["images"].size(), 12);
    const auto ev = [&](size_t i) { return json["images"][i]["ev"].get<double>(); };
    for (size_t view = 0; view < 12; view += 3)  // -2, 0 and 1 EV, apart from gamma
        assert_close((ev(view + 2) - ev(view)) / (ev(view + 1) - ev(view)), 1.5, 0.02);
}

// Pictures written by lensprof are not photographs, unless they are named.
void test_own_pictures_are_left_out(void **) {
    if (is_missing()) return;
    simulate("own", {"--images", "3", "--seed", "65"});
    must_exit(done, {"build", work("own"), "--no-store", "--write", "pto=" + work("own/result.pto")});
    must_exit(done, {"apply", "--pto", work("own/result.pto"), "-o", work("own/even")});
    const Outcome run = run_words(Words{"build", work("own")} + quietly);
    assert_int_equal(run.code, done);
    assert_int_equal(parsed(run.out)["images"].size(), 3);
    assert_true(contains(run.err, "even/img001.png: left out: lensprof made it"));
    must_exit(not_usable, Words{"build", work("own/even")} + quietly);
}

// Unwritable outputs are reported before the search for overlaps, and no named picture is overwritten, whether it is
// part of the result or not.
void test_outputs_are_checked_first(void **) {
    if (is_missing()) return;
    simulate("first", {"--images", "3", "--seed", "63"});
    fs::copy_file(work("first/img001.png"), work("first/copy.png"));
    simulate("alone", {"--images", "2", "--seed", "64"});
    fs::copy_file(work("alone/img000.png"), work("first/z.png"));
    const auto refused = [](const Words &more, const std::string &said, int code = usage) {
        const Outcome run = run_words(Words{"build", work("first")} + more);
        assert_int_equal(run.code, code);
        assert_true(contains(run.err, said) && !contains(run.err, "pictures overlap"));
    };
    for (const char *picture : {"first/copy.png", "first/z.png", "first/img001.png"}) {
        const std::string before = text_of(work(picture));
        refused({"--no-store", "--write", "preview=" + work(picture)}, work(picture) + ": would be overwritten");
        assert_true(text_of(work(picture)) == before);
    }
    refused({"--no-store", "--write", "pto=" + work("alone/img001.png")}, "is the name of a picture");
    refused({"--no-store", "--write", "preview=" + work("alone/img001.png")}, "is an existing photograph");
    refused({"--no-store", "--write", "preview=" + work("nowhere/p.jpg")}, "cannot write", failed);
    refused({"--no-store", "--write", "project=" + work("nowhere/p.pto")}, "cannot write", failed);
    refused({"--no-store", "--write", "pto=" + work("alone")}, "not a regular file");
    refused({"--no-store", "--write", "pto=/dev/null"}, "not a regular file");
    for (const char *picture :
         {"first/img000.png", "first/img001.png", "first/img002.png", "first/copy.png", "first/z.png"})
        write_picture(work(picture), read_picture(work(picture)));  // without metadata
    refused({"--db", work("first.db")}, "EXIF does not name camera and lens");
    assert_true(!fs::exists(work("first.db")));
}

// A mirrored picture overlaps no other, even if its name comes first.
void test_the_mirrored_picture_is_the_copy(void **) {
    if (is_missing()) return;
    simulate("mirrored", {"--images", "3", "--seed", "72"});
    Picture picture = read_picture(work("mirrored/img001.png"));
    for (uint32_t y = 0; y < picture.height; y++) {
        auto *row = reinterpret_cast<std::array<uint8_t, 3> *>(picture.pixels.data() + y * picture.row_bytes);
        std::reverse(row, row + picture.width);
    }
    write_picture(work("mirrored/a.png"), picture);
    const Outcome run = run_words(Words{"build", work("mirrored")} + quietly);
    assert_int_equal(run.code, done);
    assert_int_equal(parsed(run.out)["images"].size(), 3);
    assert_true(contains(run.err, "a.png: left out: a copy of"));
    assert_true(contains(run.err, "img001.png, mirrored"));
}

void test_corrected_copies_are_not_read(void **) {
    if (is_missing()) return;
    simulate("copies", {"--images", "3", "--seed", "71"});
    must_exit(done, {"calibrate", work("copies"), "-o", work("copies/even"), "--no-store"});
    const Outcome run = run_words(Words{"build", work("copies")} + quietly);
    assert_int_equal(run.code, done);
    assert_int_equal(parsed(run.out)["images"].size(), 3);
    assert_true(contains(run.err, "copies/even: left out: it is an output folder of calibrate"));
}

// A logo at the same place in all frames matches everywhere, but is not part of the scene.
void test_what_is_fixed_to_the_frame(void **) {
    if (is_missing()) return;
    simulate("stamped", {"--images", "5", "--seed", "81", "--size", "640x480"});
    const Json plain = json_of(Words{"build", work("stamped")} + quietly);
    for (int i = 0; i < 5; i++) {
        const std::string file = work("stamped/img00" + std::to_string(i) + ".png");
        ReadOptions options;
        Picture picture = read_picture(file, options);
        std::mt19937 random(9);
        for (uint32_t y = 420; y < 470; y += 5)
            for (uint32_t x = 20; x < 240; x += 5) {
                const auto grey = static_cast<uint8_t>(60 + random() % 120);
                for (uint32_t p = 0; p < 25; p++) {
                    uint8_t *pixel = picture.pixels.data() + (y + p / 5) * picture.row_bytes + 3 * size_t(x + p % 5);
                    std::fill(pixel, pixel + 3, grey);
                }
            }
        write_picture(file, picture);
    }
    assert_alike(plain, json_of(Words{"build", work("stamped")} + quietly));
}

// Standard deviation of the logarithm of one panel divided by the other: 0 if they differ only by a factor. Places
// without a picture, near black and near white are ignored.
double spread(const Picture &one, uint32_t one_top, const Picture &other, uint32_t other_top, uint32_t height) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < one.width; x++) {
            const uint8_t *a = one.pixels.data() + (one_top + y) * one.row_bytes + size_t(3) * x,
                          *b = other.pixels.data() + (other_top + y) * other.row_bytes + size_t(3) * x;
            const bool is_empty =
                (a[0] == 128 && a[1] == 128 && a[2] == 128) || (b[0] == 128 && b[1] == 128 && b[2] == 128);
            if (is_empty || std::min({b[0], b[1], b[2]}) < 20 || std::max({b[0], b[1], b[2]}) > 240) continue;
            const double ratio = std::log((a[1] + 1.0) / (b[1] + 1.0));
            sum += ratio, squares += ratio * ratio, count++;
        }
    assert_true(count > 0.2 * one.width * height);
    return std::sqrt(squares / count - sum / count * (sum / count));
}

// The corrected mosaic compared with that of the same scene from a camera without falloff and with one exposure.
void test_the_preview_is_even(void **) {
    simulate("uneven", {"--images", "5", "--set", "ev=0.8", "--seed", "8"});
    simulate("truth", {"--images", "5", "--set", "ev=0,wb=0", "--vignetting=-.03,0,0", "--seed", "8"});
    const std::string preview = work("preview.png"), wide = work("wide.jpg"), pto = work("uneven/pano.pto");
    must_exit(done, Words{"build", pto, "--write", std::string("preview=") + preview} + quietly);
    must_exit(done, Words{"build", work("truth/pano.pto"), "--write", "preview=" + work("truth.png")} + quietly);
    const Picture own = read_picture(preview), truth = read_picture(work("truth.png"));
    assert_true(own.width == truth.width && own.height == truth.height && own.width > 1000);
    const uint32_t height = (own.height - 8) / 2;
    const double before = spread(own, 0, truth, 0, height), after = spread(own, height + 8, truth, 0, height);
    assert_true(before > 0.1 && after < 0.03);
    assert_int_equal(run_words({"build", pto, "--write", "preview=" + work("preview.txt"), "--no-store"}).code, usage);
    assert_int_equal(run_words({"build", pto, "--write", "preview=" + work("uneven/img000.png"), "--no-store"}).code,
                     usage);
    assert_int_equal(
        run_words({"build", pto, "--write", std::string("preview=") + wide, "--points", work("p.txt"), "--no-store"})
            .code,
        usage);
    assert_false(fs::exists(wide));
}

// A cropped picture has another angle of view for the geometry, also with --one-lens.
void test_one_lens_keeps_the_geometry(void **) {
    if (is_missing()) return;
    simulate("crops", {"--images", "4", "--seed", "41", "--size", "800x600", "--set", "overlap=0.5"});
    for (const char *name : {"img001.png", "img003.png"}) {
        const std::string file = work(std::string("crops/") + name);
        Picture picture = read_picture(file), cut = picture;
        cut.width = 600, cut.row_bytes = size_t(3) * 600;
        cut.pixels.resize(cut.row_bytes * cut.height);
        for (uint32_t y = 0; y < cut.height; y++)
            std::copy_n(picture.pixels.data() + y * picture.row_bytes + 300, cut.row_bytes,
                        cut.pixels.data() + y * cut.row_bytes);
        write_picture(file, cut);
    }
    const Words words = Words{"build", work("crops"), "--one-lens"} + quietly;
    assert_true(contains(run_words(words).err, "img001.png (600 x 600 pixels): not of the shape of "));
    const Json json = json_of(words);
    for (const Json &image : json["images"]) assert_true(image["joined"] == true);
    assert_int_equal(json["images"].size(), 4);
    assert_true(json["residual"]["heldout_median"].get<double>() < 3.0);
}

// Pictures that are only a line, and files that are not pictures, do not stop the others.
void test_odd_files_among_good_ones(void **) {
    if (is_missing()) return;
    simulate("odd", {"--images", "3", "--seed", "51"});
    Picture line;
    line.width = 5000, line.height = 1, line.row_bytes = 15000, line.pixels.assign(15000, 90);
    write_picture(work("odd/line.png"), line);
    save_text(work("odd/empty1.jpg"), ""), save_text(work("odd/empty2.jpg"), "");
    const Outcome run = run_words(Words{"build", work("odd")} + quietly);
    assert_int_equal(run.code, done);
    assert_true(contains(run.err, "line.png: left out: no overlap"));
    assert_true(contains(run.err, "empty1.jpg") && contains(run.err, "empty2.jpg") && !contains(run.err, "a copy of"));
}

// Pictures from a camera that moved above the ground at an oblique angle: sRGB of radiances, falloff, exposures.
constexpr double moved_ev[] = {0.0, 0.5, -0.4, 0.3, -0.2}, moved_k1 = -0.35;
constexpr uint32_t moved_width = 640, moved_height = 480, ground = 2400;

std::vector<float> make_ground() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto below = [&](double most) { return static_cast<uint32_t>(most * uniform(random)); };
    std::vector<float> canvas(size_t{ground} * ground, 0.2f);
    for (int n = 0; n < 9000; n++) {
        const auto light = static_cast<float>(0.03 + 0.5 * uniform(random));
        const uint32_t x0 = below(ground), y0 = below(ground), w = 12 + below(60), h = 12 + below(60);
        for (uint32_t y = y0; y < std::min(ground, y0 + h); y++)
            for (uint32_t x = x0; x < std::min(ground, x0 + w); x++) canvas[size_t{y} * ground + x] = light;
    }
    return canvas;
}

void write_moved(const std::string &folder) {
    fs::create_directories(folder);
    const std::vector<float> canvas = make_ground();
    for (uint32_t i = 0; i < 5; i++) {
        Picture picture;
        picture.width = moved_width, picture.height = moved_height, picture.row_bytes = 3 * moved_width;
        picture.layout = LENSPROF_LAYOUT_RGB, picture.sample = LENSPROF_SAMPLE_U8;
        picture.pixels.resize(size_t{3} * moved_width * moved_height);
        for (uint32_t y = 0; y < moved_height; y++)
            for (uint32_t x = 0; x < moved_width; x++) {
                const double away = 1.0 / (0.6 + y / 480.0), u = x - 319.5, v = y - 239.5;
                const auto across = static_cast<size_t>(600.0 + u * away + 110.0 * i);
                const size_t at = static_cast<size_t>(1200.0 * away) * ground + across;
                const double light =
                    std::exp2(moved_ev[i]) * (1.0 + moved_k1 * (u * u + v * v) / (400.0 * 400.0)) * double(canvas[at]);
                const double grey = light < 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
                for (size_t c = 0; c < 3; c++)
                    picture.pixels[(size_t{y} * moved_width + x) * 3 + c] =
                        static_cast<uint8_t>(std::lround(255.0 * std::min(grey, 1.0)));
            }
        write_tiff_file(folder + "/moved" + std::to_string(i) + ".tif", picture, {});
    }
}

// They are compared at their matches; a second time from the records of `calibrate`.
void test_a_camera_that_moved(void **) {
    if (is_missing()) return;
    write_moved(work("moved"));
    const auto is_right = [](const Json &json) {
        double both = 0.0, squares = 0.0;  // up to the exponent that pictures leave open
        for (size_t i = 0; i < 5; i++) {
            const double ev = json["images"][i]["ev"].get<double>();
            both += ev * moved_ev[i], squares += ev * ev;
        }
        const double slope = both / squares;
        assert_true(slope > 0.6 && slope < 1.6);
        for (size_t i = 0; i < 5; i++) assert_close(slope * json["images"][i]["ev"].get<double>(), moved_ev[i], 0.02);
        assert_close(std::pow(corner_of(json), slope), 1.0 + moved_k1, 0.03);
    };
    const Outcome run = run_words(Words{"build", work("moved")} + quietly);
    if (run.code != done) print_error("%s\n", run.err.c_str());
    assert_int_equal(run.code, done);
    assert_true(contains(run.err, "compared only at matched points"));
    is_right(parsed(run.out));
    assert_true(parsed(run.out)["images"] == json_of(Words{"build", work("moved")} + quietly)["images"]);
    is_right(json_of(Words{"build", work("moved"), "--fit", "method=radiance"} + quietly));

    const Words calibrate{"calibrate", work("moved"), "-o", work("moved_out"), "--no-store"};
    assert_string_equal(code_of(parsed(run.out)).c_str(), "few_images");
    assert_true(contains(run.out, "the falloff is from only 5 images of a moving camera"));
    must_exit(done, calibrate);
    must_exit(done, calibrate);  // from the records
    const Json first = parsed(text_of(work("moved_out/calibrate.json")));
    is_right(first["panoramas"][0]["result"]);
    assert_string_equal(code_of(first["panoramas"][0]["result"]).c_str(), "few_images");
    fs::remove(work("moved_out/panorama_moved0.pto"));  // fitted again, with the registration from the records
    must_exit(done, calibrate);
    const Json second = parsed(text_of(work("moved_out/calibrate.json")));
    assert_true(second["panoramas"][0]["result"]["images"] == first["panoramas"][0]["result"]["images"]);
}

void test_refused(void **) {
    if (is_missing()) return;
    simulate("one", {"--images", "2", "--seed", "31"});
    simulate("two", {"--images", "2", "--seed", "32"});
    const std::string a = work("one/img000.png"), b = work("two/img000.png"), pto = work("one/pano.pto");
    const auto refuse = [](const Words &words, int code, const std::string &text) {
        const Outcome refused = run_words(words);
        assert_int_equal(refused.code, code);
        if (!contains(refused.err, text)) print_error("%s\n", refused.err.c_str());
        assert_true(contains(refused.err, text));
    };
    refuse({"build", a, "--no-store"}, not_usable, "has only one picture");
    refuse({"build", a, a, "--no-store"}, not_usable, "has only one picture");
    refuse({"build", a, b, "--no-store"}, not_usable, "no two of the pictures overlap");
    refuse({"build", work("one"), "--points", work("p.txt"), "--no-store"}, usage, "--points: needs the project");
    refuse({"build", pto, "--write", "project=" + work("q.pto"), "--no-store"}, usage,
           "--write project: needs pictures");
    refuse({"build", work("one"), "--write", std::string("project=") + a, "--no-store"}, usage, "would be overwritten");
    refuse({"build", work("nowhere"), "--no-store"}, unreadable, "nowhere");
    save_text(work("p1.png"), "no picture"), save_text(work("p2.png"), "none either");
    refuse({"build", work("p1.png"), work("p2.png"), "--no-store"}, unreadable, "none of the pictures can be read");
    fs::create_directory(work("empty"));
    refuse({"build", work("empty"), "--no-store"}, usage, "is a folder without pictures");
    assert_false(fs::exists(work("q.pto")));
    const Json json = parsed(run_words({"build", a, b, "--no-store", "--json"}).out);
    assert_true(json["usable"] == false);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_a_folder_is_as_good_as_its_project),
        CLI_TEST(test_pictures_that_look_unlike),
        CLI_TEST(test_a_folder_of_many_things),
        CLI_TEST(test_another_camera_in_a_chain),
        CLI_TEST(test_one_picture_behind_another_camera),
        CLI_TEST(test_outputs_are_checked_first),
        CLI_TEST(test_a_bracket),
        CLI_TEST(test_behind_a_dashboard),
        CLI_TEST(test_stacks),
        CLI_TEST(test_own_pictures_are_left_out),
        CLI_TEST(test_the_mirrored_picture_is_the_copy),
        CLI_TEST(test_corrected_copies_are_not_read),
        CLI_TEST(test_what_is_fixed_to_the_frame),
        CLI_TEST(test_the_preview_is_even),
        CLI_TEST(test_one_lens_keeps_the_geometry),
        CLI_TEST(test_odd_files_among_good_ones),
        CLI_TEST(test_a_camera_that_moved),
        CLI_TEST(test_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
