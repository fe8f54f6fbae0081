// A scene of pictures, as a Hugin project and in the ledger: what is read back is the same scene.
#include "photo/base/input_file.hpp"
#include "photo/folder/noted_scene.hpp"
#include "photo/scene/hugin_project.hpp"
#include "photo/scene/photographs.hpp"

#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

// Three pictures of two cameras, of which the second has another lens; every number is another.
FoundScene found_scene() {
    FoundScene found;
    for (uint32_t i = 0; i < 3; i++) {
        const double n = 1.0 / (3.0 + i);
        lensprof_camera camera{};
        camera.projection = i == 1 ? LENSPROF_PROJECTION_EQUISOLID : LENSPROF_PROJECTION_RECTILINEAR;
        camera.width = 600 + i, camera.height = 400 - i;
        camera.hfov_deg = 50.0 + n, camera.yaw_deg = 20.0 * i + n, camera.pitch_deg = -n, camera.roll_deg = 2.0 * n;
        for (double &radial : camera.radial) radial = 1e-3 * n;
        for (int axis = 0; axis < 2; axis++) camera.shift_px[axis] = axis + n, camera.shear_px[axis] = -1e-3 * n;
        for (double &translation : camera.translation) translation = 1e-2 * n;
        found.cameras.push_back(camera);
    }
    found.cameras[2].hfov_deg = found.cameras[0].hfov_deg;  // linked: one lens
    std::copy_n(found.cameras[0].radial, 3, found.cameras[2].radial);
    for (int axis = 0; axis < 2; axis++) {
        found.cameras[2].shift_px[axis] = found.cameras[0].shift_px[axis];
        found.cameras[2].shear_px[axis] = found.cameras[0].shear_px[axis];
    }
    found.lenses = {7, 3, 7}, found.camera_ids = {1, 5, 1};
    found.points = {{{0, 2}, {{1.25, 2.5}, {3.125, 4.0}}}};
    found.matches = {lensprof_match{}};
    found.matches[0].image[1] = 1;
    found.matches[0].xy[0][0] = 10.25, found.matches[0].map[0][0] = 1.0;
    found.by_matches = true;
    return found;
}

Scene scene_of(const FoundScene &found) {
    Scene scene;
    scene.path = "pictures";
    for (const char *name : {"a.jpg", "b.jpg", "c.jpg"}) {
        scene.names.push_back(name);
        scene.files.push_back(work(name));
    }
    set_found(found, scene);
    return scene;
}

void assert_same_camera(const lensprof_camera &a, const lensprof_camera &b) { assert_memory_equal(&a, &b, sizeof a); }

void assert_same_image(const lensprof_pto_image &a, const lensprof_pto_image &b) {
    assert_same_camera(a.camera, b.camera);
    assert_memory_equal(&a, &b, sizeof a);
}

void test_as_a_project(void **) {
    const Scene scene = scene_of(found_scene());
    write_hugin_project(scene, work("scene.pto"));
    const Scene read = read_hugin_project(work("scene.pto"));
    assert_int_equal(read.images.size(), 3);
    assert_int_equal(read.reference, scene.reference);
    for (uint32_t i = 0; i < 3; i++) {
        assert_string_equal(read.names[i].c_str(), scene.names[i].c_str());
        assert_same_image(read.images[i], scene.images[i]);
        assert_memory_equal(read.models[i].get(), scene.models[i].get(), sizeof *read.models[i]);
    }
    assert_true(read.models[0] == read.models[2]);
    assert_true(contains(read_text(work("scene.pto"), max_text_bytes), "c n0 N2 x1.250 y2.500 X3.125 Y4.000 t0\n"));
}

// From another folder, where the names are relative, and unchanged next to the project itself.
void test_names(void **) {
    Scene scene = scene_of(found_scene());
    std::filesystem::create_directories(work("below"));
    write_hugin_project(scene, work("below/scene.pto"));
    const Scene read = read_hugin_project(work("below/scene.pto"));
    assert_string_equal(read.names[1].c_str(), "../b.jpg");
    assert_true(contains(pto_text(*hugin_project(read, work("below/other.pto"))), "n\"../b.jpg\""));
    assert_true(contains(pto_text(*hugin_project(read, work("other.pto"))), "n\"b.jpg\""));
}

void test_in_the_ledger(void **) {
    const FoundScene found = found_scene();
    const Json json = json_of(found);
    FoundScene read;
    assert_true(read_noted(json, 3, read));
    for (size_t i = 0; i < 3; i++) assert_same_camera(read.cameras[i], found.cameras[i]);
    assert_true(read.lenses == found.lenses && read.camera_ids == found.camera_ids && read.by_matches);
    assert_memory_equal(read.points.data(), found.points.data(), sizeof(ControlPoint));
    assert_memory_equal(read.matches.data(), found.matches.data(), sizeof(lensprof_match));
    assert_true(json_of(read) == json);
}

void test_damaged_in_the_ledger(void **) {
    const Json good = json_of(found_scene());
    FoundScene read;
    assert_false(read_noted(good, 2, read));
    assert_false(read_noted(Json(), 3, read));
    for (const char *name : {"cameras", "camera_ids", "lenses", "points", "matches", "by_matches"}) {
        Json json = good;
        json.erase(name);
        assert_false(read_noted(json, 3, read));
        json[name] = "text";
        assert_false(read_noted(json, 3, read));
        if (!good[name].is_array()) continue;
        json[name] = good[name];
        json[name].erase(json[name].size() - 1);
        assert_false(read_noted(json, 3, read));
        json[name] = good[name];
        json[name][0] = Json();
        assert_false(read_noted(json, 3, read));
    }
    Json json = good;
    json["points"][0] = 3;  // the pictures are 0 to 2
    assert_false(read_noted(json, 3, read));
    json = good;
    json["cameras"][1] = 0;  // wide
    assert_false(read_noted(json, 3, read));
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {
        CLI_TEST(test_as_a_project),
        CLI_TEST(test_names),
        CLI_TEST(test_in_the_ledger),
        CLI_TEST(test_damaged_in_the_ledger),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
