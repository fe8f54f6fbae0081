// Bad input: the exit code, a message that names the file, no partial files, and an unchanged database.
#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

// A database with one profile, made once and copied; a failing command must not change it.
Bytes database;

int make_all(void **state) {
    if (make_scene(state) != 0) return -1;
    fs::create_directories(work(""));
    must_exit(done, Words{"build", scene("pano.pto"), "--db", work("p.db")} + quick);
    database = load(work("p.db"));
    return 0;
}

int prepare(void **state) {
    empty_work(state);
    save(work("p.db"), database);
    return 0;
}

// A build with every option that writes files.
Words build_of(const std::string &pto) {
    return Words{"build",    pto,
                 "--db",     work("p.db"),
                 "--camera", "X",
                 "--write",  "points=" + work("left.txt"),
                 "--write",  "pto=" + work("left.pto")}
           + quick;
}

void cut(const std::string &path, size_t bytes) {
    Bytes all = load(path);
    assert_true(bytes < all.size());
    all.resize(bytes);
    save(path, all);
}

// Pictures.

void test_missing_picture(void **) {
    for (const char *name : {"img000.png", "img002.tif", "img005.jpg"}) {
        const std::string copy = copy_of("mixed", name);
        fs::remove(copy + "/" + name);
        assert_refused(unreadable, build_of(copy + "/pano.pto"), {copy + "/" + name});
        assert_refused(unreadable, {"apply", "--profile", "1", "--db", work("p.db"), "-o", work(""), copy + "/" + name},
                       {copy + "/" + name});
        assert_refused(unreadable,
                       {"apply", "--profile", "auto", "--db", work("p.db"), "-o", work(""), copy + "/" + name},
                       {copy + "/" + name});
    }
}

void test_truncated_picture(void **) {
    for (const char *name : mixed_names)
        for (double share : {0.0, 0.01, 0.5, 0.95}) {
            const std::string copy = copy_of("mixed"), path = copy + "/" + name;
            cut(path, size_t(share * double(load(path).size())));
            assert_refused(unreadable, build_of(copy + "/pano.pto"), {path});
            assert_refused(
                unreadable,
                {"apply", "--profile", "1", "--key", "processing=jpeg", "--db", work("p.db"), "-o", work(""), path},
                {path});
            fs::remove_all(copy);
        }
}

void test_not_a_picture(void **) {
    const std::string copy = copy_of("scene");
    save_text(copy + "/img001.png", "P6 is something else");
    assert_refused(unreadable, build_of(copy + "/pano.pto"), {copy + "/img001.png"});
    fs::remove(copy + "/img001.png");
    fs::create_directory(copy + "/img001.png");
    assert_refused(unreadable, build_of(copy + "/pano.pto"), {copy + "/img001.png"});
}

void test_picture_of_another_size(void **) {
    const std::string copy = copy_of("scene");
    for (const char *size : {"w640 h480", "w240 h320", "w320 h239"}) {
        save_text(copy + "/pano.pto", text_of(scene("pano.pto")));
        edit(copy + "/pano.pto", "w320 h240( .*img002)", std::string(size) + "$1");
        assert_refused(unreadable, build_of(copy + "/pano.pto"),
                       {copy + "/img002.png", "320 x 240", copy + "/pano.pto"});
    }
}

void test_not_finite_picture(void **) {
    must_exit(done, {"simulate", "-o", work("float"), "--images", "2", "--size", "160x120", "--format", "tiff32"});
    const std::string name = work("float/img001.tif");
    const Picture good = read_picture(name);
    WriteOptions options;
    options.metadata_from = name;
    for (float bad : {NAN, INFINITY, -INFINITY}) {
        Picture picture = good;
        reinterpret_cast<float *>(picture.pixels.data())[(7 * 160 + 12) * 3 + 1] = bad;
        write_picture(name, picture, options);
        assert_refused(unreadable, build_of(work("float/pano.pto")), {name, "12, 7"});
    }
    write_picture(name, good, options);
    must_exit(done, build_of(work("float/pano.pto")));  // the number was the cause
}

