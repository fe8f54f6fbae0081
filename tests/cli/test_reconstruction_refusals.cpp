// `build` of reconstructions that cannot be used: the message names the problem, and nothing is written.
#include "cli_runs.hpp"
#include "reconstruction_files.hpp"

using namespace cli_runs;
using reconstruction_files::make_database;
using reconstruction_files::OpenDatabase;

namespace {

int make_work(void **state) {
    if (make_folder(state) != 0) return -1;
    setenv("XDG_DATA_HOME", in_folder("work/data").c_str(), 1);
    setenv("XDG_DATA_DIRS", in_folder("work/share").c_str(), 1);
    return 0;
}

Words build_of(const std::string &path) {
    return {"build", path, "--camera", "Example", "--lens", "Example", "--write", "points=" + work("out.txt")};
}

// A database that names four pictures, the first of them in the parent folder.
std::string make_project(const std::string &more = {}) {
    fs::create_directory(work("project"));
    const std::string path = make_database("work/project/database.db", more);
    for (const char *name : {"c.png", "project/b b.png", "project/d.png"})
        write_picture(work(name), make_smooth(320, 240, LENSPROF_LAYOUT_RGB));
    write_picture(work("project/a.png"), make_smooth(100, 200, LENSPROF_LAYOUT_RGB));
    return path;
}

void test_pictures(void **) {
    const std::string path = make_project();
    fs::remove(work("project/d.png"));
    assert_refused(unreadable, build_of(path), {path, "d.png", "--images", "--reconstruction list"});
    write_picture(work("project/d.png"), make_smooth(160, 120, LENSPROF_LAYOUT_RGB));
    assert_refused(unreadable, build_of(path), {path, "project/d.png", "is 160 x 120", "320 x 240", "resized"});
    write_picture(work("project/d.png"), make_smooth(240, 320, LENSPROF_LAYOUT_RGB));
    assert_refused(unreadable, build_of(path), {path, "project/d.png", "is 240 x 320", "rotated"});
    save(work("project/d.png"), {1, 2, 3});
    assert_refused(unreadable, build_of(path), {"project/d.png"});
    assert_refused(unreadable, build_of(path) + Words{"--images", work("none")}, {work("none")});
}

// A file that is part of a reconstruction, but not the one to pass.
void test_parts(void **) {
    fs::create_directories(work("parts"));
    const std::pair<const char *, const char *> parts[] = {{"images.bin", "give its folder"},
                                                           {"points3D.txt", "give its folder"},
                                                           {"reconstruction.json", "give tracks.csv"},
                                                           {"x.json", "apply --model"}};
    for (const auto &[name, advice] : parts) {
        const std::string path = work("parts/") + name;
        save_text(path, std::string(name) == "x.json" ? "{\"file\": \"lensprof exposures\"}" : "other");
        assert_refused(unreadable, build_of(path), {path, advice});
    }
}

// By its own name, and by its folder's name.
void test_databases(void **) {
    std::string path = make_project("DELETE FROM two_view_geometries");
    assert_refused(not_usable, build_of(path), {path, "no point is visible in two"});
    path = make_database("work/project/database.db", "DELETE FROM cameras");
    for (const std::string &name : {path, work("project")})
        assert_refused(unreadable, build_of(name), {path, "camera"});
    Bytes whole = load(path);
    whole.resize(5000);
    save(path, whole);
    for (const std::string &name : {path, work("project")})
        assert_refused(unreadable, build_of(name), {path, "intact"});
    fs::remove(path);
    OpenDatabase(path).run("CREATE TABLE notes(text TEXT)");
    assert_refused(unreadable, build_of(path), {path, "cannot be read as a COLMAP database"});
}

void test_models(void **) {
    make_project();
    fs::remove(work("project/database.db"));
    const std::string model = work("project/sparse/0");
    fs::create_directories(model);
    save_text(model + "/cameras.txt", "1 PINHOLE 320 240 1 1 1 1\n");
    save_text(model + "/images.txt",
              "1 1 0 0 0 0 0 0 1 d.png\n10.5 20.5 1\n2 1 0 0 0 1 0 0 1 b b.png\n100.5 110.5 1\n");
    save_text(model + "/points3D.txt", "1 0 0 5 0 0 0 0 1 0 2 1\n");
    for (const std::string &name : {model, work("project")})
        assert_refused(unreadable, build_of(name), {model + "/points3D.txt", "feature 1 of image 2"});
    save_text(model + "/points3D.txt", "1 0 0 5 0 0 0 0 1 0\n");
    assert_refused(not_usable, build_of(model), {model, "no point is visible in two"});
}

void test_other_programs(void **) {
    const std::string tracks = work("tracks.csv"), bundle = work("bundle.out"), scene = work("cameras.sfm"),
                      data = work("sfm_data.json");
    save_text(tracks, "OPENSFM_TRACKS_VERSION_v2\na.jpg\t1\t0\t0.7\t0\t0.01\t1\t2\t3\t-1\t-1\n");
    assert_refused(unreadable, build_of(tracks), {tracks, "line 2", "outside the picture"});
    save_text(bundle, "# Bundle file v0.3\n2 1\n");
    assert_refused(unreadable, build_of(bundle), {bundle, "list.txt"});
    save_text(work("list.txt"), "a.jpg\nb.jpg\nc.jpg\n");
    assert_refused(unreadable, build_of(bundle), {bundle, "2 cameras", "3 images", work("list.txt")});
    save_text(scene, R"({"version": ["1", "2", "6"], "views": [], "structure": 1e999})");
    assert_refused(unreadable, build_of(scene), {scene, "too large"});
    save_text(data, R"({"sfm_data_version": "0.3", "root_path": "", "views": [], "structure": []})");
    assert_refused(unreadable, build_of(data), {data, "no structure"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_pictures), CLI_TEST(test_parts), CLI_TEST(test_databases),
                                CLI_TEST(test_models), CLI_TEST(test_other_programs)};
    return cmocka_run_group_tests(tests, make_work, remove_folder);
}
