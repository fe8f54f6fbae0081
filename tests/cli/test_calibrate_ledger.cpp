// Which files `calibrate` recognises as its own: records, locks, and existing files that block outputs.
#include "calibrate_runs.hpp"
#include "cli/calibrate/summary.hpp"
#include "photo/folder/ledger.hpp"

#include <sys/file.h>

using namespace calibrate_runs;

namespace {

constexpr const char *record = ".lensprof-calibrate.json";

void write_by_program(const std::string &file, const std::string &text) { write_file(file, text.data(), text.size()); }

// After a run that ends between begin() and finish(), the next run recognises its files; files written by others are
// not recognised.
void test_ended_within(void **) {
    const std::string file = work("a.png"), other = work("b.png");
    {
        Ledger ledger(work(""));
        ledger.begin(file, "1");
        ledger.begin(other, "1");
        ledger.save();
        write_by_program(file, "written");
        assert_true(ledger.is_written(file) && !ledger.is_written(other));
    }
    save_text(other, "by somebody else");
    Ledger ledger(work(""));
    assert_true(ledger.is_current(file, "1") && !ledger.is_current(file, "2"));
    assert_false(ledger.is_foreign(file));
    assert_true(ledger.is_foreign(other) && !ledger.is_current(other, "1"));
    ledger.save();
    save_text(file, "edited, and longer");
    Ledger again(work(""));
    assert_true(again.is_foreign(file));
    assert_failure(LENSPROF_ERROR_ARGUMENT, "a.png: was modified after", [&] { again.begin(file, "2"); });
    assert_failure(LENSPROF_ERROR_ARGUMENT, "b.png: exists and was not written by calibrate",
                   [&] { again.begin(other, "2"); });
    again.remove(file);
    assert_true(text_of(file) == "edited, and longer");
}

// If a run ends before it replaces a file, its own older file stays its own; a file of others does not become its own,
// even with --overwrite.
void test_begun_and_not_written(void **) {
    const std::string own = work("own.png"), other = work("other.png");
    save_text(other, "by somebody else");
    {
        Ledger ledger(work(""), true);
        ledger.begin(own, "1");
        ledger.save();
        write_by_program(own, "first");
        ledger.finish(own);
        ledger.begin(own, "2");
        ledger.begin(other, "2");
        ledger.save();
    }
    const Ledger ledger(work(""));
    assert_true(ledger.is_current(own, "1") && !ledger.is_foreign(own));
    assert_true(ledger.is_foreign(other));
}

void test_names(void **) {
    const std::string odd = "a %\xff\n\"b";
    assert_true(path_of_ascii(ascii_path(odd)) == odd);
    const std::string file = work("sub") + "/" + odd;
    fs::create_directory(work("sub"));
    {
        Ledger ledger(work(""));
        ledger.begin(file, "1");
        ledger.save();
        write_by_program(file, "x");
    }
    const fs::path here = fs::current_path();
    fs::current_path(work(""));
    for (const char *folder : {".", "./", "sub/.."}) {
        const Ledger ledger(folder);
        assert_true(ledger.is_current(std::string(folder) + "/sub/" + odd, "1") && ledger.is_current(file, "1"));
    }
    fs::current_path(here);
}

// Damage anywhere: the notes or records are lost; no file of others is taken for its own.
void test_damaged_records(void **) {
    const std::string file = work("a.png");
    {
        Ledger ledger(work(""));
        ledger.notes = {{"groups", {{{"files", {1, 2}}}}}};
        ledger.begin(file, "1");
        ledger.save();
        write_by_program(file, "x");
        ledger.finish(file);
        ledger.save();
    }
    const Json whole = parsed(text_of(work(record)));
    assert_true(Ledger(work("")).notes == whole["notes"] && has_ledger(work("")));
    const auto with = [&](const std::string &pointer, const Json &value) {
        Json changed = whole;
        changed[Json::json_pointer(pointer)] = value;
        save_text(work(record), changed.dump() + "\n");
        return Ledger(work("")).notes.is_null();
    };
    assert_true(with("/notes/groups/0/files", Json()) && with("/notes", 7) && with("/digest", Json()));
    assert_false(Ledger(work("")).is_foreign(file));
    for (const char *part : {"/files", "/files/a.png", "/files/a.png/of", "/files/a.png/stamp", "/schema"}) {
        for (const Json &value : {Json(), Json(7), Json::array({1})}) {
            with(part, value);
            (void)Ledger(work("")).is_foreign(file);
        }
        assert_true(with(part, 7) || Ledger(work("")).is_foreign(file));
    }
    save_text(work(record), "{damaged");
    assert_true(Ledger(work("")).is_foreign(file) && !has_ledger(work("")));
}

// Edited files of every kind are kept, and named if their content would change.
void test_edited_files(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    const std::string project = json_of(calibrated(work("row")))["panoramas"][0]["project"];
    const std::string mosaic = replaced(project, "\\.pto", ".jpg");
    const auto touch = [&](const char *name) {
        fs::last_write_time(work(std::string("row/") + name), fs::file_time_type::clock::now());
    };
    for (const std::string &file : {mosaic, work("out/calibrate_sheet.jpg"), work("out/calibrate.json"), project}) {
        save_text(file, "edited");
        if (file == mosaic)
            edit(project, "Eev0 ", "Eev0.01 ");
        else if (contains(file, ".json"))
            save_text(work("row/bad.png"), "no picture");
        else
            touch("img002.png");
        const Outcome refused = run_words(calibrated(work("row")));
        if (refused.code != usage || !contains(refused.err, file + ": was modified after"))
            fail_msg("%s: exit code %d: %s", file.c_str(), refused.code, refused.err.c_str());
        assert_true(text_of(file) == "edited");
        json_of(calibrated(work("row"), {"--overwrite"}));
        assert_true(text_of(file) != "edited");
        touch("img001.png");
        json_of(calibrated(work("row"), {"--overwrite"}));
    }
}

// Edited files of panoramas that no longer exist are kept.
void test_forgotten(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    simulate("three", {"--images", "3", "--seed", "22"});
    for (const char *number : {"0", "1", "2"})
        fs::copy_file(work(std::string("three/img00") + number + ".png"), work(std::string("row/x") + number + ".png"));
    json_of(calibrated(work("row")));
    edit(work("out/panorama_x0.pto"), "Eev0 ", "Eev0.01 ");
    for (const char *name : {"x0", "x1", "x2"}) fs::remove(work(std::string("row/") + name + ".png"));
    json_of(calibrated(work("row")));
    assert_true(fs::exists(work("out/panorama_x0.pto")) && !fs::exists(work("out/panorama_x0.jpg")));
}

// A link in the output folder is replaced; its target is not written to.
void test_links(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    save_text(work("outside.png"), "outside");
    fs::create_directory(work("out"));
    fs::create_symlink(work("outside.png"), work("out/img001.png"));
    assert_refused(usage, calibrated(work("row")), {"out/img001.png", "--overwrite"});
    json_of(calibrated(work("row"), {"--overwrite"}));
    assert_true(text_of(work("outside.png")) == "outside" && !fs::is_symlink(work("out/img001.png")));
}

// If two run simultaneously, the second one is refused. The lock is released with its process.
void test_two_at_once(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "2", "--seed", "21"});
    fs::create_directory(work("out"));
    const int other = open(work("out").c_str(), O_RDONLY | O_DIRECTORY);
    assert_true(other >= 0 && flock(other, LOCK_EX | LOCK_NB) == 0);
    assert_refused(failed, calibrated(work("row")), {"another calibrate is using this folder", "out"});
    close(other);
    run_words(calibrated(work("row")));
    assert_true(fs::exists(work("out/calibrate.json")));
}