void test_no_usable_sample(void **) {
    const std::string copy = copy_of("scene");
    for (uint8_t level : {255, 0}) {
        for (int i = 0; i < 4; ++i) {
            const std::string name = copy + "/img00" + std::to_string(i) + ".png";
            Picture picture = read_picture(name);
            std::fill(picture.pixels.begin(), picture.pixels.end(), level);
            write_picture(name, picture);
        }
        assert_refused(not_usable, build_of(copy + "/pano.pto"), {copy + "/pano.pto"});
    }
}

// Projects.

void test_pictures_apart(void **) {
    const std::string pto = copy_of("scene") + "/pano.pto";
    for (int i = 0; i < 4; ++i)
        edit(pto, " y[-.0-9]+( .*img00" + std::to_string(i) + ")", " y" + std::to_string(90 * i) + "$1");
    assert_refused(not_usable, build_of(pto), {pto, "overlap"});
}

// Two pictures are far from the others and overlap in the project, but not in content.
void test_pictures_in_the_wrong_place(void **) {
    const std::string pto = copy_of("scene") + "/pano.pto";
    edit(pto, " y[-.0-9]+( .*img00[23])", " y180$1");
    const Words words = Words{"build", pto, "--db", work("p.db"), "--write", "pto=" + work("left.pto")} + quick;
    assert_refused(not_usable, words, {pto, "3 groups", "nothing was stored"});
}

void test_one_picture(void **) {
    const std::string pto = copy_of("scene") + "/pano.pto";
    edit(pto, "(i [^\n]*img00[123][^\n]*\n)|(v E[^\n]*\n)", "");
    assert_refused(not_usable, build_of(pto), {pto, "one image"});
}

void test_damaged_projects(void **) {
    const std::string pto = copy_of("scene") + "/pano.pto";
    const struct {
        const char *pattern, *replacement, *named;
    } cases[] = {
        {"Eev1", "Ev1", "\"Ev1\""},
        {"Eev1", "Eev9", "Eev9"},
        {"w320( .*img001)", "w0$1", "line 6"},
        {"v50", "vnan", "line 5"},
        {"v50", "v0", "line 5"},
        {"f0 v50", "f99 v50", "line 5"},
        {"Ra=0( .*img002)", "Ra=8$1", "line 7"},
        {"y-?[.0-9]+( .*img001)", "y1e999$1", "line 6"},
    };
    for (const auto &bad : cases) {
        save_text(pto, text_of(scene("pano.pto")));
        edit(pto, bad.pattern, bad.replacement);
        const Disk before = disk();
        const Words words = build_of(pto);
        assert_refusal(words, run_words(words), unreadable, {pto, bad.named}, before);
    }
}

void test_not_a_project(void **) {
    save_text(work("text.pto"), "hello\n");
    save_text(work("empty.pto"), "");
    save(work("binary.pto"), load(scene("img000.png")));
    fs::create_directory(work("folder.pto"));
    for (const char *name : {"missing.pto", "text.pto", "empty.pto", "binary.pto", "folder.pto"}) {
        const int code = std::strcmp(name, "folder.pto") == 0 ? usage : unreadable;  // a folder without pictures
        assert_refused(code, build_of(work(name)), {work(name)});
        assert_refused(unreadable, {"apply", "--pto", work(name), "-o", work("")}, {work(name)});
    }
}

// Point files.

void test_bad_points(void **) {
    const std::string good = "0 1 10 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n", path = work("points.txt");
    const struct {
        const char *line, *named;
    } cases[] = {
        {"0 1 10 10 20 oops .1 .2 .3 .4 .5 .6 0 .5 .5 0\n", "oops"},
        {"0 1 10 10 20 20 .1 .2 .3 .4 .5\n", "line 3"},
        {"0 1 10 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0 7\n", "line 3"},
        {"0 1 10 10 20 20 nan .2 .3 .4 .5 .6 0 .5 .5 0\n", "line 3"},
        {"0 1 10 10 20 20 1.3 .2 .3 .4 .5 .6 0 .5 .5 0\n", "line 3"},
        {"0 0 10 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n", "line 3"},
        {"0 1.5 10 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n", "line 3"},
        {"-1 1 10 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n", "line 3"},
        {"0 1 inf 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n", "line 3"},
        {"# a comment, not a point\n", "line 3"},
    };
    for (const auto &bad : cases) {
        save_text(path, good + good + bad.line + good);
        assert_refused(unreadable, build_of(scene("pano.pto")) + Words{"--points", path}, {path, bad.named});
    }
    save_text(path, "");
    assert_refused(unreadable, build_of(scene("pano.pto")) + Words{"--points", path}, {path});
    for (const std::string &name : {work("missing.txt"), work("p.db"), scene("")})
        assert_refused(unreadable, build_of(scene("pano.pto")) + Words{"--points", name}, {name});
}

