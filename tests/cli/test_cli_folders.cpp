// Many pictures, some of which must not be corrected: subfolders, pictures without a profile, already corrected
// pictures, and existing outputs.
#include "batch_runs.hpp"

using namespace batch_runs;

namespace {

// A picture with the lens that `lens_database` knows, or another lens.
std::string make_picture(const std::string &name, const char *lens, uint32_t side = 60) {
    const std::string file = work(name);
    fs::create_directories(fs::path(file).parent_path());
    const Picture picture = make_smooth(side, 40, LENSPROF_LAYOUT_RGB);
    PictureMetadata metadata = unknown_metadata();
    std::strcpy(metadata.key.camera_model, "Camera");
    std::strcpy(metadata.key.lens, lens);
    WriteOptions options;
    options.metadata = &metadata;
    write_picture(file, picture, options);
    return file;
}

std::string lens_database() {
    auto profile = make_profile_of_lens();
    profile->key.processing = LENSPROF_PROCESSING_JPEG;
    std::strcpy(profile->key.camera_model, "Camera");
    std::strcpy(profile->key.lens, "Good 35mm");
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("lens.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    assert_ok(lensprof_store_put(store, profile.get(), nullptr, nullptr));
    lensprof_store_close(store);
    return work("lens.db");
}

Words by_exif(const std::string &out) {
    return {"apply", "--profile", "auto", "--db", work("lens.db"), "-o", work(out)};
}

// Files below a folder, without hidden ones.
Words files_below(const std::string &place) {
    Words names;
    if (fs::exists(place))
        for (const fs::directory_entry &entry : fs::recursive_directory_iterator(place))
            if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(place).string());
    std::sort(names.begin(), names.end());
    return names;
}

void assert_files(const std::string &place, const Words &wanted) {
    const Words found = files_below(place);
    if (found != wanted) fail_msg("%s: %s", place.c_str(), joined(found).c_str());
}

// Folders.

void test_subfolders_are_kept(void **) {
    for (const char *name : {"in/b.jpg", "in/a/z.jpg", "in/a/deep/y.png", "in/c/b.jpg", "in/.hidden/x.jpg"})
        make_picture(name, "Good 35mm");
    save_text(work("in/a/notes.txt"), "rain");
    const Words wanted = {"a/deep/y.png", "a/z.jpg", "b.jpg", "c/b.jpg"};
    const Json json = json_of(corrected_into("out", {"--json", work("in")}));
    assert_int_equal(json["pictures"].size(), 4);
    assert_int_equal(json["left_out"].size(), 0);
    for (size_t i = 0; i < 4; i++)
        assert_string_equal(json["pictures"][i]["output"].get<std::string>().c_str(), work("out/" + wanted[i]).c_str());
    assert_files(work("out"), wanted);
}

// A folder reached through several links is entered once, under its own name if it has one there.
void test_links_do_not_loop(void **) {
    make_picture("in/a/x.jpg", "Good 35mm");
    make_picture("elsewhere/y.jpg", "Good 35mm");
    fs::create_directory_symlink("..", work("in/a/above"));
    fs::create_directory_symlink(work("in"), work("in/0_self"));
    fs::create_directory_symlink("a", work("in/0_a"));
    fs::create_directory_symlink(work("elsewhere"), work("in/linked"));
    must_exit(done, corrected_into("out", {work("in")}));
    assert_files(work("out"), {"a/x.jpg", "linked/y.jpg"});
}

// Outputs in a subfolder of the pictures are not inputs of the next call.
void test_outputs_within_the_folder(void **) {
    make_picture("in/x.jpg", "Good 35mm");
    for (int i = 0; i < 2; i++) must_exit(done, corrected_into("in/out", {work("in")}));
    assert_files(work("in"), {"out/x.jpg", "x.jpg"});
    assert_refused(usage, corrected_into("in", {work("in")}), {"x.jpg: would be overwritten by its correction"});
}

// Pictures without a profile.

void test_folder_goes_on(void **) {
    lens_database();
    make_picture("in/a.jpg", "Good 35mm");
    make_picture("in/b.jpg", "Other 24mm");
    make_picture("in/sub/c.png", "Other 24mm");
    make_picture("in/sub/d.png", "Good 35mm");
    const Outcome outcome = run_words(by_exif("out") + Words{work("in")});
    assert_int_equal(outcome.code, not_found);
    assert_files(work("out"), {"a.jpg", "sub/d.png"});
    assert_string_equal(outcome.out.c_str(), (work("out/a.jpg") + "\n" + work("out/sub/d.png") + "\n").c_str());
    assert_true(contains(outcome.err, "lensprof: 2 of 4 pictures left out:\n"));
    for (const char *file : {"in/b.jpg", "in/sub/c.png"})
        assert_true(contains(outcome.err, work(file) + ": no profile for Camera, Other 24mm"));
    const Json json = json_of(by_exif("json") + Words{"--json", work("in")}, not_found);
    assert_int_equal(json["pictures"].size(), 2);
    assert_int_equal(json["left_out"].size(), 2);
    assert_string_equal(json["left_out"][0]["file"].get<std::string>().c_str(), work("in/b.jpg").c_str());
    assert_true(contains(json["left_out"][0]["reason"].get<std::string>(), "no profile for"));
    assert_false(json["left_out"][0]["corrected_already"].get<bool>());
}

void test_nearest_names(void **) {
    lens_database();
    make_picture("in/a.jpg", "Good 35mm II");
    assert_refused(not_found, by_exif("out") + Words{work("in/a.jpg")},
                   {"Good 35mm II", "; nearest names: Good 35mm); "});
}

void test_help_tells_of_refused_pictures(void **) {
    const std::string help = must_exit(done, {"apply", "--help"});
    assert_true(contains(help, "Exit code 5: pictures were refused") && contains(help, "default corrected"));
}

// The message names the options for values missing in EXIF.
void test_missing_setting_is_named(void **) {
    lens_database();
    const std::string file = make_picture("in/a.jpg", "Other 24mm");
    assert_refused(not_found, by_exif("out") + Words{file}, {"the focal length with --focal", "with --aperture"});
    assert_refused(not_found, by_exif("out") + Words{"--focal", "24", "--aperture", "8", file},
                   {"give the lens name used in the database with --lens"});
}

// Nothing is missing in EXIF, but the lens does not have such a setting; or the picture names no lens.
void test_settings_that_no_lens_has(void **) {
    lens_database();
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("lens.db").c_str(), LENSPROF_STORE_WRITE, &store, nullptr));
    for (const double focal : {24.0, 70.0})
        for (const double aperture : {2.8, 8.0}) {
            auto profile = make_profile_of_lens();
            profile->key.processing = LENSPROF_PROCESSING_JPEG;
            std::strcpy(profile->key.camera_model, "Camera");
            std::strcpy(profile->key.lens, "Zoom 24-70mm");
            profile->key.focal_mm = focal, profile->key.aperture = aperture, profile->key.distance_m = INFINITY;
            profile->key.crop_factor = 1.0;
            assert_ok(lensprof_store_put(store, profile.get(), nullptr, nullptr));
        }
    lensprof_store_close(store);
    const std::string zoom = make_picture("in/a.jpg", "Zoom 24-70mm"), none = make_picture("in/b.jpg", "");
    const auto at = [&](const char *focal, const char *aperture) {
        return by_exif("out") + Words{"--focal", focal, "--aperture", aperture, "--key", "distance=inf"};
    };
    assert_refused(not_found, at("300", "4") + Words{zoom}, {"the setting is missing", "check the lens and the focal"});
    assert_refused(not_found, at("50", "32") + Words{zoom}, {"the setting is missing", "check the lens and the aper"});
    assert_refused(not_found, by_exif("out") + Words{"--camera", "Other", none},
                   {"(EXIF does not name the lens); make one", "the lens with --lens"});
    must_exit(done, at("50", "4") + Words{"--key", "crop-factor=1,doubtful=yes", zoom});
}

