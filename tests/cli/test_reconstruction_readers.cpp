// Reading COLMAP's databases and models: images, cameras, positions and tracks, and damaged files.
#include "photo/reconstruction/reconstruction_file.hpp"

#include "reconstruction_checks.hpp"

using namespace reconstruction_checks;

namespace {

void test_database(void **) {
    const std::string path = make_database("database.db");
    assert_true(is_colmap_database(path));
    const Reconstruction r = read_colmap_database(path);
    assert_int_equal(r.images.size(), 4);
    const char *const names[] = {"../c.png", "a.png", "b b.png", "d.png"};
    for (size_t i = 0; i < 4; i++) assert_string_equal(r.images[i].name.c_str(), names[i]);
    assert_int_equal(r.cameras[r.images[1].camera].width, 100);
    assert_int_equal(r.cameras[r.images[1].camera].height, 200);
    assert_int_equal(r.cameras[r.images[3].camera].width, 320);
    assert_true(r.coordinates == ImageCoordinates::stored_px && r.has_rotations && !r.has_colours);
    assert_int_equal(r.observations.size(), 3);
    assert_int_equal(r.point_count(), 1);
    for (uint32_t n = 0; n < 3; n++) {
        assert_int_equal(r.observations[n].image, n);
        assert_int_equal(r.observations[n].feature, 0);
    }
    assert_place(r.observations[0], 200.25, 209.75);
    assert_place(r.observations[1], 10, 20);
    assert_place(r.observations[2], 100, 110);
    assert_shape(r.observations[0], {0, 0, 0, 0});
    assert_shape(r.observations[1], {0, -2, 2, 0});
    assert_shape(r.observations[2], {1, 2, 3, 4});
}

void test_damaged_databases(void **) {
    const struct {
        std::string sql;
        const char *part;
    } cases[] = {
        {"UPDATE cameras SET width=0", "0 x 240 pixels"},
        {"UPDATE cameras SET height=1000000000000", "320 x 1000000000000 pixels"},
        {"DELETE FROM cameras WHERE camera_id=2", "an image without a camera"},
        {"DELETE FROM images WHERE image_id=9", "refers to image 9"},
        {"UPDATE images SET name='a.png' WHERE image_id=4", "has the image a.png twice"},
        {"UPDATE images SET name='' WHERE image_id=4", "an image without a name"},
        {"UPDATE keypoints SET rows=rows+1", "keypoints that are truncated"},
        {"UPDATE keypoints SET rows=1000000000000", "keypoints that are truncated"},
        {"UPDATE keypoints SET rows=-1", "keypoints that are truncated"},
        {"UPDATE keypoints SET rows=4, cols=3 WHERE image_id=3", "keypoints with 3 columns"},
        {"UPDATE keypoints SET data=NULL", "keypoints that are truncated"},
        {keypoints_sql(3, 2, {1, 2}), "the keypoints of an image twice"},
        {"UPDATE keypoints SET data=" + blob_of<float>({NAN, 1, 7, 7}) + " WHERE image_id=9",
         "position is not a number"},
        {"UPDATE two_view_geometries SET rows=100", "matches that are truncated"},
        {"UPDATE two_view_geometries SET rows=rows*2, cols=1", "matches that are not pairs"},
        {"UPDATE two_view_geometries SET pair_id=-5 WHERE config=2", "which does not exist"},
        {"DELETE FROM two_view_geometries WHERE config=2;" + matches_sql(3, 7, 2, {0, 3}), "matches keypoint 3 of b b"},
        {"DELETE FROM two_view_geometries WHERE config=2;" + matches_sql(3, 7, 2, {0xFFFFFFFF, 0}),
         "matches keypoint 4294967295 of a.png"},
        {"DROP TABLE keypoints", "no such table"},
        {"ALTER TABLE images RENAME COLUMN name TO title", "no such column"},
    };
    for (const auto &[sql, part] : cases) {
        const std::string path = make_database("damaged.db", sql);
        assert_unreadable(path, part, [&] { return read_colmap_database(path); });
    }
    const std::string path = make_database("damaged.db", "UPDATE two_view_geometries SET config=7");
    assert_failure(LENSPROF_ERROR_NOT_USABLE, path + ": no point is visible", [&] { read_colmap_database(path); });
}

void test_cut_databases(void **) {
    const std::string path = make_database("database.db");
    Events events;
    cut_everywhere(path, 211, [&] { return read_colmap_database(path); });
    Bytes whole = load(path);
    whole.resize(whole.size() / 2);
    save_anew(path, whole);
    assert_true(is_reconstruction(path) && is_reconstruction(folder.string()));
    assert_unreadable(path, "give an intact copy", [&] { return read_reconstruction(folder.string(), events); });
}

void test_other_database(void **) {
    const std::string path = in_folder("other.db");
    run_sql(path, "CREATE TABLE notes(text TEXT)");
    Events events;
    assert_false(is_colmap_database(path));
    assert_unreadable(path, "no such table: cameras", [&] { return read_reconstruction(path, events); });
}

// COLMAP's own journal mode: no trace is left if nobody has the database open, and all rows are visible if somebody
// has.
void test_logged_database(void **) {
    const std::string path = make_database("with ?#%.db", "PRAGMA journal_mode=WAL");
    assert_int_equal(files_in_folder(), 1);
    assert_int_equal(read_colmap_database(path).images.size(), 4);
    assert_int_equal(files_in_folder(), 1);
    OpenDatabase open(path);
    open.run("INSERT INTO images VALUES(12,'later.png',1)");
    assert_int_equal(read_colmap_database(path).images.size(), 5);
}

void test_locked_database(void **) {
    const std::string path = make_database("database.db");
    OpenDatabase open(path);
    open.run("BEGIN EXCLUSIVE");
    assert_unreadable(path, "another program is writing to it", [&] { return read_colmap_database(path); });
}

void assert_model(const Reconstruction &r, size_t images) {
    assert_int_equal(r.images.size(), images);
    const ReconstructionImage &y = r.images[0], &z = r.images[images - 1];
    assert_string_equal(y.name.c_str(), "sub/y.png");
    assert_string_equal(z.name.c_str(), "z z.png");
    assert_centre(y, 4, 5, 6);
    assert_centre(z, 1, 2, 3);
    assert_int_equal(r.cameras[y.camera].width, 320);
    assert_int_equal(r.cameras[z.camera].width, 337);
    assert_int_equal(r.observations.size(), 2);
    assert_place(r.observations[0], 30, 40);
    assert_place(r.observations[1], 10, 20);
    assert_int_equal(r.observations[1].feature, 1);
    assert_int_equal(r.points.size(), 1);
    assert_close(r.points[0][2], 9, 0);
}

void test_models(void **) {
    assert_model(read_colmap_model(make_binary_model("binary")), 2);
    assert_model(read_colmap_model(make_text_model("text")), 3);
    assert_model(read_colmap_model(make_text_model("crlf", true)), 3);
}

void test_cut_models(void **) {
    const std::string binary = make_binary_model("binary"), text = make_text_model("text");
    for (const char *name : {"/cameras", "/images", "/points3D"}) {
        cut_everywhere(binary + name + ".bin", 3, [&] { return read_colmap_model(binary); });
        const Bytes whole = load(text + name + ".txt");
        for (size_t bytes = 0; bytes < whole.size(); bytes++) {  // a cut number may be another valid number
            save_anew(text + name + ".txt", Bytes(whole.begin(), whole.begin() + long(bytes)));
            try {
                read_colmap_model(text);
            } catch (const Failure &failure) {
                assert_true(failure.group() == LENSPROF_ERROR_READ || failure.group() == LENSPROF_ERROR_NOT_USABLE);
            }
        }
        save_anew(text + name + ".txt", whole);
    }
}

// Every 8 bytes of each file as a gigantic number.
void test_gigantic_counts(void **) {
    const std::string model = make_binary_model("binary");
    for (const char *name : {"/cameras.bin", "/images.bin", "/points3D.bin"}) {
        const Bytes whole = load(model + name);
        for (size_t at = 0; at + 8 <= whole.size(); at++) {
            Bytes changed = whole;
            std::fill_n(changed.begin() + long(at), 8, uint8_t{0x7F});
            save_anew(model + name, changed);
            try {
                read_colmap_model(model);
            } catch (const Failure &failure) {
                assert_true(failure.group() == LENSPROF_ERROR_READ || failure.group() == LENSPROF_ERROR_NOT_USABLE);
            }
        }
        Bytes first = whole;
        std::fill_n(first.begin(), 8, uint8_t{0xFF});
        save_anew(model + name, first);
        assert_unreadable(model + name, "declares 18446744073709551615 items",
                          [&] { return read_colmap_model(model); });
        save_anew(model + name, whole);
    }
}

void test_damaged_models(void **) {
    const struct {
        const char *file, *from, *to, *part;
    } cases[] = {
        {"/cameras.txt", "320 240", "0 240", "0 x 240"},
        {"/cameras.txt", "27 EQUI", "10 EQUI", "two cameras with the id 10"},
        {"/cameras.txt", "320 240", "3e2 240", "line 2: '3e2' is not an integer"},
        {"/images.txt", "\n5 1 0", "\n8 1 0", "two images with the id 8"},
        {"/images.txt", " 27 z z", " 28 z z", "z z.png refers to a camera that does not exist"},
        {"/images.txt", "30.5 40.5", "nan 40.5", "line 5: 'nan' is not a number"},
        {"/images.txt", "30.5 40.5 77", "30.5 40.5", "line 5: it has too few fields"},
        {"/points3D.txt", "8 1 5 0", "8 2 5 0", "feature 2 of image 8"},
        {"/points3D.txt", "8 1 5 0", "8 1 99 0", "feature 0 of image 99"},
        {"/points3D.txt", "8 1 5 0", "8 1 5 -1", "'-1' is not an integer"},
        {"/points3D.txt", "7 8 9", "7 8 inf", "'inf' is not a number"},
    };
    const std::string model = make_text_model("text");
    for (const auto &[file, from, to, part] : cases) {
        const std::string whole = text_of(model + file);
        save_text(model + file, replaced(whole, from, to));
        assert_unreadable(model + file, part, [&] { return read_colmap_model(model); });
        save_text(model + file, whole);
    }
    const std::string images = text_of(model + "/images.txt");
    save_text(model + "/images.txt", replaced(images, "sub/y.png", "z z.png"));
    assert_unreadable(model, "has the image z z.png twice", [&] { return read_colmap_model(model); });
    save_text(model + "/images.txt", images);
    save_text(model + "/points3D.txt", "77 7 8 9 1 2 3 0 8 1\n78 7 8 9 1 2 3 0 5 0\n");
    assert_failure(LENSPROF_ERROR_NOT_USABLE, model + ": no point is visible", [&] { read_colmap_model(model); });
}

// A model takes the shapes of its features from its database, if the database has them.
void test_shapes_of_model(void **) {
    const std::string path = make_database("database.db"), model = in_folder("model");
    fs::create_directory(model);
    save_text(model + "/cameras.txt", "1 PINHOLE 320 240 1 1 1 1\n");
    save_text(model + "/images.txt",
              "1 1 0 0 0 0 0 0 1 a.png\n10.5 20.5 1\n2 1 0 0 0 1 0 0 1 b b.png\n100.5 110.5 1\n");
    save_text(model + "/points3D.txt", "1 0 0 5 0 0 0 0 1 0 2 0\n");
    struct : Events {
        void notice(uint32_t, const std::string &item, const std::string &text) override {
            notes += item + ": " + text;
        }
        std::string notes;
    } events;
    Reconstruction r = read_reconstruction(model, events);
    assert_true(r.has_rotations);
    assert_shape(r.observations[0], {0, -2, 2, 0});
    assert_shape(r.observations[1], {1, 2, 3, 4});
    save_text(model + "/images.txt", replaced(text_of(model + "/images.txt"), "10.5 20.5", "10.5 20.7"));
    r = read_reconstruction(model, events);
    assert_false(r.has_rotations);
    assert_string_equal(events.notes.c_str(),
                        (path + ": not used, because " + model + " was not made from it").c_str());
}

#define TEST(name) cmocka_unit_test_setup(name, empty_folder)

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        TEST(test_database),        TEST(test_damaged_databases), TEST(test_cut_databases),   TEST(test_other_database),
        TEST(test_logged_database), TEST(test_locked_database),   TEST(test_models),          TEST(test_cut_models),
        TEST(test_gigantic_counts), TEST(test_damaged_models),    TEST(test_shapes_of_model),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
