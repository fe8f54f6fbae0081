// `calibrate` of folders with unusual content: it is named, and the rest is processed.
#include "calibrate_runs.hpp"
#include "photo/pictures/picture.hpp"

using namespace calibrate_runs;

namespace {

// Four overlapping pictures, and three of another panorama.
std::string two_panoramas() {
    simulate("row", {"--images", "4", "--seed", "21"});
    simulate("three", {"--images", "3", "--seed", "22"});
    for (const char *number : {"0", "1", "2"})
        fs::copy_file(work(std::string("three/img00") + number + ".png"), work(std::string("row/x") + number + ".png"));
    return work("row");
}

Words unstored(const Words &more = {}) {
    return Words{"calibrate", work("row"), "-o", work("out"), "--no-store", "--json"} + more;
}

// Why a picture is left out; "" if it is not.
std::string reason_of(const Json &json, const std::string &name) {
    for (const Json &one : json["left_out"])
        if (fs::path(one["file"].get<std::string>()).filename() == name) return one["reason"];
    return {};
}

void assert_left_out(const Json &json, const std::string &name, const std::string &part) {
    const std::string reason = reason_of(json, name);
    if (reason.empty() || !contains(reason, part))
        fail_msg("%s: '%s' of %s", name.c_str(), reason.c_str(), part.c_str());
}

// An edited project is applied to the pictures it names, in any order.
void test_edited_project(void **) {
    if (is_missing()) return;
    two_panoramas();
    const std::string project = json_of(unstored())["panoramas"][0]["project"];
    save_text(project, text_of(project) + "# edited\n");  // from now on it counts, with fewer modes than the result
    const Json before = json_of(unstored());
    const auto ev_of = [](const Json &json, const std::string &name) {
        for (const Json &one : json["pictures"])
            if (fs::path(one["file"].get<std::string>()).filename() == name) return one["ev"].get<double>();
        fail_msg("%s is not corrected", name.c_str());
        return 0.0;
    };
    edit(project, "img001", "IMG");
    edit(project, "img002", "img001");
    edit(project, "IMG", "img002");
    const Json swapped = json_of(unstored());
    assert_true(std::fabs(ev_of(swapped, "img001.png") - ev_of(before, "img002.png")) < 1e-6);
    assert_true(std::fabs(ev_of(swapped, "img002.png") - ev_of(before, "img001.png")) < 1e-6);
    assert_true(std::fabs(ev_of(before, "img001.png") - ev_of(before, "img002.png")) > 0.01);
    edit(project, "img001\\.png", "x0.png");
    const Json named = json_of(unstored());
    assert_left_out(named, "img001.png", "is not in ");
    assert_int_equal(named["pictures"].size(), 6);
    save_text(project, "garbage");
    const Json garbage = json_of(unstored());
    assert_int_equal(garbage["pictures"].size(), 3);
    assert_left_out(garbage, "img000.png", "panorama img000 cannot be corrected");
}

// A picture is temporarily unreadable: the failed work is tried again. (Permissions do not stop root from reading, so
// the file is damaged and restored with its size and time.)
void test_passing_read_error(void **) {
    if (is_missing()) return;
    two_panoramas();
    const std::string picture = work("row/img002.png");
    const Bytes whole = load(picture);
    const auto time = fs::last_write_time(picture);
    Bytes damaged = whole;
    const size_t middle = damaged.size() / 2;
    assert_true(damaged.size() > (size_t(1) << 17) + 100);
    std::fill_n(damaged.begin() + static_cast<ptrdiff_t>(middle), 100, uint8_t(0));
    save(picture, damaged);
    fs::last_write_time(picture, time);
    const Json first = json_of(unstored());
    assert_left_out(first, "img002.png", "img002.png");
    assert_now(json_of(unstored()), false, 0, 0);
    save(picture, whole);
    fs::last_write_time(picture, time);
    const Json second = json_of(unstored());
    assert_true(reason_of(second, "img002.png").empty());
    assert_int_equal(second["pictures"].size(), 7);
}

// Names that a project cannot hold, and extensions that contradict the content.
void test_odd_names(void **) {
    if (is_missing()) return;
    two_panoramas();
    const auto renamed = [](const char *from, const std::string &to) {
        fs::rename(work(std::string("row/") + from), work("row/" + to));
    };
    simulate("more", {"--images", "2", "--seed", "5", "--format", "png16"});
    fs::copy_file(work("more/img000.png"), work("row/y0.jpg"));
    fs::copy_file(work("more/img001.png"), work("row/y1.png"));
    renamed("img003.png", "img\"3.png");
    renamed("x1.png", "x\n1.png");
    renamed("img001.png", "q.nef");
    const Json json = json_of(unstored());
    assert_left_out(json, "img\"3.png", "a quote or a line break");
    assert_left_out(json, "x\n1.png", "a quote or a line break");
    for (const char *name : {"out/q.png", "out/y0.png", "out/y1.png"})
        if (!fs::exists(work(name))) fail_msg("%s is missing: %s", name, json.dump().c_str());
    assert_int_equal(read_picture(work("out/y0.png")).sample, LENSPROF_SAMPLE_U16);
}

// The copy of an earlier run has been damaged: its cell of the sheet is empty.
void test_damaged_copy(void **) {
    if (is_missing()) return;
    two_panoramas();
    json_of(unstored());
    save_text(work("out/img001.png"), "damaged");
    fs::remove(work("out/calibrate_sheet.jpg"));
    const Json json = json_of(unstored());
    assert_int_equal(json["pictures"].size(), 7);
    assert_true(read_picture(work("out/calibrate_sheet.jpg")).width > 1000);
}

// Pictures with the same names as the command's own files.
void test_names_of_its_own(void **) {
    if (is_missing()) return;
    two_panoramas();
    json_of(unstored());
    simulate("more", {"--images", "2", "--seed", "5", "--format", "jpeg"});
    fs::rename(work("more/img000.jpg"), work("row/calibrate_sheet.jpg"));
    fs::rename(work("more/img001.jpg"), work("row/panorama_img000.jpg"));
    const Json json = json_of(unstored());
    assert_left_out(json, "calibrate_sheet.jpg", "the name of the contact sheet");
    assert_left_out(json, "panorama_img000.jpg", "no overlap");
    assert_false(fs::exists(work("out/panorama_img000.jpg")));
    assert_true(json["panoramas"][0]["name"] == "img000_2");
    assert_true(fs::exists(work("out/panorama_img000_2.jpg")));
    assert_now(json_of(unstored()), false, 0, 0);
}

// A folder that cannot be listed is named. Root can list all folders, so another user runs the command.
void test_unlisted_folder(void **) {
    if (is_missing()) return;
    two_panoramas();
    fs::create_directory(work("row/closed"));
    fs::permissions(work("row/closed"), fs::perms::none);
    fs::permissions(work(""), fs::perms::all);
    fs::permissions(in_folder(""), fs::perms::all);
    const Outcome outcome = run_child(unstored(), [] {
        if (geteuid() == 0 && setuid(65534) != 0) _exit(99);
    });
    fs::permissions(work("row/closed"), fs::perms::owner_all);
    if (outcome.code != done) fail_msg("exit code %d: %s", outcome.code, outcome.err.c_str());
    assert_left_out(parsed(outcome.out), "closed", "cannot list the folder");
}

// A foreign file named calibrate.json does not hide a folder.
void test_somebody_elses_summary(void **) {
    if (is_missing()) return;
    two_panoramas();
    fs::create_directory(work("row/sub"));
    for (const char *number : {"0", "1", "2"})
        fs::rename(work(std::string("row/x") + number + ".png"), work(std::string("row/sub/x") + number + ".png"));
    save_text(work("row/sub/calibrate.json"), "{}");
    assert_int_equal(json_of(unstored())["pictures"].size(), 7);
}

// A picture named twice is found once, and the exit code stays the same.
void test_named_twice(void **) {
    if (is_missing()) return;
    fs::create_directory(work("row"));
    save_text(work("row/a.png"), "no picture");
    const Words words = {"calibrate", work("row"), work("row/a.png"), "-o", work("out"), "--no-store"};
    assert_refused(unreadable, words, {"a.png: cannot read"});
    two_panoramas();
    assert_int_equal(json_of(words + Words{"--json"})["found"], 8);
}

// `build` of the folder after calibrate has stored its panoramas: no picture counts twice, and a profile from these
// pictures is not their prior.
void test_sources(void **) {
    if (is_missing()) return;
    two_panoramas();
    const Json json = json_of(calibrated(work("row")));
    assert_true(json["panoramas"][0]["result"]["prior"].is_null());
    assert_int_equal(json["panoramas"][1]["result"]["prior"]["profile"], 1);
    const Json built = json_of({"build", work("row"), "--db", work("p.db"), "--json", "--no-store"});
    assert_true(built["prior"]["profile"].is_null());
    assert_true(contains(built["prior"]["reason"], "already includes these pictures"));
    // Without its first picture it is still the same panorama.
    fs::remove(work("row/img000.png"));
    const Json again = json_of(calibrated(work("row")));
    assert_now(again, true, 1, 3);
    assert_true(contains(again.dump(), "already includes these pictures"));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_edited_project),         CLI_TEST(test_passing_read_error), CLI_TEST(test_odd_names),
        CLI_TEST(test_damaged_copy),           CLI_TEST(test_names_of_its_own),   CLI_TEST(test_unlisted_folder),
        CLI_TEST(test_somebody_elses_summary), CLI_TEST(test_named_twice),        CLI_TEST(test_sources),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