// Without -o, outputs go to a folder in the current directory, where only files written by lensprof are replaced.
void test_output_by_default(void **) {
    lens_database();
    const std::string file = make_picture("a.jpg", "Good 35mm"), here = fs::current_path().string();
    const Words apply = {"apply", "--profile", "auto", "--db", work("lens.db"), file};
    fs::current_path(work(""));
    const Outcome first = run_words(apply), again = run_words(apply);
    make_picture("corrected/a.jpg", "Good 35mm");
    const Outcome other = run_words(apply), overwritten = run_words(apply + Words{"--overwrite"});
    fs::current_path(here);
    assert_int_equal(first.code, done);
    assert_string_equal(first.out.c_str(), "corrected/a.jpg\n");
    assert_int_equal(again.code, done);
    assert_int_equal(other.code, usage);
    assert_true(contains(other.err, "corrected/a.jpg: exists and was not written by lensprof"));
    assert_int_equal(overwritten.code, done);
    assert_files(work("corrected"), {"a.jpg"});
}

void test_named_pictures_are_all_or_none(void **) {
    lens_database();
    const std::string good = make_picture("in/a.jpg", "Good 35mm"), bad = make_picture("in/b.jpg", "Other 24mm");
    const std::string worse = make_picture("in/c.jpg", "Third 85mm");
    assert_refused(not_found, by_exif("out") + Words{good, bad}, {bad, "; or skip it with --skip"});
    assert_refused(not_found, by_exif("out") + Words{good, bad, worse},
                   {"lensprof: " + bad + ": no profile for ", "lensprof: " + worse + ": no profile for ",
                    "2 of 3 pictures cannot be corrected, and nothing was written; use --skip to leave them out"});
    assert_files(work("out"), {});
    const Outcome outcome = run_words(by_exif("out") + Words{"--skip", good, bad});
    assert_int_equal(outcome.code, not_found);
    assert_true(contains(outcome.err, "1 of 2 pictures left out:\n"));
    assert_files(work("out"), {"a.jpg"});
    const Outcome none = run_words(by_exif("none") + Words{"--skip", "--contact-sheet", work("sheet.png"), bad});
    assert_int_equal(none.code, not_found);
    assert_string_equal(none.out.c_str(), "");
    assert_false(fs::exists(work("none")) || fs::exists(work("sheet.png")));
}