void test_points_of_other_images(void **) {
    const std::string path = work("points.txt");
    save_text(path, "0 1 10 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n0 4 10 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n");
    assert_refused(unreadable, build_of(scene("pano.pto")) + Words{"--points", path}, {path, "4"});
    save_text(path, "0 1 10 10 20 20 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n0 1 10 10 20 9e9 .1 .2 .3 .4 .5 .6 0 .5 .5 0\n");
    assert_refused(unreadable, build_of(scene("pano.pto")) + Words{"--points", path}, {path, "point 2", "img001.png"});
}

// If no fit is possible, --json still prints the object with the reason.
void test_reason_in_json(void **) {
    save_text(work("one.pto"), "i w320 h240 f0 v50 n\"one.png\"\nv Ra0\n");
    const Outcome outcome = run_words({"build", work("one.pto"), "--no-store", "--json"});
    assert_int_equal(outcome.code, not_usable);
    const Json json = parsed(outcome.out);
    assert_true(json["usable"] == false);
    assert_true(contains(text_of(json), "at least two"));
    assert_int_equal(json["response"]["values"][0].size(), 1024);
}

// Outputs that would overwrite an input, the database or each other.
void test_outputs_that_meet(void **) {
    const std::string copy = copy_of("scene"), pto = copy + "/pano.pto", db = work("p.db");
    const Words build = Words{"build", pto, "--db", db, "--camera", "X"} + quick;
    assert_refused(usage, build + Words{"--write", std::string("pto=") + pto}, {pto});
    assert_refused(usage, build + Words{"--write", std::string("pto=") + db}, {db});
    assert_refused(usage, build + Words{"--write", std::string("points=") + copy + "/img001.png"}, {"img001.png"});
    assert_refused(usage, build + Words{"--write", "points=" + work("same"), "--write", "pto=" + work("same")},
                   {"same"});
}

// Bytes that are not UTF-8 in names and options: stored as question marks, printed as U+FFFD.
void test_text_that_is_not_utf8(void **) {
    const Json json = json_of({"build", scene("pano.pto"), "--db", work("p.db"), "--camera", "X\xe9", "--json", "--fit",
                               "pairs=600,modes=3"});
    assert_true(json["profile"].is_number());
    const Json list = json_of({"profile", "list", "--db", work("p.db"), "--json"});
    assert_true(contains(list.dump(), "X?"));
}

// A project not written by build contains no result to apply.
void test_apply_without_a_result(void **) {
    assert_refused(usage, {"apply", "--pto", scene("pano.pto"), "-o", work("corrected")}, {"pano.pto", "--write pto"});
    assert_refused(usage,
                   {"apply", "--profile", "1", "--db", work("p.db"), "--set", "exposure=mean", "-o", work("corrected"),
                    scene("img000.png")},
                   {"--pto"});
}

// Invalid truth files.

void test_bad_truth(void **) {
    const Words words = build_of(scene("pano.pto")) + Words{"--fit", "truth=" + work("truth.json")};
    assert_refused(unreadable, words, {work("truth.json")});
    assert_refused(usage, words + Words{"--json"}, {"--fit truth", "--json"});
    for (const char *text : {"{", "hello"}) {
        save_text(work("truth.json"), text);
        assert_refused(unreadable, words, {work("truth.json")});
    }
    // Valid JSON with unexpected content. In a child process, because it might crash; nothing may be stored by then.
    for (const char *text : {"[]", "3", "{\"images\":[]}", "{\"images\":[{},{},{},{}]}",
                             "{\"images\":[{\"ev\":0},{\"ev\":0},{\"ev\":0},{\"ev\":0}]}",
                             "{\"images\":[{\"ev\":\"x\"},{\"ev\":0},{\"ev\":0},{\"ev\":0}],\"vignetting\":{\"k\":[[0,"
                             "0,0]],\"center\":[0,0]}}"}) {
        save_text(work("truth.json"), text);
        const Disk before = disk();
        const Outcome outcome = run_child(words);
        assert_refusal(words, outcome, outcome.code == usage ? usage : unreadable, {work("truth.json")}, before);
    }
}

