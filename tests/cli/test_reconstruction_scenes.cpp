// OpenSfM, Bundler, AliceVision and OpenMVG, and the pictures of a reconstruction: positions in px of the stored
// pictures.
#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "photo/reconstruction/pictures.hpp"
#include "photo/reconstruction/reconstruction_file.hpp"

#include "reconstruction_checks.hpp"

using namespace reconstruction_checks;

namespace {

// Two images, a point that both see, and a point that only one sees.
std::string tracks_of(int version) {
    const std::string size = version > 0 ? "\t0.01" : "", more = version > 1 ? "\t-1\t-1" : "";
    const std::string header = version > 0 ? "OPENSFM_TRACKS_VERSION_v" + std::to_string(version) + "\n" : "";
    return header + "b b.jpg\t17\t3\t0.25\t-0.125" + size + "\t255\t0\t7" + more + "\n"
           + "a.jpg\t17\t-1\t-2.5e-1\t0.125" + size + "\t1\t2\t3" + more + "\n" + "a.jpg\t18\t5\t0\t0" + size
           + "\t1\t2\t3" + more + "\n";
}

constexpr const char *opensfm_models =
    R"([{"cameras": {"v2 x": {"projection_type": "perspective", "width": 80, "height": 40}},
         "shots": {"a.jpg": {"camera": "v2 x", "rotation": [9, 9, 9], "translation": [9, 9, 9]}},
         "points": {"17": {"coordinates": [9, 9, 9]}}},
        {"cameras": {"v2 x": {"projection_type": "perspective", "width": 80, "height": 40}},
         "shots": {"a.jpg": {"camera": "v2 x", "rotation": [0, 0, 1.5707963267948966], "translation": [2, -1, -3]},
                   "b b.jpg": {"camera": "v2 x", "rotation": [0, 0, 0], "translation": [-4, -5, -6]}},
         "points": {"17": {"coordinates": [7, 8, 9], "color": [1, 2, 3]}, "404": {"coordinates": [0, 0, 0]}}}])";

void test_opensfm(void **) {
    const std::string path = in_folder("tracks.csv");
    for (int version = 0; version < 6; version++) {
        const std::string text = tracks_of(version % 3);
        save_text(path, version < 3 ? text : with_crlf(text));
        assert_true(is_opensfm_tracks(path));
        Reconstruction r = read_opensfm(path);
        assert_int_equal(r.images.size(), 2);
        assert_string_equal(r.images[1].name.c_str(), "b b.jpg");
        assert_true(r.coordinates == ImageCoordinates::upright_centred && r.has_colours && !r.has_rotations);
        assert_int_equal(r.observations.size(), 2);
        assert_place(r.observations[0], -0.25, 0.125);
        assert_int_equal(r.observations[1].colour[0], 255);
        assert_int_equal(r.observations[1].colour[2], 7);
        assert_true((r.observations[1].shape[0][0] > 0.0f) == (version % 3 > 0));
        assert_false(r.images[0].has_centre);
        assert_failure(LENSPROF_ERROR_READ, "does not state the size of a.jpg", [&] { convert_coordinates(r, {}); });
    }
    save_text(in_folder("reconstruction.json"), opensfm_models);
    Reconstruction r = read_opensfm(path);
    assert_centre(r.images[0], 1, 2, 3);
    assert_centre(r.images[1], 4, 5, 6);
    assert_close(r.points[0][0], 7, 0);
    convert_coordinates(r, {});
    assert_true(r.coordinates == ImageCoordinates::stored_px);
    assert_place(r.observations[0], 19.5, 29.5);  // 80 / 4 and 80 / 8 from the middle, (39.5, 19.5)
    assert_place(r.observations[1], 59.5, 9.5);
    assert_shape(r.observations[0], {0.8, 0, 0, 0.8});
}