// An unreadable picture, found at its start or in its pixels, is listed; the others are corrected. Its exit code is
// not that of a picture without a profile, whose turn comes first here. All of a folder, several names, or one.
void test_unreadable_is_left_out(void **) {
    lens_database();
    make_picture("in/a.jpg", "Other 24mm");
    make_picture("in/c.jpg", "Good 35mm"), make_picture("in/e.png", "Good 35mm");
    save_text(work("in/b.jpg"), "no picture");
    const std::string cut = make_picture("in/d.jpg", "Good 35mm");
    fs::resize_file(cut, fs::file_size(cut) - 40);
    const Outcome outcome = run_words(by_exif("out") + Words{"--contact-sheet", work("sheet.png"), work("in")});
    assert_int_equal(outcome.code, unreadable);
    assert_true(contains(outcome.err, "lensprof: 3 of 5 pictures left out:\n"));
    for (const char *reason :
         {"in/a.jpg: no profile for", "in/b.jpg: cannot read: is not a PNG", "in/d.jpg: cannot read: "})
        if (!contains(outcome.err, "lensprof:   " + work(reason))) fail_msg("%s: %s", reason, outcome.err.c_str());
    assert_files(work("out"), {"c.jpg", "e.png"});
    assert_true(read_picture(work("sheet.png")).width > 0);
    const Json json = json_of(by_exif("json") + Words{"--json", work("in")}, unreadable);
    assert_int_equal(json["pictures"].size(), 2);
    assert_int_equal(json["left_out"].size(), 3);
    const Words named = {work("in/b.jpg"), work("in/c.jpg"), cut};
    assert_int_equal(run_words(by_exif("named") + named).code, unreadable);
    assert_files(work("named"), {"c.jpg"});
    assert_refused(unreadable, by_exif("mistaken") + named + Words{work("in/missing.jpg")}, {"missing.jpg"});
    for (const std::string &file : {work("in/b.jpg"), cut}) {
        const Outcome alone = run_words(by_exif("alone") + Words{file});
        assert_int_equal(alone.code, unreadable);
        assert_true(contains(alone.err, "lensprof: " + file + ": cannot read: "));
        assert_false(contains(alone.err, "left out"));
    }
    assert_files(work("alone"), {});
}

// Marks.

