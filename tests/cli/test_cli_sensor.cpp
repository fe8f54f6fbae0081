// The size of a picture's sensor: from the database's table of cameras if possible, otherwise from EXIF.
#include "cli_runs.hpp"

#include <lensprof/store.h>

#include "photo/calibration/profile_store.hpp"
#include "photo/pictures/sensor.hpp"

using namespace cli_runs;

namespace {

struct Entry {
    const char *maker, *model, *other_model, *variant;
    double crop_factor;
};

const Entry entries[] = {
    {"Canon", "Canon EOS 600D", "EOS 600D", "", 1.6}, {"Canon", "Canon G", "G (3:2)", "", 2.72},
    {"Canon", "Canon G 4:3", "G (4:3)", "", 2.94},    {"Canon", "Canon G Mark II", "G Mark II (3:2)", "", 3},
    {"Panasonic", "DMC-LX3", "", "4:3", 4.7},         {"Panasonic", "DMC-LX3", "", "16:9", 5.75},
    {"Panasonic", "DMC-LX5", "", "4:3", 4.71},        {"Fujifilm", "F810", "", "", 4.5},
    {"Fujifilm", "F810", "", "wide mode", 4.9},
};

// The table, and a lens at 50 mm f/2 measured on a 36 mm x 24 mm sensor, k1 -0.4.
std::string make_database() {
    lensprof_store *store = nullptr;
    const std::string path = work("p.db");
    assert_ok(lensprof_store_open(path.c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    for (const Entry &entry : entries) {
        lensprof_camera_model camera;
        lensprof_camera_model_init(&camera);
        std::strcpy(camera.maker, entry.maker);
        std::strcpy(camera.model, entry.model);
        std::strcpy(camera.other_model, entry.other_model);
        std::strcpy(camera.variant, entry.variant);
        camera.crop_factor = entry.crop_factor;
        assert_ok(lensprof_store_put_camera(store, &camera, nullptr));
    }
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    std::strcpy(p->key.lens, "Lens 50mm");
    p->key.focal_mm = 50;
    p->key.aperture = 2;
    p->key.crop_factor = 1;
    p->key.distance_m = INFINITY;
    p->vignetting[0].k[0] = -0.4;
    assert_ok(lensprof_store_put(store, p.get(), nullptr, nullptr));
    lensprof_store_close(store);
    return path;
}

lensprof_profile_key key_of(const char *maker, const char *model) {
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    std::strcpy(key.camera_maker, maker);
    std::strcpy(key.camera_model, model);
    return key;
}

void test_table(void **) {
    const std::string db = make_database();
    const struct {
        const char *maker, *model;
        PictureSize picture;
        double crop_factor;
    } cases[] = {
        {"Canon", "Canon EOS 600D", {600, 400}, 1.6},
        {"Canon", "EOS REBEL T3i", {}, 1.6},
        {"Canon", "Canon G", {600, 400}, 2.72},
        {"Canon", "Canon G", {400, 600}, 2.72},
        {"Canon", "Canon G", {1600, 1200}, 2.94},
        {"Canon", "Canon G", {500, 500}, LENSPROF_UNKNOWN},
        {"Canon", "Canon G", {}, LENSPROF_UNKNOWN},
        {"Canon", "Canon G Mark II", {600, 400}, 3},
        {"Panasonic", "DMC-LX3", {4000, 3000}, 4.7},
        {"Panasonic", "DMC-LX3", {3968, 2232}, 5.75},
        {"Panasonic", "DMC-LX5", {4000, 3000}, 4.71},
        {"Panasonic", "DMC-LX5", {1600, 900}, LENSPROF_UNKNOWN},
        {"Fujifilm", "F810", {800, 600}, LENSPROF_UNKNOWN},
        {"Nikon", "EOS 600D", {600, 400}, LENSPROF_UNKNOWN},
        {"", "", {600, 400}, LENSPROF_UNKNOWN},
    };
    const Store store = open_store(db, LENSPROF_STORE_READ);
    for (const auto &one : cases) {
        const double crop = crop_factor_in_table(store.get(), key_of(one.maker, one.model), one.picture);
        if (std::fabs(crop - one.crop_factor) > 1e-12)
            fail_msg("%s %ux%u: %g", one.model, one.picture.width, one.picture.height, crop);
        assert_close(crop_factor_in_files({db}, key_of(one.maker, one.model), one.picture), crop, 0);
    }
    assert_close(crop_factor_in_files({work("none.db")}, key_of("Canon", "EOS 600D"), {}), LENSPROF_UNKNOWN, 0);
    save_text(work("bad.db"), "no database");
    assert_close(crop_factor_in_files({work("bad.db")}, key_of("Canon", "EOS 600D"), {}), LENSPROF_UNKNOWN, 0);
}

// For keys of new profiles: first the option, then the table, then EXIF.
void test_keys_of_profiles(void **) {
    StoreOptions o;
    o.dbs = {make_database()};
    lensprof_profile_key key = key_of("Canon", "Canon EOS 600D");
    key.crop_factor = 2.8;
    assert_close(override_key(key, {600, 400}, o, "a.jpg").crop_factor, 1.6, 0);
    o.crop_factor = 1.7;
    assert_close(override_key(key, {600, 400}, o, "a.jpg").crop_factor, 1.7, 0);
    o.crop_factor = LENSPROF_UNKNOWN;
    o.camera = "Other";
    assert_close(override_key(key, {600, 400}, o, "a.jpg").crop_factor, 2.8, 0);
}

// A grey picture from a camera with a smaller sensor than the lens's profile; lensprof does not write sensor sizes into
// EXIF.
double corner_of(const char *maker, const char *model, const Words &more) {
    constexpr uint32_t width = 60, height = 40;
    constexpr double grey = 0.3;
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB);
    std::fill_n(reinterpret_cast<float *>(picture.pixels.data()), width * height * 3, float(grey));
    PictureMetadata metadata = unknown_metadata();
    metadata.key = key_of(maker, model);
    std::strcpy(metadata.key.lens, "Lens 50mm");
    metadata.key.focal_mm = 50;
    metadata.key.aperture = 2;
    metadata.key.distance_m = INFINITY;
    WriteOptions options;
    options.metadata = &metadata;
    write_picture(work("a.tif"), picture, options);
    must_exit(done, Words{"apply", "--set", "response=linear", "--overwrite", "-o", work("out"), "--db", work("p.db"),
                          work("a.tif")}
                        + more);
    const Picture out = read_picture(work("out/a.tif"));
    return grey / double(reinterpret_cast<const float *>(out.pixels.data())[0]);
}

void test_apply(void **) {
    make_database();
    const double r2 = (59.0 * 59 + 39 * 39) / (60 * 60 + 40 * 40);
    assert_close(corner_of("Canon", "Canon EOS 600D", {}), 1 - 0.4 * r2 / (1.6 * 1.6), 1e-3);
    assert_close(corner_of("Canon", "Canon EOS 600D", {"--key", "crop-factor=1"}), 1 - 0.4 * r2, 1e-3);
    assert_close(corner_of("Canon", "Canon G", {}), 1 - 0.4 * r2 / (2.72 * 2.72), 1e-3);
    assert_close(corner_of("Canon", "Else", {"--camera", "EOS REBEL T3i"}), 1 - 0.4 * r2 / (1.6 * 1.6), 1e-3);
}

// The same without a picture: the table gives the sensor of the named camera, but not the format used.
void test_query(void **) {
    make_database();
    const auto corner = [](const Words &more) {
        const Json found = json_of(Words{"query", "--json", "--db", work("p.db"), "--lens", "Lens 50mm", "--focal",
                                         "50", "--aperture", "2", "--key", "processing=jpeg"}
                                   + more);
        return 1 + found["vignetting"]["k"][0][0].get<double>();
    };
    assert_close(corner({"--key", "maker=Canon", "--camera", "Canon EOS 600D"}), 1 - 0.4 / (1.6 * 1.6), 1e-9);
    assert_close(corner({"--key", "maker=Canon", "--camera", "Canon EOS 600D", "--key", "crop-factor=1"}), 1 - 0.4,
                 1e-9);
    assert_close(corner({"--camera", "Nobody's"}), 1 - 0.4, 1e-9);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_table), CLI_TEST(test_keys_of_profiles), CLI_TEST(test_apply),
                                CLI_TEST(test_query)};
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