// Databases.

void test_corrupt_database(void **) {
    fs::create_directory(work("folder.db"));
    save_text(work("text.db"), std::string(300, 'x') + "\n");
    for (size_t bytes : {50u, 100u, 4096u, 20000u})
        save(work("cut" + std::to_string(bytes) + ".db"), Bytes(database.begin(), database.begin() + long(bytes)));
    for (const char *name :
         {"folder.db", "text.db", "cut50.db", "cut100.db", "cut4096.db", "cut20000.db", "p.db/inside.db"}) {
        const std::string path = work(name);
        const Words db = {"--db", path};
        assert_refused(store_failed, Words{"query", "--camera", "x"} + db, {path});
        assert_refused(store_failed, Words{"profile", "list"} + db, {path});
        assert_refused(store_failed, Words{"profile", "show", "1"} + db, {path});
        assert_refused(store_failed, Words{"profile", "remove", "1"} + db, {path});
        assert_refused(store_failed, Words{"apply", "--profile", "1", "-o", work(""), scene("img000.png")} + db,
                       {path});
        assert_refused(store_failed, Words{"build", scene("pano.pto")} + quick + db, {path});
    }
}

// Other requested outputs are not written either.
void test_corrupt_database_leaves_no_output(void **) {
    save_text(work("p.db"), std::string(300, 'x') + "\n");
    assert_refused(store_failed, build_of(scene("pano.pto")), {work("p.db")});
}

void test_no_database(void **) {
    const Words db = {"--db", work("none.db")};
    assert_refused(not_found, Words{"query", "--camera", "x"} + db, {work("none.db")});
    assert_refused(not_found, Words{"profile", "list"} + db, {work("none.db")});
    assert_refused(not_found, Words{"profile", "remove", "1"} + db, {work("none.db")});
    assert_refused(usage, {"apply", "--profile", "auto", "-o", work(""), scene("img000.png"), "--db", ""},
                   {"--db", "empty file name"});
    assert_refused(not_found, Words{"apply", "--profile", "auto", "-o", work(""), scene("img000.png")} + db,
                   {work("none.db")});
}

void test_no_such_profile(void **) {
    const Words db = {"--db", work("p.db")};
    assert_refused(not_found, Words{"profile", "show", "7"} + db, {work("p.db"), "7"});
    assert_refused(not_found, Words{"profile", "remove", "7"} + db, {work("p.db"), "7"});
    assert_refused(not_found, Words{"apply", "--profile", "7", "-o", work(""), scene("img000.png")} + db,
                   {work("p.db"), "7"});
    assert_refused(not_found, Words{"query", "--camera", "Other Camera"} + db, {work("p.db"), "Other Camera"});
    write_picture(work("bare.png"), make_smooth(40, 30, LENSPROF_LAYOUT_RGB));
    assert_refused(not_found,
                   Words{"apply", "--profile", "auto", "-o", in_folder("work/out/../.."), work("bare.png")} + db,
                   {work("bare.png")});
}

// Outputs.

void test_output_is_a_file(void **) {
    save_text(work("file"), "mine");
    for (const std::string &out : {work("file"), work("file/below")}) {
        assert_refused(usage, {"apply", "--profile", "1", "--db", work("p.db"), "-o", out, scene("img000.png")}, {out});
        assert_refused(usage, {"simulate", "--images", "2", "--size", "40x30", "-o", out}, {out});
    }
    const Words build = Words{"build", scene("pano.pto"), "--no-store"} + quick;
    for (const char *key : {"pto=", "points="})
        for (const std::string &out : {work(""), work("file/x"), work("no such folder/x")})
            assert_refused(out == work("") ? usage : failed, build + Words{"--write", key + out}, {out});
}