void test_damaged_opensfm(void **) {
    const std::string path = in_folder("tracks.csv"), models = in_folder("reconstruction.json");
    const Read read = [&] { return read_opensfm(path); };
    const struct {
        const char *from, *to, *part;
    } cases[] = {
        {"_v2", "_v3", "version '3'"},
        {"_v2", "_v", "version ''"},
        {"0.25", "0.51", "line 2: its position is outside"},
        {"0.25", "nan", "'nan' is not a number"},
        {"0.25", "1e999", "'1e999' is not a number"},
        {"\t255\t", "\t256\t", "a colour is not in 0..255"},
        {"\t255\t", "\t-1\t", "a colour is not in 0..255"},
        {"\t3\t0.25", "\t99999999999\t0.25", "'99999999999' is not an integer"},
        {"\t7\t-1\t-1\n", "\n", "line 2: it has too few fields"},
        {"b b.jpg", "", "an image without a name"},
    };
    for (const auto &[from, to, part] : cases) {
        save_text(path, replaced(tracks_of(2), from, to));
        assert_unreadable(path, part, read);
    }
    save_text(path, replaced(tracks_of(2), "b b.jpg\t17", "b b.jpg\t16"));
    assert_failure(LENSPROF_ERROR_NOT_USABLE, path + ": no point is visible", [&] { read(); });
    save_text(path, replaced(tracks_of(2), "18", "17"));  // twice in one image
    assert_failure(LENSPROF_ERROR_NOT_USABLE, path + ": no point is visible", [&] { read(); });
    save_text(path, tracks_of(2));
    for (const char *text : {"{}", "[1e999]", "[", "\xFF", "[{\"cameras\": {\"\xC3\": 1}}]"}) {
        save_text(models, text);
        assert_unreadable(models, ";", read);
    }
    // Members of other types are ignored.
    for (const char *text : {"[]", "[1, null]", R"([{"cameras": [1], "shots": 3, "points": "x"}])",
                             R"([{"cameras": {"c": 1}, "shots": {"a.jpg": {"camera": 1, "rotation": {}}},
                                  "points": {"17": {"coordinates": ["x", [], null]}}}])"}) {
        save_text(models, text);
        assert_int_equal(read().observations.size(), 2);
    }
}

void test_cut_opensfm(void **) {
    const std::string path = in_folder("tracks.csv"), models = in_folder("reconstruction.json");
    save_text(path, tracks_of(2)), save_text(models, opensfm_models);
    cut_everywhere(path, 1, [&] { return read_opensfm(path); });
    cut_everywhere(models, 3, [&] { return read_opensfm(path); });
}

// Cameras at (1, 2, 3), (4, 5, 6), and one without a position.
constexpr const char *bundle =
    "# Bundle file v0.3\n3 2\n"
    "700 0 0\n0 -1 0\n1 0 0\n0 0 1\n2 -1 -3\n"
    "700 0 0\n1 0 0\n0 1 0\n0 0 1\n-4 -5 -6\n"
    "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
    "7 8 9\n255 0 0\n2 0 3 -4.5 3.5 1 -1 1.5 -2.5\n"
    "1 1 1\n0 0 0\n1 2 0 0 0\n";
constexpr const char *bundle_list = "./z z.jpg 0 712.5\ny.jpg 0\n\n../x 1.jpg\n";

std::string make_bundle(const std::string &text = bundle, const std::string &list = bundle_list) {
    save_text(in_folder("bundle.out"), text);
    save_text(in_folder("list.txt"), list);
    return in_folder("bundle.out");
}

void test_bundler(void **) {
    for (const bool is_crlf : {false, true}) {
        const std::string path =
            make_bundle(is_crlf ? with_crlf(bundle) : bundle, is_crlf ? with_crlf(bundle_list) : bundle_list);
        assert_true(is_bundler(path));
        Reconstruction r = read_bundler(path);
        assert_int_equal(r.images.size(), 3);
        const char *const names[] = {"../x 1.jpg", "./z z.jpg", "y.jpg"};
        for (size_t i = 0; i < 3; i++) assert_string_equal(r.images[i].name.c_str(), names[i]);
        assert_false(r.images[0].has_centre);
        assert_centre(r.images[1], 1, 2, 3);
        assert_centre(r.images[2], 4, 5, 6);
        assert_int_equal(r.observations.size(), 2);
        assert_close(r.points[0][1], 8, 0);
        std::vector<std::string> files;
        for (size_t i = 0; i < 3; i++) files.push_back(in_folder("picture.png"));
        write_picture(files[0], make_smooth(10, 8, LENSPROF_LAYOUT_RGB));
        convert_coordinates(r, files);
        assert_place(r.observations[0], 0, 0);  // the middle of the first pixel
        assert_place(r.observations[1], 6, 6);
        assert_int_equal(r.cameras[r.images[2].camera].height, 8);
    }
}

