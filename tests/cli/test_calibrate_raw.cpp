// `calibrate` of camera raw files together with other files of the same names and scenes.
#include "calibrate_runs.hpp"
#include "raw_runs.hpp"

using namespace raw_runs;
using calibrate_runs::is_missing;

namespace {

Json run_on(const std::string &folder, const Words &more = {}) {
    return json_of(Words{"calibrate", folder, "-o", work("out"), "--no-store", "--json"} + more);
}

std::string reason_of(const Json &json, const std::string &name) {
    for (const Json &one : json["left_out"])
        if (fs::path(one["file"].get<std::string>()).filename() == name) return one["reason"];
    fail_msg("%s is not left out: %s", name.c_str(), json.dump().c_str());
    return {};
}

// Other files with the name of a raw file are reported, and of two equal raw files one is used.
void test_one_stem(void **) {
    needs_libraw();
    if (is_missing()) return;
    const std::string folder = work("pictures");
    make_mosaics(folder);
    Picture small = read_picture(folder + "/img002.dng");
    small.icc.clear();
    write_picture(folder + "/img002.png", small);
    small.pixels[0] ^= 1;
    write_picture(folder + "/img002.tif", small);
    Bytes other = load(folder + "/img003.dng");
    other.push_back(0);
    save(folder + "/img004.NEF", other);
    const Json json = run_on(folder);
    assert_true(contains(reason_of(json, "img002.png"), "img002.dng is used instead"));
    assert_true(contains(reason_of(json, "img002.tif"), "img002.dng is used instead"));
    assert_true(contains(reason_of(json, "img004.dng"), "like that of img004.NEF, which is used instead"));
    assert_int_equal(json["found"], 9);
    assert_int_equal(json["found"].get<size_t>(), json["pictures"].size() + json["left_out"].size());
}

// Raw files and rendered pictures cannot share a response: the others of the scene are a separate panorama.
void test_one_lens(void **) {
    needs_libraw();
    if (is_missing()) return;
    const std::string folder = work("pictures");
    must_exit(done, {"simulate", "-o", work("rendered"), "--images", "6", "--size", "480x360", "--vignetting",
                     "-0.4,0.1,-0.05", "--set", "noise=1,test-points=2000"});
    make_mosaics(folder);
    for (const char *name : {"3", "4", "5"}) {
        fs::remove(folder + "/img00" + name + ".dng");
        fs::copy_file(work(std::string("rendered/img00") + name + ".png"), folder + "/r" + name + ".png");
    }
    const Json json = run_on(folder, {"--one-lens"});
    assert_int_equal(json["panoramas"].size(), 2);
    for (const Json &panorama : json["panoramas"]) {
        assert_int_equal(panorama["pictures"], 3);
        if (panorama["result"].is_null()) fail_msg("%s", panorama.dump().c_str());
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_one_stem),
        CLI_TEST(test_one_lens),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
