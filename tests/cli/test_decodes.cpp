// How often a picture is decoded, counted by a function that replaces one of libjpeg.
#include <atomic>

#include <dlfcn.h>

#include <cstdio>

#include <jpeglib.h>

#include "photo/pictures/picture.hpp"

#include "calibrate_runs.hpp"

using namespace calibrate_runs;

namespace {

std::atomic<int> decodes;

}  // namespace

extern "C" boolean jpeg_start_decompress(j_decompress_ptr info) {
    static const auto original =
        reinterpret_cast<boolean (*)(j_decompress_ptr)>(dlsym(RTLD_NEXT, "jpeg_start_decompress"));
    decodes++;
    return original(info);
}

namespace {

void make_jpegs() {
    fs::create_directories(work("jpegs"));
    for (const std::string name : {"img000", "img001", "img002", "img003"})
        write_picture(work("jpegs/" + name + ".jpg"), read_picture(scene(name + ".png")));
}

// For registration, for sampling and for correction; what is drawn of the pictures is made while they are corrected.
void test_a_folder_with_a_report(void **) {
    if (is_missing()) return;
    make_jpegs();
    const Words words = calibrated(work("jpegs"), {"--no-store", "--report", work("page.html")});
    decodes = 0;
    assert_now(json_of(words), true, 1, 4);
    assert_int_equal(decodes, 3 * 4 + 1);  // and the mosaic, which the page shows
    decodes = 0;
    assert_now(json_of(words), false, 0, 0);
    assert_int_equal(decodes, 4 + 1);  // the page again, of the pictures corrected again
}

// A mosaic and a sheet that a later run draws are those that the first run would have drawn.
void test_drawn_again(void **) {
    if (is_missing()) return;
    make_jpegs();
    const Json json = json_of(calibrated(work("jpegs"), {"--no-store"}));
    const std::string names[] = {json["panoramas"][0]["preview"], work("out/calibrate_sheet.jpg")};
    for (const std::string &name : names) {
        const Bytes drawn = load(name);
        fs::remove(name);
        assert_now(json_of(calibrated(work("jpegs"), {"--no-store"})), false, 0, 0);
        assert_true(load(name) == drawn);
    }
}

}  // namespace

int main() {
    const struct CMUnitTest tests[] = {CLI_TEST(test_a_folder_with_a_report), CLI_TEST(test_drawn_again)};
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