void test_damaged_bundler(void **) {
    const struct {
        const char *from, *to, *part;
    } cases[] = {
        {"v0.3", "v0.2", "it is not version 0.3"},
        {"3 2\n", "4 2\n", "has 4 cameras, but "},
        {"3 2\n", "3 4294967295\n", "points are missing"},
        {"3 2\n", "3 99999999999\n", "'99999999999' is not an integer"},
        {"2 0 3 -4.5", "4000000000 0 3 -4.5", "it has too few fields"},
        {"2 0 3 -4.5", "2 3 3 -4.5", "it refers to a camera that does not exist"},
        {"-4.5 3.5", "nan 3.5", "'nan' is not a number"},
        {"-4.5 3.5", "1e300 3.5", "whose position is not a number"},
        {"2 -1 -3\n", "2 -1\n", "it has too few fields"},
    };
    for (const auto &[from, to, part] : cases) {
        const std::string path = make_bundle(replaced(bundle, from, to));
        assert_unreadable(path, part, [&] { return read_bundler(path); });
    }
    std::string path = make_bundle(bundle, "a.jpg\nb.jpg\na.jpg\n");
    assert_unreadable(path, "has the image a.jpg twice", [&] { return read_bundler(path); });
    path = make_bundle();
    cut_everywhere(path, 1, [&] { return read_bundler(path); });
    cut_everywhere(in_folder("list.txt"), 1, [&] { return read_bundler(path); });
    fs::remove(in_folder("list.txt"));
    assert_unreadable(path, "the list of its images is missing", [&] { return read_bundler(path); });
}

constexpr const char *alicevision = R"({"version": ["1", "2", "6"],
  "views": [{"viewId": "12", "poseId": "12", "path": "/far/z z.jpg", "width": "320", "height": "240"},
            {"viewId": "5", "poseId": "9", "path": "/far/y.jpg"}],
  "poses": [{"poseId": "12", "pose": {"transform": {"rotation": ["1"], "center": ["1", "2", "3"]}}}],
  "structure": [{"landmarkId": "1", "X": ["7", "8", "9"], "observations": [
     {"observationId": "12", "featureId": "3", "x": ["10.5", "2e1"], "scale": "2.5"},
     {"observationId": "5", "featureId": "4", "x": ["30", "40"]}]}]})";

constexpr const char *openmvg = R"({"sfm_data_version": "0.3", "root_path": "/far",
  "views": [{"key": 12, "value": {"polymorphic_id": 1073741824, "ptr_wrapper": {"id": 2147483649, "data": {
               "local_path": "/", "filename": "z z.jpg", "width": 320, "height": 240, "id_view": 12, "id_pose": 12}}}},
            {"key": 5, "value": {"polymorphic_id": 1073741824, "ptr_wrapper": {"id": 2147483650, "data": {
               "local_path": "sub/", "filename": "y.jpg", "width": 0, "height": 0, "id_view": 5, "id_pose": 9}}}}],
  "extrinsics": [{"key": 12, "value": {"rotation": [[1, 0, 0]], "center": [1, 2, 3]}}],
  "structure": [{"key": 1, "value": {"X": [7, 8, 9], "observations": [
     {"key": 12, "value": {"id_feat": 3, "x": [10.5, 20]}}, {"key": 5, "value": {"id_feat": 4, "x": [30, 40]}}]}}]})";