// All spellings of a path mean the same folder.
void test_spellings_of_the_folder(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    const fs::path here = fs::current_path();
    fs::current_path(work(""));
    const auto run_in = [](const std::string &input, const std::string &output) {
        return json_of({"calibrate", input, "-o", output, "--no-store", "--json"});
    };
    assert_now(run_in("row", "out"), true, 1, 4);
    for (const std::string &output :
         {std::string("./out"), std::string("out/"), work("out"), std::string("row/../out")})
        assert_now(run_in("row", output), false, 0, 0);
    const Json json = run_in("./row", "./out");
    assert_now(json, false, 0, 0);
    assert_true(json["panoramas"][0]["project"] == "./out/panorama_img000.pto");
    fs::current_path(here);
}

// Edited records: the job is done again or refused, with the program's own messages.
void test_edited_records(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    json_of(calibrated(work("row")));
    const Json whole = parsed(text_of(work(std::string("out/") + record)));
    for (const char *pointer :
         {"/notes/registration/groups/0/files", "/notes/registration/groups", "/notes/registration", "/notes/results",
          "/notes/results/img000/summary/result/vignetting", "/notes/results/img000/project", "/files", "/notes"}) {
        Json changed = whole;
        changed[Json::json_pointer(pointer)] = Json();
        save_text(work(std::string("out/") + record), changed.dump() + "\n");
        const Outcome outcome = run_words(calibrated(work("row")));
        if ((outcome.code != done && outcome.code != usage) || contains(outcome.err, "[json"))
            fail_msg("%s: exit code %d: %s", pointer, outcome.code, outcome.err.c_str());
    }
}