void test_output_would_replace_input(void **) {
    const std::string copy = copy_of("scene");
    const Words apply = {"apply", "--profile", "1", "--db", work("p.db"), "-o"};
    fs::create_symlink(copy, work("link"));
    for (const std::string &out : {copy, copy + "/", copy + "/../copy", work("link")})
        assert_refused(usage, apply + Words{out, copy + "/img000.png"}, {copy + "/img000.png"});
    assert_refused(usage, {"apply", "--pto", copy + "/pano.pto", "-o", copy}, {copy + "/img000.png"});
    fs::remove(work("link"));  // the listing would follow it
}

void test_contact_sheet_would_replace_input(void **) {
    const std::string copy = copy_of("scene"), input = copy + "/img001.png";
    const Words words = {"apply",  "--profile",       "1",   "--db", work("p.db"), "-o",
                         work(""), "--contact-sheet", input, input};
    const Disk before = disk();
    const Outcome outcome = run_words(words);
    assert_true(load(input) == before.at("work/copy/img001.png"));  // the user's picture
    assert_refusal(words, outcome, usage, {input}, before);
}

void test_names_that_meet(void **) {
    const std::string a = copy_of("scene", "a"), b = copy_of("scene", "b");
    const Words apply = {"apply", "--profile", "1", "--db", work("p.db"), "-o", work("")};
    assert_refused(usage, apply + Words{a + "/img000.png", b + "/img000.png"}, {"img000.png"});
    fs::copy(mixed("img002.tif"), a + "/img000.tif");
    assert_refused(usage, apply + Words{"--linear", a + "/img000.png", a + "/img000.tif"}, {"img000.tif"});
}

void test_picture_of_no_project(void **) {
    assert_refused(usage, {"apply", "--pto", scene("pano.pto"), "-o", work(""), mixed("img000.png")},
                   {mixed("img000.png"), scene("pano.pto")});
}

// A later picture fails: earlier ones are complete, and no other files exist.
void test_later_picture_fails(void **) {
    const std::string copy = copy_of("scene");
    cut(copy + "/img002.png", 50000);
    const Outcome outcome = run_words({"apply", "--profile", "1", "--db", work("p.db"), "-o", work("out"),
                                       copy + "/img000.png", copy + "/img002.png", copy + "/img003.png"});
    assert_int_equal(outcome.code, unreadable);
    assert_true(contains(outcome.err, copy + "/img002.png"));
    for (const fs::directory_entry &entry : fs::directory_iterator(work("out")))
        assert_int_equal(read_picture(entry.path().string()).width, 320);
}

}  // namespace

#define FAULT_TEST(name) cmocka_unit_test_setup(name, prepare)

int main() {
    const CMUnitTest tests[] = {
        FAULT_TEST(test_missing_picture),
        FAULT_TEST(test_truncated_picture),
        FAULT_TEST(test_not_a_picture),
        FAULT_TEST(test_picture_of_another_size),
        FAULT_TEST(test_not_finite_picture),
        FAULT_TEST(test_no_usable_sample),
        FAULT_TEST(test_pictures_apart),
        FAULT_TEST(test_pictures_in_the_wrong_place),
        FAULT_TEST(test_one_picture),
        FAULT_TEST(test_damaged_projects),
        FAULT_TEST(test_not_a_project),
        FAULT_TEST(test_bad_points),
        FAULT_TEST(test_points_of_other_images),
        FAULT_TEST(test_reason_in_json),
        FAULT_TEST(test_apply_without_a_result),
        FAULT_TEST(test_outputs_that_meet),
        FAULT_TEST(test_text_that_is_not_utf8),
        FAULT_TEST(test_bad_truth),
        FAULT_TEST(test_corrupt_database),
        FAULT_TEST(test_corrupt_database_leaves_no_output),
        FAULT_TEST(test_no_database),
        FAULT_TEST(test_no_such_profile),
        FAULT_TEST(test_output_is_a_file),
        FAULT_TEST(test_output_would_replace_input),
        FAULT_TEST(test_contact_sheet_would_replace_input),
        FAULT_TEST(test_names_that_meet),
        FAULT_TEST(test_picture_of_no_project),
        FAULT_TEST(test_later_picture_fails),
    };
    return cmocka_run_group_tests(tests, make_all, remove_folder);
}