struct Scene {
    const char *file, *text;
    Reconstruction (*read)(const std::string &);
};
const Scene scenes[] = {{"cameras.sfm", alicevision, read_alicevision}, {"sfm_data.json", openmvg, read_openmvg}};

void test_scenes(void **) {
    for (const Scene &scene : scenes) {
        const std::string path = in_folder(scene.file);
        save_text(path, scene.text);
        assert_true(is_reconstruction(path));
        const Reconstruction r = scene.read(path);
        assert_int_equal(r.images.size(), 2);
        assert_string_equal(fs::path(r.images[0].name).filename().c_str(), "y.jpg");
        assert_string_equal(fs::path(r.images[1].name).filename().c_str(), "z z.jpg");
        assert_int_equal(r.cameras[r.images[0].camera].width, 0);
        assert_int_equal(r.cameras[r.images[1].camera].height, 240);
        assert_false(r.images[0].has_centre);
        assert_centre(r.images[1], 1, 2, 3);
        assert_place(r.observations[0], 30, 40);
        assert_place(r.observations[1], 10.5, 20);
        assert_close(r.points[0][0], 7, 0);
        cut_everywhere(path, 1, [&] { return scene.read(path); });
    }
    save_text(in_folder("sfm_data.json"), openmvg);
    const Reconstruction r = read_openmvg(in_folder("sfm_data.json"));
    assert_string_equal(r.folder.c_str(), "/far");
    assert_string_equal(r.images[0].name.c_str(), "sub/y.jpg");
    assert_string_equal(r.images[1].name.c_str(), "z z.jpg");
    save_text(in_folder("cameras.sfm"), alicevision);
    assert_shape(read_alicevision(in_folder("cameras.sfm")).observations[1], {2.5, 0, 0, 2.5});
}

void test_damaged_scenes(void **) {
    const struct {
        const char *from[2], *to[2], *part;
    } cases[] = {
        {{"\"12\", \"poseId\"", "\"id_view\": 12"}, {"\"5\", \"poseId\"", "\"id_view\": 5"}, "two views with the id 5"},
        {{"\"320\"", "320"}, {"\"9999999999\"", "9999999999"}, "z z.jpg has no valid size"},
        {{"\"320\"", "320"}, {"[]", "[]"}, "z z.jpg has no valid size"},
        {{"\"observationId\": \"12\"", "\"key\": 12, \"value\": {\"id_feat\""},
         {"\"observationId\": \"13\"", "\"key\": 13, \"value\": {\"id_feat\""},
         "in view 13, which does not exist"},
        {{"\"10.5\"", "10.5"}, {"\"nan\"", "null"}, "an observation without a position"},
        {{"[\"10.5\", \"2e1\"]", "[10.5, 20]"}, {"[\"10.5\"]", "{\"0\": 1}"}, "an observation without a position"},
        {{"\"10.5\"", "10.5"}, {"1e999", "1e999"}, "a number that is too large"},
        {{"\"structure\"", "\"structure\""}, {"\"other\"", "\"other\""}, "has no structure"},
        {{"\"views\"", "\"views\""}, {"\"other\"", "\"other\""}, "which does not exist"},
        {{"/far/z z.jpg", "z z.jpg"}, {"/far/y.jpg", "\\u0000"}, " "},
    };
    for (const auto &[from, to, part] : cases)
        for (size_t n = 0; n < 2; n++) {
            const std::string path = in_folder(scenes[n].file);
            save_text(path, replaced(scenes[n].text, from[n], to[n]));
            assert_unreadable(path, part, [&] { return scenes[n].read(path); });
        }
}

// Position of a corner of the upright picture, in OpenSfM's terms: left or right, top or bottom.
std::string corner_of(const char *corner, double width, double height) {
    const double side = std::max(width, height);
    const double x = corner[1] == 'L' ? 0.0 : width - 1.0, y = corner[0] == 'T' ? 0.0 : height - 1.0;
    return std::to_string((x + 0.5 - width / 2) / side) + "\t" + std::to_string((y + 0.5 - height / 2) / side);
}