void test_corrected_once(void **) {
    for (const char *name : {"in/a.jpg", "in/a.png", "in/a.tif"}) {
        const std::string file = make_picture(name, "Good 35mm");
        const std::string once = work("once/" + fs::path(name).filename().string());
        assert_false(read_metadata(file).mark.has_value());
        must_exit(done, corrected_into("once", {file}));
        const PictureMetadata metadata = read_metadata(once);
        assert_true(metadata.mark.has_value());
        assert_true(metadata.mark->falloff == CorrectionMark::Falloff::removed);
        assert_string_equal(metadata.mark->software.c_str(), (std::string("lensprof ") + lensprof_version()).c_str());
        assert_string_equal(metadata.mark->source.c_str(), fs::path(name).filename().c_str());
        assert_string_equal(metadata.mark->digest.c_str(), digest_of(file).c_str());
        assert_int_equal(metadata.key.processing, LENSPROF_PROCESSING_CORRECTED);
        assert_string_equal(metadata.key.lens, "Good 35mm");
        assert_refused(not_found, corrected_into("twice", {once}),
                       {once, "already corrected, by lensprof", "--set force-falloff=yes"});
        must_exit(done, corrected_into("twice", {"--set", "force-falloff=yes", once}));
    }
    // In a folder they are left out, without a failure.
    fs::copy(work("in/a.png"), work("once/new.png"));
    const Json json = json_of(corrected_into("rest", {"--json", work("once")}));
    assert_files(work("rest"), {"new.png"});
    assert_int_equal(json["left_out"].size(), 3);
    assert_true(json["left_out"][0]["corrected_already"].get<bool>());
}

void test_simulated_may_be_corrected(void **) {
    const std::string file = make_picture("in/a.png", "Good 35mm");
    must_exit(done, corrected_into("added", {"--set", "simulate=yes", file}));
    assert_true(read_metadata(work("added/a.png")).mark->falloff == CorrectionMark::Falloff::added);
    must_exit(done, corrected_into("removed", {work("added/a.png")}));
    must_exit(done, corrected_into("again", {"--set", "simulate=yes", work("removed/a.png")}));
    assert_true(read_metadata(work("again/a.png")).mark->falloff == CorrectionMark::Falloff::added);
}

// A change of exposure alone does not mark the falloff as corrected, nor does it remove an existing mark.
void test_kept_falloff(void **) {
    const std::string file = make_picture("in/a.png", "Good 35mm");
    must_exit(done, corrected_into("none", {"--set", "strength=0", file}));
    assert_true(read_metadata(work("none/a.png")).mark->falloff == CorrectionMark::Falloff::kept);
    must_exit(done, corrected_into("removed", {work("none/a.png")}));
    must_exit(done,
              corrected_into("linear", {"--set", "force-falloff=yes,strength=0", "--linear", work("removed/a.png")}));
    const auto mark = read_metadata(work("linear/a.tif")).mark;
    assert_true(mark->falloff == CorrectionMark::Falloff::removed && mark->linear);
}

// Existing outputs.

void test_outputs_of_other_pictures(void **) {
    const std::string one = make_picture("1/a.jpg", "Good 35mm", 60), two = make_picture("2/a.jpg", "Good 35mm", 62);
    must_exit(done, corrected_into("out", {one}));
    must_exit(done, corrected_into("out", {"--set", "strength=0.5", one}));
    assert_refused(usage, corrected_into("out", {two}), {work("out/a.jpg"), "another picture (a.jpg)", "--overwrite"});
    must_exit(done, corrected_into("out", {"--overwrite", two}));
    assert_int_equal(read_size(work("out/a.jpg")).width, 62);
    save_text(work("out/a.jpg"), "mine");
    must_exit(done, corrected_into("out", {two}));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_subfolders_are_kept),
        CLI_TEST(test_links_do_not_loop),
        CLI_TEST(test_outputs_within_the_folder),
        CLI_TEST(test_folder_goes_on),
        CLI_TEST(test_nearest_names),
        CLI_TEST(test_named_pictures_are_all_or_none),
        CLI_TEST(test_unreadable_is_left_out),
        CLI_TEST(test_help_tells_of_refused_pictures),
        CLI_TEST(test_missing_setting_is_named),
        CLI_TEST(test_settings_that_no_lens_has),
        CLI_TEST(test_output_by_default),
        CLI_TEST(test_corrected_once),
        CLI_TEST(test_simulated_may_be_corrected),
        CLI_TEST(test_kept_falloff),
        CLI_TEST(test_outputs_of_other_pictures),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
