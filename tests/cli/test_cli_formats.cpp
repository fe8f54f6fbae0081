// `lensprof profile export` and `import` of other programs' files: written by name, recognised by content.
#include "cli_runs.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/opcode_tag.hpp"

using namespace cli_runs;
using namespace picture_files;

namespace {

// A database with one profile of which every number is known.
void make_db() {
    save_text(
        work("one.json"),
        R"({"schema":1,"key":{"camera_maker":"Maker","camera_model":"Model 1","lens":"Lens 35mm","crop_factor":1.5,)"
        R"("focal_mm":35,"aperture":2,"distance_m":"infinity","processing":"jpeg"},"vignetting":{"k":[[-0.4,0.1,-0.1]],)"
        R"("center":[0.02,-0.01]},"response":{"kind":"gamma","gamma":2.0}})");
    must_exit(done, {"profile", "import", work("one.json"), "--db", work("p.db")});
}

Json show(const std::string &db) { return json_of({"profile", "show", "1", "--db", work(db), "--json"}); }

// M in the corner, and the grey value at a fifth of full irradiance.
void assert_same_curves(const Json &json, bool falloff, bool response, double tolerance = 2e-3) {
    double m = 1.0;
    for (const Json &k : json["vignetting"]["k"][0]) m += k.get<double>();
    assert_close(m, falloff ? 0.6 : 1.0, tolerance);
    const double grey = json["response"]["values"][0][205].get<double>();
    assert_close(grey, response ? std::sqrt(205 / 1023.0) : 205 / 1023.0, tolerance);
}

Words export_to(const std::string &file, const Words &more = {}) {
    return Words{"profile", "export", "1", "--db", work("p.db"), "-o", file} + more;
}

// A loss of black and white level, or of the image circle, is stated, by formats that lose them.
void test_levels_that_are_lost(void **) {
    make_db();
    Json json = show("p.db");
    json["levels"] = {{"black", {0.004, 0.004, 0.004}}, {"white", 0.0625}};
    json["image_circle"] = {{"center", {0.01, 0.0}}, {"radius", 0.8}};
    save_text(work("levels.json"), json.dump());
    must_exit(done, {"profile", "import", work("levels.json"), "--db", work("levels.db")});
    const Words frame = {"--encoding", "frame=600x400"};
    const struct {
        const char *file, *db;
        Words words;
        bool loses_levels, loses_circle;
    } cases[] = {
        {"l.xml", "levels.db", {}, true, true},       {"l.lcp", "levels.db", {}, true, true},
        {"pcalib.txt", "levels.db", {}, true, false}, {"l.csv", "levels.db", {}, true, false},
        {"l.png", "levels.db", frame, true, true},    {"l.tif", "levels.db", frame, true, true},
        {"held.json", "levels.db", {}, false, false}, {"none.xml", "p.db", {}, false, false},
    };
    for (const auto &one : cases) {
        const Outcome outcome =
            run_words(Words{"profile", "export", "1", "--db", work(one.db), "-o", work(one.file)} + one.words);
        assert_int_equal(outcome.code, done);
        const auto is_noted = [&](const std::string &what) {
            return contains(outcome.err, "profile 1: the file does not hold its " + what);
        };
        assert_int_equal(is_noted("black and white level"), one.loses_levels);
        assert_int_equal(is_noted("image circle"), one.loses_circle);
    }
}

// A map that is dark outside of a circle gives a profile with one.
void test_map_of_a_circle(void **) {
    constexpr uint32_t width = 300, height = 200;
    Picture map = make_noise(width, height, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY);
    const double half = 0.5 * std::hypot(width, height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double r = std::hypot(x - 0.5 * (width - 1), y - 0.5 * (height - 1)) / half;
            reinterpret_cast<uint16_t *>(map.pixels.data())[y * width + x] =
                static_cast<uint16_t>(r < 0.75 ? 60000 * (1 - 0.4 * r * r) : 0);
        }
    write_picture(work("circle.png"), map);
    must_exit(done, {"profile", "import", work("circle.png"), "--camera", "a", "--lens", "b", "--db", work("m.db")});
    const Json circle = json_of({"profile", "show", "1", "--db", work("m.db"), "--json"})["image_circle"];
    assert_close(circle["radius"].get<double>(), 0.75, 0.01);
}

// Arguments that select a file's format, then what is read back from it.
void test_round_trips(void **) {
    const Words frame = {"--encoding", "frame=600x400"}, camera = {"--camera", "Other"};
    const struct {
        const char *file;
        Words written, read;
        bool falloff, response;
    } cases[] = {
        {"a.json", {}, {}, true, true},
        {"a.xml", {}, {}, true, false},
        {"a.lcp", {}, {}, true, false},
        {"a.blob", {}, {}, true, true},
        {"pcalib.txt", {}, camera, false, true},
        {"a.csv", {}, camera, false, true},
        {"log.csv", {"--encoding", "curve=log"}, camera + Words{"--encoding", "curve=log"}, false, true},
        {"a.crf", {}, camera, false, true},
        {"a.vgn", frame, camera, true, false},
        {"vignette.png", frame, camera, true, false},
        {"eight.png", frame + Words{"--encoding", "depth=8"}, camera, true, false},
        {"gain.tif", frame, camera, true, false},
        {"small.tif", frame + Words{"--encoding", "grid=60x40"}, camera + frame, true, false},
        {"alsc.json", frame + Words{"--format", "alsc"}, camera + frame, true, false},
    };
    make_db();
    for (const auto &one : cases) {
        must_exit(done, export_to(work(one.file), one.written));
        fs::remove(work("q.db"));
        must_exit(done, Words{"profile", "import", work(one.file), "--db", work("q.db")} + one.read);
        assert_same_curves(show("q.db"), one.falloff, one.response, std::string(one.file) == "eight.png" ? 6e-3 : 2e-3);
    }
}

// A response and a falloff from two files form one profile.
void test_two_files_one_profile(void **) {
    make_db();
    must_exit(done, export_to(work("pcalib.txt")));
    must_exit(done, export_to(work("vignette.png"), {"--encoding", "frame=640x480"}));
    must_exit(done, {"profile", "import", work("pcalib.txt"), work("vignette.png"), "--camera", "Odometer", "--lens",
                     "Wide", "--focal", "8", "--db", work("q.db")});
    const Json json = show("q.db");
    assert_same_curves(json, true, true);
    assert_string_equal(json["key"]["camera_model"].get<std::string>().c_str(), "Odometer");
    assert_string_equal(json["provenance"]["source"].get<std::string>().c_str(), "pcalib.txt; vignette.png");
    const Words again = {"profile",
                         "import",
                         work("pcalib.txt"),
                         work("vignette.png"),
                         "--camera",
                         "Odometer",
                         "--lens",
                         "Wide",
                         "--focal",
                         "8",
                         "--db",
                         work("q.db"),
                         "--json"};
    assert_int_equal(json_of(again)["known"], 1);
}

// Opcodes are added to an existing picture; everything else in it stays.
void test_opcodes(void **) {
    make_db();
    const Picture picture = make_smooth(300, 200, LENSPROF_LAYOUT_RGB);
    for (const char *form : {"auto", "radial", "map"}) {
        write_picture(work("raw.tif"), picture);
        must_exit(done,
                  export_to(work("raw.tif"), {"--format", "opcodes", "--encoding", std::string("opcode=") + form}));
        assert_false(lensprof::read_opcode_lists(work("raw.tif")).list3.empty());
        assert_near_pixels(picture, read_picture(work("raw.tif")), 0);
        fs::remove(work("q.db"));
        must_exit(done, {"profile", "import", work("raw.tif"), "--camera", "Raw", "--db", work("q.db")});
        assert_same_curves(show("q.db"), true, false, 3e-3);
    }
}

// Camera, lens and setting of a falloff come from the picture's EXIF unless given on the command line.
void test_opcodes_name_their_camera(void **) {
    make_db();
    write_picture(work("raw.tif"), make_smooth(300, 200, LENSPROF_LAYOUT_RGB));
    PictureMetadata metadata = unknown_metadata();
    std::strcpy(metadata.key.camera_maker, "Canon");
    std::strcpy(metadata.key.camera_model, "Canon EOS 6D");
    std::strcpy(metadata.key.lens, "EF35mm f/2 IS USM");
    metadata.key.focal_mm = 35, metadata.key.aperture = 2;
    assert_true(write_metadata(work("raw.tif"), metadata));
    must_exit(done, export_to(work("raw.tif"), {"--format", "opcodes"}));
    must_exit(done, {"profile", "import", work("raw.tif"), "--aperture", "2.8", "--db", work("q.db")});
    const Json key = show("q.db")["key"];
    assert_true(key["camera_maker"] == "Canon" && key["camera_model"] == "Canon EOS 6D");
    assert_true(key["lens"] == "EF35mm f/2 IS USM" && key["processing"] == "raw");
    assert_close(key["focal_mm"].get<double>(), 35, 0);
    assert_close(key["aperture"].get<double>(), 2.8, 0);
    assert_true(key["distance_m"].is_null());
}

// Other opcodes of a picture are not lost, and no falloff is corrected twice.
void test_opcodes_of_others_stay(void **) {
    make_db();
    const auto list_of = [](uint8_t id) {
        std::vector<uint8_t> list(4 + 16, 0);
        list[3] = 1, list[7] = id, list[9] = 3;
        return list;
    };
    write_picture(work("warp.tif"), make_smooth(300, 200, LENSPROF_LAYOUT_RGB));
    lensprof::write_opcode_list(work("warp.tif"), work("warp.tif"), lensprof::tag_opcode_list3, list_of(1));
    assert_refused(usage, export_to(work("warp.tif"), {"--format", "opcodes"}), {"warp.tif", "would be lost"});
    write_picture(work("gain.tif"), make_smooth(300, 200, LENSPROF_LAYOUT_RGB));
    lensprof::write_opcode_list(work("gain.tif"), work("gain.tif"), lensprof::tag_opcode_list2, list_of(9));
    assert_refused(usage, export_to(work("gain.tif"), {"--format", "opcodes"}), {"gain.tif", "already"});
}

// A gain read as an attenuation is marked doubtful, and lookups skip it.
void test_wrong_sense_is_doubted(void **) {
    make_db();
    must_exit(done, export_to(work("gain.tif"), {"--encoding", "frame=60x40"}));
    const Json json =
        json_of({"profile", "import", work("gain.tif"), "--encoding", "sense=attenuation", "--camera", "C", "--lens",
                 "Wrong", "--focal", "9", "--aperture", "2", "--db", work("q.db"), "--json"});
    assert_true(contains(json["flagged"][0]["doubt"].get<std::string>(), "is it a gain?"));
    assert_refused(not_found, {"query", "--lens", "Wrong", "--focal", "9", "--aperture", "2", "--db", work("q.db")},
                   {"doubtful"});
}

void test_several_profiles(void **) {
    make_db();
    must_exit(done, {"profile", "import", work("one.json"), "--db", work("p.db")});
    must_exit(done, {"profile", "export", "--all", "--db", work("p.db"), "-o", work("all.json")});
    must_exit(done, {"profile", "export", "--lens", "Lens 35mm", "--db", work("p.db"), "-o", work("lens.xml")});
    assert_int_equal(json_of({"profile", "import", work("all.json"), "--db", work("q.db"), "--json"})["stored"], 1);
    assert_refused(not_found, {"profile", "export", "--lens", "None", "--db", work("p.db"), "-o", work("a.json")},
                   {"None"});
}

// The limit counts the values of all channels: 27 million pixels with three channels are too many.
void test_too_large_maps(void **) {
    save_text(
        work("three.json"),
        R"({"schema":1,"key":{"camera_model":"C","lens":"L","focal_mm":35,"processing":"jpeg"},"vignetting":)"
        R"({"k":[[-0.4,0.1,-0.1],[-0.3,0.1,-0.1],[-0.4,0.1,-0.1]],"center":[0,0]},"response":{"kind":"linear"}})");
    must_exit(done, {"profile", "import", work("three.json"), "--db", work("three.db")});
    for (const char *grid : {"5000x6000", "30000x889"})
        assert_refused(usage,
                       {"profile", "export", "1", "--db", work("three.db"), "-o", work("large.tif"), "--encoding",
                        "frame=6000x4000", "--encoding", std::string("grid=") + grid},
                       {"large.tif", "more than 80 million values", "give a smaller --encoding grid"});
    assert_false(fs::exists(work("large.tif")));
}

// A refused command neither stores nor writes anything.
void test_refused(void **) {
    make_db();
    must_exit(done, export_to(work("pcalib.txt")));
    must_exit(done, export_to(work("curve.csv")));
    const Words to = {"--db", work("p.db")};
    const auto import = [&](const Words &words) { return Words{"profile", "import"} + words + to; };
    assert_refused(usage, import({work("pcalib.txt")}), {"pcalib.txt", "--camera"});
    assert_refused(usage, import({work("pcalib.txt"), work("curve.csv"), "--camera", "C"}),
                   {"curve.csv", "pcalib.txt"});
    assert_refused(usage, import({work("one.json"), "--camera", "C"}), {"omit --camera"});
    save_text(work("notes"), "nothing of any format\n");
    assert_refused(usage, import({work("notes"), "--camera", "C"}), {"notes", "--format"});
    assert_refused(unreadable, import({work("notes"), "--format", "pcalib", "--camera", "C"}), {"notes"});
    assert_refused(unreadable, import({work("none.csv"), "--camera", "C"}), {"none.csv"});
    assert_refused(unreadable, import({"/dev/zero", "--format", "json"}), {"/dev/zero", "not a regular file"});
    assert_refused(usage, export_to(work("a.m")), {"a.m", ".csv"});
    assert_refused(usage, export_to(work("q.jpg"), {"--encoding", "frame=60x40", "--format", "map"}),
                   {"q.jpg", "JPEG"});
    assert_refused(usage, export_to(work("q.tif"), {"--encoding", "frame=60000x60000"}), {"q.tif", "--encoding grid"});
    save_text(work("falling.csv"), "0,0\n1,0.5\n2,0.4\n3,1\n");
    assert_refused(unreadable, import({work("falling.csv"), "--camera", "C", "--encoding", "strict=yes"}),
                   {"falling.csv", "line"});
    save_text(work("falling.csv"), "0,1\n1,0.5\n2,0.4\n3,0\n");
    assert_refused(unreadable, import({work("falling.csv"), "--camera", "C"}), {"falling.csv", "not a response"});
    save_text(work("cut.json"), text_of(work("one.json")).substr(0, 100));
    assert_refused(unreadable, import({work("one.json"), work("cut.json")}), {"cut.json"});
    save_text(work("nan.lcp"), "<x><CameraProfiles");
    assert_refused(unreadable, import({work("nan.lcp")}), {"nan.lcp"});
    save_text(work("tuning.json"), "{\"rpi.alsc\":{\"luminance_lut\":[1,1,1,1]}}");
    assert_refused(usage, import({work("tuning.json"), "--camera", "C"}), {"tuning.json", "--encoding frame"});
    assert_refused(unreadable, import({work("tuning.json"), "--camera", "C", "--encoding", "frame=60x40"}),
                   {"tuning.json"});
    assert_refused(usage, import({work("one.json"), "--encoding", "frame=60"}), {"--encoding frame", "WIDTHxHEIGHT"});
    assert_refused(usage, export_to(work("v.png")), {"v.png", "--encoding frame"});
    assert_refused(usage, export_to(work("v.png"), {"--encoding", "frame=60x40,sense=gain"}), {"v.png", ".tif"});
    assert_refused(unreadable, export_to(work("none.dng")), {"none.dng"});
    assert_refused(unreadable, export_to(work("one.json"), {"--format", "opcodes"}), {"one.json"});
    assert_refused(failed, export_to(work("none/a.json")), {"none/a.json"});
    assert_refused(usage, export_to("/dev/full", {"--format", "blob"}), {"/dev/full: ", "give the name of a file"});
    assert_refused(usage, export_to(work("v.vgn"), {"--encoding", "frame=1000000x2"}),
                   {"--encoding frame: 1000000 is not"});
}

Words import_words() { return {"profile", "import", "--db", work("new.db")}; }

// A curve with dips is stored with the largest change; above a level with a doubt.
void test_dips(void **) {
    std::string text;
    for (int i = 0; i < 256; i++) text += std::to_string(i == 100 ? 98.2 : i == 200 ? 199.8 : double(i)) + " ";
    save_text(work("dips.txt"), text);
    const Json json = json_of(import_words() + Words{work("dips.txt"), "--camera", "C", "--json"});
    assert_int_equal(json["changed"].size(), 1);
    assert_true(std::fabs(json["changed"][0]["levels"].get<double>() - .4) < .01);  // half of 99 - 98.2
    assert_int_equal(json["flagged"].size(), 0);
    text.replace(text.find("98.2"), 4, "94.0");
    save_text(work("dips.txt"), text);
    const std::string said = must_exit(done, import_words() + Words{work("dips.txt"), "--camera", "C"});
    assert_true(contains(said, "decreases in places") && contains(said, "doubtful: 1 profile"));
}

// Tuning files of several sensors: a profile each, named by the file; those without a table are listed.
void test_tuning_files(void **) {
    std::string table = "[";
    for (int i = 0; i < 192; i++)
        table += std::to_string(1 + .004 * (std::pow(i % 16 - 7.5, 2) + std::pow(i / 16 - 5.5, 2))) + ", ";
    table += "]";  // with a comma before it
    const std::string alsc = "\"rpi.alsc\": {\"n_iter\": 0, \"luminance_lut\": " + table + ", }";
    save_text(work("imx1.json"),
              "{\"version\": 2.0, \"target\": \"bcm2835\", \"algorithms\": [{\"rpi.awb\": {}}, {" + alsc + "}, ]}");
    save_text(work("imx2.json"), "{\"rpi.awb\": {}, " + alsc + "}");
    save_text(work("imx3.json"), "{\"version\": 2.0, \"algorithms\": [{\"rpi.awb\": {}}]}");
    const Words files = {work("imx1.json"), work("imx2.json"), work("imx3.json"), "--encoding", "frame=1640x1232"};
    const Json json = json_of(import_words() + files + Words{"--json"});
    assert_int_equal(json["stored"], 2);
    assert_int_equal(json["without_table"].size(), 1);
    assert_true(contains(json["without_table"][0]["file"].get<std::string>(), "imx3.json"));
    const Json list = json_of({"profile", "list", "--db", work("new.db"), "--json"})["profiles"];
    assert_true(list[0]["key"]["camera_model"] == "imx1" && list[1]["key"]["camera_model"] == "imx2");
    assert_refused(not_found, import_words() + Words{work("imx3.json"), "--encoding", "frame=1640x1232"},
                   {"imx3.json", "no table"});
    assert_refused(usage, import_words() + files + Words{"--camera", "C"}, {"imx2.json", "one after the other"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {CLI_TEST(test_round_trips),
                                CLI_TEST(test_levels_that_are_lost),
                                CLI_TEST(test_map_of_a_circle),
                                CLI_TEST(test_dips),
                                CLI_TEST(test_tuning_files),
                                CLI_TEST(test_two_files_one_profile),
                                CLI_TEST(test_opcodes),
                                CLI_TEST(test_opcodes_name_their_camera),
                                CLI_TEST(test_opcodes_of_others_stay),
                                CLI_TEST(test_wrong_sense_is_doubted),
                                CLI_TEST(test_several_profiles),
                                CLI_TEST(test_too_large_maps),
                                CLI_TEST(test_refused)};
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
