// `lensprof response`: the response of simulated cameras from raw files and their JPEGs, compared with the truth.
#include "cli_runs.hpp"
#include "response_scenes.hpp"

#include "campaign.h"

using namespace cli_runs;
using namespace response_scenes;

namespace {

void needs_libraw() {
    if (!can_read_raw()) skip();
}

std::string work(const std::string &name) { return in_folder(name); }

// Writes the JPEG that would be embedded, and the raw file that contains it.
std::string save_shot(const std::string &name, const Taken &taken, const JpegKind &kind = {92, 2, 2}) {
    const std::string jpeg = work("embedded.tmp.jpg"), file = work(name);
    write_jpeg_file(jpeg, taken.rendered, kind);
    save(file, raw_files::dng_with_preview(taken.dng, load(jpeg), taken.rendered.width, taken.rendered.height));
    fs::remove(jpeg);
    return file;
}

// A camera whose properties all vary.
Shot any_shot(int i) {
    std::mt19937 random(static_cast<uint32_t>(1000 + i));
    std::uniform_real_distribution<double> even(0.0, 1.0);
    Shot shot;
    shot.response = response_number(i);
    shot.white_ev = -0.2 + 0.8 * even(random);
    shot.exposure = std::exp2(-0.5 + 1.5 * even(random));
    shot.mixing = 0.8 * even(random);
    shot.balance = {1.4 + even(random), 1.0, 1.2 + even(random)};
    shot.falloff = {-0.6 * even(random), -0.1 + 0.2 * even(random), 0.0};
    shot.corrects = i % 3 == 1;
    shot.saturation = i % 4 == 3 ? 0.3 * even(random) : 0.0;
    shot.sharpen = 0.6 * even(random);
    shot.noise = 0.003 * even(random), shot.shot_noise = 0.03 * even(random);
    shot.crop = 0.02 * even(random);
    shot.bend = i % 5 == 2 ? -0.04 * even(random) : 0.0;
    shot.rendered_width = static_cast<uint32_t>(400 + 480 * even(random));
    shot.jpeg.quality = 75 + static_cast<int>(24 * even(random));
    shot.jpeg.step_x = shot.jpeg.step_y = i % 2 ? 1 : 2;
    const lensprof::SimulatedKind kinds[] = {lensprof::SimulatedKind::landscape, lensprof::SimulatedKind::landscape,
                                             lensprof::SimulatedKind::interior, lensprof::SimulatedKind::foliage};
    shot.scene = kinds[i / 2 % 4];
    shot.seed = static_cast<uint32_t>(50 + i);
    return shot;
}

double true_gamma(const Shot &shot) { return std::exp(gauge_of(shot.response)) / std::log(208.0 / 48.0); }

double error_of(const Json &json, const Shot &shot) {
    return std::log(double(json["gamma"]["value"]) / true_gamma(shot));
}

Words respond(const std::string &file) { return {"response", file, "--no-store", "--json"}; }

// 30 cameras: if the command calls the result usable, ln gamma is within .03, and within its standard error as often as
// expected. Scenes that show too little are refused; the stated error holds for them, too.
void test_cameras(void **) {
    needs_libraw();
    const int runs = campaign_runs(30);
    int fitted = 0, usable = 0, within = 0, within_two = 0;
    double squares = 0.0;
    for (int i = 0; i < runs; i++) {
        const Shot shot = any_shot(i);
        const Outcome outcome = run_words(respond(save_shot("shot.dng", take(shot), shot.jpeg)));
        const Json json = parsed(outcome.out);
        if (json["files"].empty()) continue;
        const double error = error_of(json, shot), sigma = json["gamma"]["sigma"];
        fitted++, within += std::fabs(error) <= sigma, within_two += std::fabs(error) <= 2 * sigma;
        const Json &falloff = json["files"][0]["falloff"];
        print_message("%2d %s: ln gamma error %+.4f +- %.4f, corner %.3f, map %.2f levels\n", i,
                      json["usable"] ? "usable" : "refused", error, sigma, double(falloff["corner"]),
                      double(json["files"][0]["tones"]["pattern"]));
        if (!json["usable"]) continue;
        const double radius = json["files"][0]["radius"];
        const double corner = shot.corrects ? 1.0 / falloff_of(shot, radius * radius) : 1.0;
        usable++, squares += error * error;
        assert_true(std::fabs(error) <= 0.03);
        assert_true(std::fabs(double(falloff["corner"]) - corner) <= 0.02);
        assert_int_equal(bool(falloff["corrected"]), corner > 1.02);
    }
    print_message("%d runs, %d fitted, %d usable: RMS of ln gamma %.4f; within one standard error %d, two %d\n", runs,
                  fitted, usable, std::sqrt(squares / std::max(usable, 1)), within, within_two);
    assert_true(usable >= runs * 7 / 10);
    assert_true(within >= fitted * 6 / 10 && within_two >= fitted * 9 / 10);
}

// A well lit picture from a camera with an sRGB curve.
Shot good_shot(uint32_t seed = 3) {
    Shot shot;
    shot.response = table_response(srgb);
    shot.seed = seed;
    shot.exposure = 1.3;
    return shot;
}

void test_curve(void **) {
    needs_libraw();
    const Shot shot = good_shot();
    const std::string file = save_shot("shot.dng", take(shot));
    const Json json = json_of(respond(file));
    assert_true(std::fabs(error_of(json, shot)) <= 0.01);
    // Compares the curve level by level, except for the position of white, which is the scale of the curve.
    double off = 0.0, mean = 0.0;
    lensprof_response found;
    const std::vector<double> values = json["response"]["values"][0];
    assert_int_equal(lensprof_response_set_table(&found, values.data(), uint32_t(values.size())), LENSPROF_OK);
    std::vector<double> ratios;
    for (int level = 48; level <= 208; level += 8)
        ratios.push_back(std::log2(lensprof_response_invert(&found, level / 255.0, nullptr)
                                   / lensprof_response_invert(&shot.response, level / 255.0, nullptr)));
    for (double ratio : ratios) mean += ratio / double(ratios.size());
    for (double ratio : ratios) off = std::max(off, std::fabs(ratio - mean));
    assert_true(off <= 0.03);
    Json again = json_of(respond(file)), once = json;
    again.erase("seconds"), once.erase("seconds");
    assert_string_equal(again.dump().c_str(), once.dump().c_str());
}

// Rotated as the camera was held, cropped to another aspect ratio, distortion corrected, enlarged.
void test_geometry(void **) {
    needs_libraw();
    for (int i = 0; i < 5; i++) {
        Shot shot = good_shot(static_cast<uint32_t>(5 + i));
        shot.quarter_turns = i < 4 ? i : 0;
        shot.bend = i == 2 ? -0.05 : 0.0;
        shot.crop = i == 3 ? 0.06 : 0.01;
        if (i == 4) shot.rendered_width = 882;
        const Json json = json_of(respond(save_shot("shot.dng", take(shot))));
        const Json &file = json["files"][0];
        assert_int_equal(int(file["quarter_turns"]), (4 - shot.quarter_turns) % 4);
        assert_true(std::fabs(error_of(json, shot)) <= 0.02);
        if (i == 2) assert_true(std::fabs(double(file["alignment"]["k"][0]) + 0.05) <= 0.015);
        const double kept = 1.0 - 2.0 * shot.crop;
        if (i != 2) assert_true(std::fabs(double(file["alignment"]["scale"]) - kept) <= 0.002);
    }
}

void test_local_tones_are_refused(void **) {
    needs_libraw();
    Shot shot = good_shot();
    shot.local_ev = 0.6;
    const std::string file = save_shot("shot.dng", take(shot));
    const Json json = json_of(respond(file), not_usable);
    assert_false(bool(json["usable"]));
    assert_string_equal(code_of(json).c_str(), "patterns");
    assert_close(double(json["findings"][0]["limit"]), 1.2, 0.0);
    assert_true(double(json["findings"][0]["measured"]) > 1.2);
    assert_string_equal(std::string(json["passed"][0]["code"]).c_str(), "few_greys");
    assert_close(double(json["passed"][0]["limit"]), 4.0, 0.0);
    assert_string_equal(std::string(json["files"][0]["tones"]["mapped"]).c_str(), "local");
    assert_refused(not_usable, {"response", file, "--db", work("a.db")}, {"mapped locally", "nothing was stored"});
    assert_false(fs::exists(work("a.db")));
    const Json forced = json_of({"response", file, "--db", work("a.db"), "--force", "--json"}, not_usable);
    assert_int_equal(int64_t(forced["profile"]), 1);
    assert_true(bool(json_of({"profile", "show", "1", "--db", work("a.db"), "--json"})["provenance"]["forced"]));
}

// The stored profile is a response of the camera with its error, for any lens.
void test_stored(void **) {
    needs_libraw();
    Shot shot = good_shot();
    for (const bool corrects : {false, true}) {
        shot.corrects = corrects;
        const std::string file = save_shot("shot.dng", take(shot)), db = work(corrects ? "b.db" : "a.db");
        const std::string out = must_exit(done, {"response", file, "--db", db});
        assert_true(contains(out, corrects ? "corrected by the camera" : "not corrected"));
        assert_true(contains(out, "stored    profile 1"));
        const Json stored = json_of({"profile", "show", "1", "--db", db, "--json"});
        assert_string_equal(std::string(stored["key"]["camera_model"]).c_str(), "TestCam 1");
        assert_string_equal(std::string(stored["key"]["lens"]).c_str(), "");
        assert_string_equal(std::string(stored["key"]["processing"]).c_str(), corrects ? "corrected" : "jpeg");
        assert_string_equal(std::string(stored["provenance"]["method"]).c_str(), "response");
        assert_string_equal(std::string(stored["response"]["kind"]).c_str(), "table");
        const double sigma = stored["provenance"]["gamma_sigma"];
        assert_true(sigma > 0.001 && sigma < 0.02);
    }
    must_exit(done, {"response", work("shot.dng"), "--db", work("c.db"), "--camera", "Other", "--key", "style=Vivid"});
    const Json named = json_of({"profile", "show", "1", "--db", work("c.db"), "--json"});
    assert_string_equal(std::string(named["key"]["camera_model"]).c_str(), "Other");
    assert_string_equal(std::string(named["key"]["style"]).c_str(), "Vivid");
}

void test_several(void **) {
    needs_libraw();
    Shot shots[2] = {good_shot(3), good_shot(4)};
    shots[1].balance = {1.5, 1.0, 2.2}, shots[1].corrects = true;
    Taken taken[2] = {take(shots[0]), take(shots[1])};
    const std::string a = save_shot("a.dng", taken[0]), b = save_shot("b.dng", taken[1]);
    const Json json = json_of({"response", a, b, "--no-store", "--json"});
    assert_int_equal(json["files"].size(), 2);
    assert_true(std::fabs(error_of(json, shots[0])) <= 0.01);
    assert_false(bool(json["files"][0]["falloff"]["corrected"]));
    assert_true(bool(json["files"][1]["falloff"]["corrected"]));
    taken[1].dng.model = "TestCam 2";
    save_shot("b.dng", taken[1]);
    assert_refused(usage, {"response", a, b, "--no-store"}, {"b.dng: comes from another camera"});
}

// The camera's JPEG next to a raw file without one, and a JPEG given by name.
void test_jpeg_beside(void **) {
    needs_libraw();
    const Shot shot = good_shot();
    const Taken taken = take(shot);
    save(work("IMG_1.dng"), raw_files::dng_bytes(taken.dng));
    assert_refused(unreadable, {"response", work("IMG_1.dng"), "--no-store"}, {"without a JPEG preview", "--jpeg"});
    write_jpeg_file(work("IMG_1.JPG"), taken.rendered, {95, 1, 1});
    const Outcome beside = run_words({"response", work("IMG_1.dng"), "--no-store"});
    assert_int_equal(beside.code, done);
    assert_true(contains(beside.err, "; using " + work("IMG_1.JPG")));
    fs::rename(work("IMG_1.JPG"), work("other.jpg"));
    const Words named = {"response", work("IMG_1.dng"), "--jpeg", work("other.jpg"), "--no-store", "--json"};
    assert_true(std::fabs(error_of(json_of(named), shot)) <= 0.01);
    assert_refused(usage, named + Words{"--jpeg", work("other.jpg")}, {"--jpeg"});
    write_jpeg_file(work("other.jpg"), take(good_shot(9)).rendered, {95, 1, 1});
    assert_refused(not_usable, {"response", work("IMG_1.dng"), "--jpeg", work("other.jpg"), "--no-store"},
                   {"other.jpg: does not match the raw file"});
    write_picture(work("other.png"), taken.rendered);
    assert_refused(usage, {"response", work("IMG_1.dng"), "--jpeg", work("other.png"), "--no-store"},
                   {"is not a JPEG"});
    assert_refused(unreadable, {"response", work("IMG_1.dng"), "--jpeg", work("none.jpg"), "--no-store"}, {"none.jpg"});
}

// Black pictures, white ones, few grey levels, icons, cut files, and files that are not raw.
void test_bad_input(void **) {
    needs_libraw();
    Shot shot = good_shot();
    const Taken good = take(shot);
    shot.exposure = 1e-4;
    assert_refused(not_usable, {"response", save_shot("black.dng", take(shot)), "--no-store"},
                   {"black.dng", "of the grey value range"});
    shot.exposure = 1e4;
    assert_refused(not_usable, {"response", save_shot("white.dng", take(shot)), "--no-store"},
                   {"white.dng", "too few areas"});
    const Json none = json_of(respond(work("white.dng")), not_usable);
    assert_string_equal(code_of(none).c_str(), "few_pairs");
    assert_true(none["response"].is_null());
    shot = good_shot();
    shot.scene = lensprof::SimulatedKind::wall;
    assert_refused(not_usable, {"response", save_shot("wall.dng", take(shot)), "--no-store"},
                   {"wall.dng", "take a picture with all brightnesses"});
    shot = good_shot();
    shot.rendered_width = 160;
    assert_refused(not_usable, {"response", save_shot("icon.dng", take(shot)), "--no-store"}, {"icon.dng", "too few"});
    Taken other = good;
    other.rendered = take(good_shot(9)).rendered;
    assert_refused(not_usable, {"response", save_shot("other.dng", other), "--no-store"},
                   {"does not match the raw file"});
    const Bytes whole = load(save_shot("shot.dng", good));
    save(work("cut.dng"), Bytes(whole.begin(), whole.begin() + 20000));
    assert_refused(unreadable, {"response", work("cut.dng"), "--no-store"}, {"cut.dng"});
    assert_refused(usage, {"response", work("shot.dng"), work("shot.dng"), "--no-store"}, {"shot.dng", "given twice"});
    write_jpeg_file(work("plain.jpg"), good.rendered, {95, 1, 1});
    assert_refused(unreadable, {"response", work("plain.jpg"), "--no-store"}, {"not a camera raw file"});
    assert_refused(unreadable, {"response", work("missing.dng"), "--no-store"}, {"missing.dng"});
    assert_refused(usage, {"response", work("shot.dng"), "--no-store", "--db", work("a.db")}, {"--no-store"});
}

// A monochrome sensor with its grey JPEG; the black-and-white JPEG of a colour sensor is an unknown mixture.
void test_monochrome(void **) {
    needs_libraw();
    Shot shot = good_shot();
    shot.monochrome = true;
    const Taken taken = take(shot);
    const std::string file = save_shot("grey.dng", taken);
    assert_refused(not_usable, {"response", file, "--no-store"}, {"black and white"});
    Bytes bytes = load(file);
    const Bytes colour = {0x06, 1, 3, 0, 1, 0, 0, 0, 0x23, 0x80};  // PhotometricInterpretation: a mosaic
    const auto at = std::search(bytes.begin(), bytes.end(), colour.begin(), colour.end());
    assert_true(at != bytes.end());
    at[8] = 0x4c, at[9] = 0x88;  // linear values
    save(file, bytes);
    const Json json = json_of(respond(file));
    assert_true(std::fabs(error_of(json, shot)) <= 0.02);
}

void test_without_libraw(void **) {
    if (can_read_raw()) skip();
    raw_files::Dng dng;
    dng.width = dng.height = 16, dng.values.assign(256, 1000);
    save(work("a.dng"), raw_files::dng_bytes(dng));
    assert_refused(unreadable, {"response", work("a.dng"), "--no-store"}, {"a.dng", "libraw-dev"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_cameras, empty_folder),
        cmocka_unit_test_setup(test_curve, empty_folder),
        cmocka_unit_test_setup(test_geometry, empty_folder),
        cmocka_unit_test_setup(test_local_tones_are_refused, empty_folder),
        cmocka_unit_test_setup(test_stored, empty_folder),
        cmocka_unit_test_setup(test_several, empty_folder),
        cmocka_unit_test_setup(test_jpeg_beside, empty_folder),
        cmocka_unit_test_setup(test_bad_input, empty_folder),
        cmocka_unit_test_setup(test_monochrome, empty_folder),
        cmocka_unit_test_setup(test_without_libraw, empty_folder),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
