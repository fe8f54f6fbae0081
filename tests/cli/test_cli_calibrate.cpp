// `calibrate`: the whole job, its second run, existing files that block outputs, and bad input.
#include "calibrate_runs.hpp"
#include "photo/folder/ledger.hpp"
#include "photo/pictures/picture.hpp"

using namespace calibrate_runs;

namespace {

// Two panoramas, an unrelated picture in a subfolder, a copy and a damaged file.
std::string make_folder_of_many() {
    simulate("many", {"--images", "4", "--seed", "21"});
    simulate("three", {"--images", "3", "--seed", "22"});
    simulate("single", {"--images", "2", "--seed", "23"});
    for (const char *number : {"0", "1", "2"})
        fs::copy_file(work(std::string("three/img00") + number + ".png"),
                      work(std::string("many/x") + number + ".png"));
    fs::create_directory(work("many/sub"));
    fs::copy_file(work("single/img000.png"), work("many/sub/y.png"));
    fs::copy_file(work("many/img001.png"), work("many/z_copy.png"));
    save_text(work("many/bad.png"), text_of(work("many/img002.png")).substr(0, 5000));
    return work("many");
}

using Stamps = std::map<std::string, std::string>;

Stamps stamps() {
    Stamps all;
    for (const fs::directory_entry &entry : fs::recursive_directory_iterator(work("out")))
        all[entry.path().string()] = stamp_of(entry.path().string());
    return all;
}

// The first run does everything, the second nothing; only lost files are written again.
void test_a_folder_of_many_things(void **) {
    if (is_missing()) return;
    const std::string many = make_folder_of_many();
    const Disk originals = disk();
    const Json json = json_of(calibrated(many));
    for (const auto &[name, bytes] : originals)
        assert_true(fs::is_directory(in_folder(name)) || load(in_folder(name)) == bytes);
    assert_now(json, true, 2, 8);
    assert_int_equal(json["panoramas"].size(), 2);
    assert_int_equal(json["panoramas"][0]["pictures"], 4);
    assert_int_equal(json["panoramas"][1]["pictures"], 3);
    for (const Json &panorama : json["panoramas"]) {
        assert_true(panorama["result"]["usable"] == true && panorama["result"]["profile"].is_number());
        assert_true(read_picture(panorama["preview"].get<std::string>()).width > 1000);
    }
    assert_int_equal(json["left_out"].size(), 2);
    assert_true(contains(json["left_out"][0]["reason"], "bad.png"));
    assert_true(contains(json["left_out"][1]["reason"], "a copy of img001.png"));
    assert_true(fs::exists(work("out/sub/y.png")) && fs::exists(work("out/calibrate_sheet.jpg")));
    assert_true(json["pictures"][4]["panorama"].is_null());  // sub/y.png, with the profile of the panoramas

    const Stamps before = stamps();
    assert_now(json_of(calibrated(many)), false, 0, 0);
    assert_true(stamps() == before);
    fs::remove(work("out/img002.png"));
    fs::remove(json["panoramas"][0]["project"].get<std::string>());
    assert_now(json_of(calibrated(many)), false, 0, 1);
    assert_true(fs::exists(work("out/img002.png")));
    assert_int_equal(json_of({"profile", "list", "--db", work("p.db"), "--json"})["profiles"].size(), 2);
}

// The same numbers as `build` of the same pictures, and the same pixels as `apply` of its exposures: a project holds
// fewer modes.
void test_as_build_and_apply(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "5", "--seed", "11"});
    const Json built =
        json_of({"build", work("row"), "--db", work("b.db"), "--json", "--write", "exposures=" + work("e.json")});
    const Json json = json_of(calibrated(work("row")));
    const Json &result = json["panoramas"][0]["result"];
    assert_true(result["vignetting"] == built["vignetting"]);
    assert_true(result["images"] == built["images"]);
    assert_true(result["response"] == built["response"]);
    must_exit(done, {"apply", "--model", work("e.json"), "-o", work("even")});
    for (const char *name : {"img000.png", "img001.png", "img002.png", "img003.png", "img004.png"})
        assert_true(read_picture(work(std::string("even/") + name)).pixels
                    == read_picture(work(std::string("out/") + name)).pixels);
    assert_now(json_of(calibrated(work("row"), {"--threads", "1"})), false, 0, 0);
}

// If a picture is added, only its panorama is processed again; the output folder may be inside the input folder.
void test_new_pictures(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    simulate("three", {"--images", "3", "--seed", "22"});
    const Words words = {"calibrate", work("row"), "-o", work("row/out"), "--no-store", "--json"};
    assert_now(json_of(words), true, 1, 4);
    for (const char *number : {"0", "1", "2"})
        fs::copy_file(work(std::string("three/img00") + number + ".png"), work(std::string("row/x") + number + ".png"));
    const Json json = json_of(words);
    assert_now(json, true, 1, 3);
    assert_int_equal(json["found"], 7);
    assert_true(json["panoramas"][0]["not_stored"] == "--no-store");
    // With another output folder, the first one's files are not taken for pictures.
    const Json other = json_of({"calibrate", work("row"), "-o", work("row/other"), "--no-store", "--json"});
    assert_int_equal(other["found"], 7);
}