// EXIF 2.3, tag 274: where the 0th row and the 0th column of the stored picture are displayed. Checked are the
// displayed positions of the first pixel and of the last pixel in the first row.
void test_orientations(void **) {
    const char *const seen[8][2] = {{"TL", "TR"}, {"TR", "TL"}, {"BR", "BL"}, {"BL", "BR"},
                                    {"TL", "BL"}, {"TR", "BR"}, {"BR", "TR"}, {"BL", "TL"}};
    const std::string path = in_folder("tracks.csv"), file = in_folder("a.jpg"), other = in_folder("b.jpg");
    for (uint16_t orientation = 1; orientation <= 8; orientation++) {
        for (const std::string &name : {file, other}) {
            write_picture(name, make_smooth(48, 32, LENSPROF_LAYOUT_RGB));
            auto image = Exiv2::ImageFactory::open(name);
            image->exifData()["Exif.Image.Orientation"] = orientation;
            image->writeMetadata();
        }
        const double width = orientation < 5 ? 48 : 32, height = orientation < 5 ? 32 : 48;
        std::string text = "OPENSFM_TRACKS_VERSION_v2\n";
        for (int n = 0; n < 2; n++)
            for (const char *name : {"a.jpg", "b.jpg"})
                text += std::string(name) + "\t" + std::to_string(n) + "\t0\t"
                        + corner_of(seen[orientation - 1][n], width, height) + "\t0.01\t9\t9\t9\t-1\t-1\n";
        save_text(path, text);
        Reconstruction r = read_opensfm(path);
        const std::vector<std::string> files = find_pictures(r, "", false);
        assert_string_equal(files[0].c_str(), file.c_str());
        convert_coordinates(r, files);
        for (size_t n = 0; n < 4; n++) {
            assert_close(r.observations[n].xy[0], n < 2 ? 0 : 47, 1e-3);
            assert_close(r.observations[n].xy[1], 0, 1e-3);
        }
        assert_int_equal(r.cameras[0].width, 48);
    }
}

void test_pictures_of_other_sizes(void **) {
    const std::string path = make_database("database.db");
    for (const char *name : {"a.png", "b b.png", "c.png", "d.png"})
        write_picture(in_folder(name), make_smooth(320, 240, LENSPROF_LAYOUT_RGB));
    const Reconstruction read = read_colmap_database(path);
    const std::vector<std::string> files = find_pictures(read, "", false);
    Reconstruction r = read;
    assert_failure(LENSPROF_ERROR_READ, in_folder("a.png") + ": is 320 x 240 pixels, but " + path + " states 100 x 200",
                   [&] { convert_coordinates(r, files); });
    write_picture(in_folder("a.png"), make_smooth(100, 200, LENSPROF_LAYOUT_RGB));
    r = read;
    convert_coordinates(r, files);
    assert_place(r.observations[2], 100, 110);
    r = read;
    r.observations[1].xy[0] = 100.5f;
    assert_failure(LENSPROF_ERROR_READ, path + ": has a feature at 100.5, 20.0 in a.png, which has only 100 x 200",
                   [&] { convert_coordinates(r, files); });
    fs::remove(in_folder("d.png"));
    assert_failure(LENSPROF_ERROR_READ, path + ": 1 of its 4 pictures, the first d.png, are not in ",
                   [&] { find_pictures(read, "", false); });
    assert_failure(LENSPROF_ERROR_READ, "4 of its 4 pictures", [&] { find_pictures(read, in_folder("none"), false); });
    assert_true(find_pictures(read, in_folder("none"), true).empty());
}

#define TEST(name) cmocka_unit_test_setup(name, empty_folder)

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        TEST(test_opensfm),        TEST(test_damaged_opensfm), TEST(test_cut_opensfm),
        TEST(test_bundler),        TEST(test_damaged_bundler), TEST(test_scenes),
        TEST(test_damaged_scenes), TEST(test_orientations),    TEST(test_pictures_of_other_sizes),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
