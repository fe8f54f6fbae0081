// Which typical response build uses as the prior: according to EXIF in the pictures' own files.
#include <exiv2/exiv2.hpp>  // before cmocka, which makes a macro of `fail`

#include "cli_runs.hpp"

using namespace cli_runs;

namespace {

struct Case {
    const char *maker, *model, *kind, *from;
    const char *software = "1.00";
};

std::string jpeg_files() {
    const std::string path = work("jpeg");
    must_exit(done, {"simulate", "-o", path, "--size", "320x240", "--images", "4", "--format", "jpeg", "--exif",
                     "--response", "film"});
    return path;
}

void set_camera(const std::string &folder, const Case &camera) {
    for (int i = 0; i < 4; i++) {
        auto image = Exiv2::ImageFactory::open(folder + "/img00" + std::to_string(i) + ".jpg");
        image->readMetadata();
        image->exifData()["Exif.Image.Make"] = camera.maker;
        image->exifData()["Exif.Image.Model"] = camera.model;
        image->exifData()["Exif.Image.Software"] = camera.software;
        image->writeMetadata();
    }
}

Json fitted(const std::string &path, const Words &more) {
    return json_of(Words{"build", path + "/pano.pto", "--no-store", "--json", "--fit", "pairs=2000,stored=none"}
                   + more);
}

void test_jpeg_files(void **) {
    const Case cases[] = {{"NIKON CORPORATION", "NIKON D750", "camera", "pictures"},
                          {"SONY", "ILCE-7M3", "camera", "pictures"},
                          {"Sony", "XQ-CT72", "phone", "pictures"},
                          {"samsung", "SM-A528B", "phone", "pictures"},
                          {"Apple", "iPhone 12", "phone", "pictures"},
                          {"Nikon", "COOLSCAN V ED", "any", "none"},
                          // raw converters copy the camera's name, but have curves of their own
                          {"SONY", "ILCE-7M3", "any", "none", "darktable 4.2.1"},
                          {"SONY", "ILCE-7M3", "any", "none", "Adobe Photoshop Lightroom Classic 12.0 (Windows)"},
                          {"samsung", "SM-A528B", "any", "none", "lensprof"}};
    const std::string path = jpeg_files();
    std::map<std::string, double> sigma;
    for (const Case &one : cases) {
        set_camera(path, one);
        const Json json = fitted(path, {"--fit", "exif-sigma=0"});
        assert_string_equal(json["gamma"]["camera_kind"].get<std::string>().c_str(), one.kind);
        assert_string_equal(json["gamma"]["camera_kind_from"].get<std::string>().c_str(), one.from);
        sigma[one.kind] = json["gamma"]["sigma"].get<double>();
    }
    assert_true(sigma["camera"] < 0.5 * sigma["any"]);
}

// An option overrides EXIF.
void test_option(void **) {
    const std::string path = jpeg_files();
    set_camera(path, {"Apple", "iPhone 12", "", ""});
    const Json json = fitted(path, {"--fit", "camera-kind=film"});
    assert_string_equal(json["gamma"]["camera_kind"].get<std::string>().c_str(), "film");
    assert_string_equal(json["gamma"]["camera_kind_from"].get<std::string>().c_str(), "option");
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {CLI_TEST(test_jpeg_files), CLI_TEST(test_option)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