// Files of others are never replaced; this is reported before anything is computed.
void test_what_stands_in_the_way(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    fs::create_directory(work("out"));
    save_text(work("out/img001.png"), "mine");
    assert_refused(usage, calibrated(work("row")), {"out/img001.png", "--overwrite"});
    assert_now(json_of(calibrated(work("row"), {"--overwrite"})), true, 1, 4);
    // An edited file is kept while its correction is unchanged, and blocks the output when it changes.
    save_text(work("out/img002.png"), "edited");
    assert_now(json_of(calibrated(work("row"))), false, 0, 0);
    assert_true(text_of(work("out/img002.png")) == "edited");
    fs::last_write_time(work("row/img002.png"), fs::file_time_type::clock::now());
    const Outcome refused = run_words(calibrated(work("row")));
    assert_int_equal(refused.code, usage);
    assert_true(contains(refused.err, "out/img002.png") && text_of(work("out/img002.png")) == "edited");
    assert_refused(usage, {"calibrate", work("row"), "-o", work("row")}, {"is the folder of the pictures"});
}

void test_bad_input(void **) {
    if (is_missing()) return;
    fs::create_directory(work("bad"));
    save_text(work("bad/a.jpg"), "no picture");
    save_text(work("bad/b.png"), "nor is this");
    assert_refused(unreadable, calibrated(work("bad")), {"none of the pictures can be read"});
    simulate("one", {"--images", "2", "--seed", "3"});
    fs::remove(work("one/img001.png"));
    const Json json = json_of({"calibrate", work("one"), "-o", work("out"), "--no-store", "--json"}, not_usable);
    assert_int_equal(json["left_out"].size(), 1);
    assert_true(contains(json["left_out"][0]["reason"], "no overlap with another picture found"));
    // Of a refused panorama, the refusal is stated, also if nothing was to be stored.
    simulate("mapped", {"--images", "4", "--seed", "21", "--set", "local-tone=2"});
    const Json mapped = parsed(
        run_words({"calibrate", work("mapped"), "-o", work("copies"), "--no-store", "--json"}).out)["panoramas"][0];
    assert_false(mapped["result"]["usable"].get<bool>());
    assert_true(mapped["not_stored"] == mapped["result"]["findings"][0]["text"]);
    save_text(work("notes.txt"), "x");
    assert_refused(usage, calibrated(work("notes.txt")), {"notes.txt"});
    assert_refused(usage, {"calibrate", work("one")}, {"-o"});
}

// Ten lines of output, for any number of pictures.
void test_ten_lines(void **) {
    if (is_missing()) return;
    const std::string text =
        must_exit(done, {"calibrate", make_folder_of_many(), "-o", work("out"), "--db", work("p.db")});
    assert_true(std::count(text.begin(), text.end(), '\n') <= 10);
    assert_true(contains(text, "profile 1 stored") && contains(text, "left out  2 pictures"));
}

// Ctrl-C in a separate process: finished files stay, no partial file is left, and the next run continues.
void test_interrupted(void **) {
    if (is_missing()) return;
    const std::string many = make_folder_of_many();
    for (const int milliseconds : {30, 300, 700, 1100, 1500, 2000}) {
        const pid_t child = fork();
        if (child == 0) {
            const std::string out = work("out"), db = work("p.db");
            execl(LENSPROF_PROGRAM, "lensprof", "calibrate", many.c_str(), "-o", out.c_str(), "--db", db.c_str(),
                  "--json", static_cast<char *>(nullptr));
            _exit(127);
        }
        usleep(static_cast<useconds_t>(milliseconds) * 1000);
        kill(child, SIGINT);
        int status = 0;
        assert_int_equal(waitpid(child, &status, 0), child);
        const bool ended = WIFEXITED(status) && (WEXITSTATUS(status) == stopped || WEXITSTATUS(status) == done);
        assert_true(ended || (WIFSIGNALED(status) && WTERMSIG(status) == SIGINT));  // before the handler was installed
        if (fs::exists(work("out")))
            for (const fs::directory_entry &entry : fs::directory_iterator(work("out")))
                assert_false(entry.path().filename().string().rfind(".lensprof-", 0) == 0
                             && entry.path().filename() != ".lensprof-calibrate.json");
    }
    const Json json = json_of(calibrated(many));
    assert_int_equal(json["pictures"].size(), 8);
    assert_int_equal(json_of({"profile", "list", "--db", work("p.db"), "--json"})["profiles"].size(), 2);
    assert_now(json_of(calibrated(many)), false, 0, 0);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_a_folder_of_many_things),
        CLI_TEST(test_as_build_and_apply),
        CLI_TEST(test_new_pictures),
        CLI_TEST(test_what_stands_in_the_way),
        CLI_TEST(test_bad_input),
        CLI_TEST(test_ten_lines),
        CLI_TEST(test_interrupted),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