// Temporary files of a killed run are removed; those of a running process are kept.
void test_left_over(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "2", "--seed", "21"});
    run_words(calibrated(work("row")));
    const pid_t child = fork();
    if (child == 0) _exit(0);
    waitpid(child, nullptr, 0);
    const std::string start = work("out/.lensprof-"), dead = start + std::to_string(child) + "-1.png",
                      alive = start + std::to_string(getpid()) + "-999999.png", other = start + "notes-1.png";
    for (const std::string &file : {dead, alive, other}) save_text(file, "x");
    run_words(calibrated(work("row")));
    assert_true(!fs::exists(dead) && fs::exists(alive) && fs::exists(other));
}

// The database may be in the output folder, even before the folder exists.
void test_database_inside(void **) {
    if (is_missing()) return;
    simulate("row", {"--images", "4", "--seed", "21"});
    json_of({"calibrate", work("row"), "-o", work("out"), "--db", work("out/p.db"), "--json"});
    assert_true(fs::exists(work("out/p.db")));
    assert_refused(store_failed, {"calibrate", work("row"), "-o", work("new"), "--db", work("none/p.db")}, {"p.db"});
}

// Long reasons end with what to do: the summary shows them whole, in lines that fit a terminal.
void test_reasons_are_whole(void **) {
    std::string reason = "img0.png: ";
    for (int i = 0; i < 60; i++) reason += "because" + std::to_string(i) + (i == 50 ? "; " : " ");
    reason += "use this";
    FolderOptions o;
    o.output = "out";
    Inputs inputs;
    inputs.left_out.push_back({"img0.png", reason});
    Panoramas panoramas;
    panoramas.list.emplace_back();
    panoramas.list[0].name = "img0";
    panoramas.list[0].summary = {{"result", nullptr}, {"not_stored", reason}};
    std::ostringstream out;
    print_summary(o, inputs, panoramas, {}, out);
    std::istringstream lines(out.str());
    std::string whole;
    for (std::string line; std::getline(lines, line); whole += line.substr(line.find_first_not_of(' ')) + " ")
        if (line.size() > 100) fail_msg("%zu characters: %s", line.size(), line.c_str());
    assert_true(contains(whole, "img0 (0 pictures): not fitted: " + reason));
    assert_true(contains(whole, "left out  1 picture " + reason));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_ended_within),
        CLI_TEST(test_begun_and_not_written),
        CLI_TEST(test_names),
        CLI_TEST(test_damaged_records),
        CLI_TEST(test_edited_files),
        CLI_TEST(test_forgotten),
        CLI_TEST(test_links),
        CLI_TEST(test_two_at_once),
        CLI_TEST(test_spellings_of_the_folder),
        CLI_TEST(test_edited_records),
        CLI_TEST(test_left_over),
        CLI_TEST(test_database_inside),
        CLI_TEST(test_reasons_are_whole),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
