// `lensprof flat` of a folder: settings by EXIF, names and a table, a result for each, the lens as one file.
#include "raw_runs.hpp"

#include <set>

#include "photo/base/format.hpp"
#include "photo/base/library.hpp"
#include "photo/cards/card_names.hpp"
#include "photo/cards/lens_cards.hpp"
#include "photo/cards/setting_table.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/registration/registration.hpp"

namespace {

using namespace raw_runs;

constexpr uint32_t width = 240, height = 160;

struct Card {
    double focal_mm = LENSPROF_UNKNOWN, aperture = LENSPROF_UNKNOWN;
    const char *camera = "Box 1", *lens = "EF24-70mm f/2.8";
    double k1 = -0.4, texture = 0.0;
    uint64_t seed = 7;
    bool clipped = false;
    double light = 0.0;                  // brighter in the middle: exp(-light r^2)
    double scene = 0.0;                  // contrast of things of 20 px on it
    double counts = 0.0;                 // float samples, of which so many are full scale
    double black = 0.0;                  // without light, share of full scale
    double middle = 0.5, noise = 0.002;  // shares of full scale
    double largest = 1.0;                // likewise, at which samples saturate
};

// A value per square of 20 px, 0..1.
double thing_at(uint32_t x, uint32_t y) { return (x / 20 * 7 + y / 20 * 5) % 11 / 10.0; }

std::string shoot(const std::string &name, const Card &card) {
    const uint32_t sample = card.counts > 0.0 ? LENSPROF_SAMPLE_F32 : LENSPROF_SAMPLE_U16;
    Picture picture = make_noise(width, height, sample, LENSPROF_LAYOUT_RGB);
    const lensprof_vignetting falloff{{card.k1, 0.05, -0.02}, {0.0, 0.0}};
    uint64_t random = card.seed;
    auto *at = reinterpret_cast<uint16_t *>(picture.pixels.data());
    auto *count = reinterpret_cast<float *>(picture.pixels.data());
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const double r2 = lensprof_vignetting_r2(&falloff, width, height, x, y, nullptr);
            double light = (card.clipped ? 1.3 : card.middle) * lensprof_vignetting_eval(&falloff, r2, nullptr);
            light *= std::exp(-card.light * r2);
            light *= 1.0 + card.texture * std::sin(0.35 * x) * std::sin(0.3 * y);
            light *= 1.0 - card.scene * thing_at(x, y);
            for (uint32_t c = 0; c < 3; c++) {
                const double value =
                    card.black
                    + (1.0 - card.black) * std::clamp(light + card.noise * lp_normal(&random), 0.0, card.largest);
                if (card.counts > 0.0)
                    *count++ = static_cast<float>(card.counts * value);
                else
                    *at++ = static_cast<uint16_t>(std::lround(65535.0 * value));
            }
        }
    PictureMetadata metadata = unknown_metadata();
    lensprof_profile_key &key = metadata.key;
    set_text(key.camera_model, sizeof key.camera_model, card.camera);
    set_text(key.lens, sizeof key.lens, card.lens);
    key.focal_mm = card.focal_mm, key.aperture = card.aperture;
    metadata.f_number = card.aperture;
    WriteOptions options;
    options.metadata = &metadata;
    const std::string path = in_folder(name);
    fs::create_directories(fs::path(path).parent_path());
    write_picture(path, picture, options);
    return path;
}

constexpr double focals[] = {24.0, 70.0}, apertures[] = {2.8, 5.6, 11.0};

double k1_of(double focal, double aperture) { return -0.5 * std::sqrt(24.0 / focal) * std::sqrt(2.8 / aperture); }

// Two pictures of each of six settings.
std::string make_lens(const std::string &name) {
    for (const double focal : focals)
        for (const double aperture : apertures)
            for (uint64_t n = 0; n < 2; n++) {
                Card card{focal, aperture};
                card.k1 = k1_of(focal, aperture), card.seed = 11 + n;
                shoot(format("%s/%g_%g_%d.tif", name.c_str(), focal, aperture, static_cast<int>(n)), card);
            }
    return in_folder(name);
}

Words flat_of(const Words &inputs, const Words &more = {}) {
    return Words{"flat"} + inputs + Words{"--linear", "--no-store"} + more;
}

// Every setting is measured alone, and stored; the numbers do not depend on how the pictures are given.
void test_a_folder(void **) {
    const std::string lens = make_lens("lens"), db = in_folder("lens.db");
    const Json json = json_of({"flat", lens, "--linear", "--db", db, "--json"});
    assert_int_equal(json["settings"].size(), 6);
    size_t n = 0;
    for (const double focal : focals)
        for (const double aperture : apertures) {
            const Json &setting = json["settings"][n++];
            assert_true(setting["key"]["focal_mm"] == focal && setting["key"]["aperture"] == aperture);
            assert_true(setting["usable"] == true && setting["files"].size() == 2
                        && setting["result"]["profile"].is_number());
            const double corner = 1.0 + k1_of(focal, aperture) + 0.05 - 0.02;
            assert_float_equal(setting["corner"].get<double>(), corner, 0.005);
        }
    assert_true(json["left_out"].empty() && json["lens_file"].is_null());
    assert_int_equal(json_of({"profile", "list", "--json", "--db", db})["profiles"].size(), 6);
    const Json alone =
        json_of(flat_of({lens + "/24_2.8_0.tif", lens + "/24_2.8_1.tif"}, {"--json", "--fit", "own-light=yes"}));
    assert_true(alone["vignetting"] == json["settings"][0]["result"]["vignetting"]);
    const std::string table = must_exit(done, flat_of({lens}));
    assert_true(contains(table, "24 mm, f/2.8") && contains(table, "good") && !contains(table, "take it again"));
}

void test_the_same_for_any_number_of_threads(void **) {
    CardOptions o;
    o.linear = true, o.store.no_store = true;
    NoticeList events;
    const CardSettings settings = card_settings({make_lens("threads")}, o, nullptr, events);
    const auto one = measure_settings(o, settings, 1, events), four = measure_settings(o, settings, 4, events);
    assert_int_equal(one.size(), 6);
    for (size_t i = 0; i < one.size(); i++)
        assert_memory_equal(&one[i].fit->fit.vignetting, &four[i].fit->fit.vignetting,
                            sizeof one[i].fit->fit.vignetting);
}

// The lens as a file, and a table.
void test_outputs(void **) {
    const std::string lens = make_lens("outputs"), xml = in_folder("lens.xml"), csv = in_folder("lens.csv"),
                      page = in_folder("lens.html");
    must_exit(done, flat_of({lens}, {"-o", xml, "-o", csv, "--report", page, "--key", "crop-factor=1"}));
    const std::string text = text_of(xml);
    assert_true(contains(text, "<lensdatabase") && contains(text, "24-70mm f/2.8</model>"));
    assert_true(contains(text, "focal=\"24\" aperture=\"2.8\" distance=\"10\" k1=\"-0.")
                && contains(text, "distance=\"1000\""));
    assert_int_equal(text.find("<lens>"), text.rfind("<lens>"));
    const std::string rows = text_of(csv);
    assert_int_equal(std::count(rows.begin(), rows.end(), '\n'), 7);
    assert_true(contains(rows, "Box 1,EF24-70mm f/2.8,24,2.8,,2,yes,"));
    assert_true(contains(text_of(page), "\"kind\":\"lens\""));
    must_exit(done, {"profile", "import", xml, "--db", in_folder("back.db")});
    const Disk before = disk();
    assert_refused(usage, flat_of({lens}, {"-o", lens + "/24_2.8_0.tif"}), {"24_2.8_0.tif", ".xml"});
    assert_refused(usage, flat_of({lens}, {"-o", in_folder("x.xml"), "--report", in_folder("x.xml")}), {"x.xml"});
    assert_refused(usage, flat_of({lens}, {"-o", in_folder("x.xml")}), {"x.xml", "crop factor", "--key crop-factor"});
    assert_refused(usage, flat_of({lens}, {"--bundle", in_folder("same.zip"), "-o", in_folder("same.zip")}),
                   {"same.zip"});
    save_text(in_folder("own.csv"), "file,lens\n24*,A\n");
    assert_refused(usage, flat_of({lens}, {"-o", in_folder("own.csv"), "--key", "table=" + in_folder("own.csv")}),
                   {"own.csv", "overwritten"});
    assert_true(text_of(in_folder("own.csv")) == "file,lens\n24*,A\n");
    fs::remove(in_folder("own.csv"));
    assert_refused(usage, flat_of({lens}, {"--card", "0,0,9,9", "--card", "0,0,9,9"}), {"2 values for 12 pictures"});
    shoot("outputs/other.tif", Card{24.0, 2.8, "Box 2"});
    assert_refused(usage, flat_of({lens}, {"-o", in_folder("two.xml"), "--key", "crop-factor=1"}),
                   {"holds one lens", "Box 2"});
    fs::remove(lens + "/other.tif");
    assert_true(disk() == before);
}

// A mosaic of a card as a DNG with EXIF, with a black level of 6 % of the range.
std::string shoot_raw(const std::string &name, const Card &card, const Bytes &opcodes = {}) {
    Dng dng;
    dng.width = width, dng.height = height, dng.white = 16383, dng.black = {1024, 1020, 1028, 1024};
    dng.maker = "Box", dng.model = "Box 1", dng.lens = card.lens;
    dng.focal_mm = card.focal_mm, dng.f_number = card.aperture, dng.opcodes = opcodes;
    const lensprof_vignetting falloff{{card.k1, 0.05, -0.02}, {0.0, 0.0}};
    const double colour[] = {0.35, 0.5, 0.4};
    uint64_t random = card.seed;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const size_t site = y % 2 * 2 + x % 2;
            const double r2 = lensprof_vignetting_r2(&falloff, width, height, x, y, nullptr),
                         light = colour[dng.pattern[site]] * lensprof_vignetting_eval(&falloff, r2, nullptr)
                                 + 0.002 * lp_normal(&random);
            dng.values.push_back(
                static_cast<uint16_t>(std::lround(dng.black[site] + light * (dng.white - dng.black[site]))));
        }
    const std::string path = in_folder(name);
    fs::create_directories(fs::path(path).parent_path());
    save(path, dng_bytes(dng));
    return path;
}

// OpcodeList3 with FixVignetteRadial (DNG 1.7): k0 = 0.5 about the middle.
Bytes radial_opcode() {
    Bytes bytes;
    const auto word = [&](uint64_t value, int size) {
        for (int i = size - 1; i >= 0; i--) bytes.push_back(static_cast<uint8_t>(value >> 8 * i));
    };
    word(1, 4), word(3, 4), word(0x01030000, 4), word(1, 4), word(7 * 8, 4);
    for (const double number : {0.5, 0.0, 0.0, 0.0, 0.0, 0.5, 0.5}) {
        uint64_t bits;
        std::memcpy(&bits, &number, sizeof bits);
        word(bits, 8);
    }
    return bytes;
}

// The black level that a raw file states is subtracted once. Its opcodes are instructions for its development: the
// sensor's values show the whole falloff with them as without.
void test_raw_cards(void **) {
    needs_libraw();
    std::map<double, double> k1;
    for (const double aperture : apertures) {
        Card card{24.0, aperture};
        card.k1 = k1[aperture] = k1_of(24.0, aperture);
        shoot_raw(format("raw/%g.dng", aperture), card, aperture == 5.6 ? radial_opcode() : Bytes());
    }
    const std::string xml = in_folder("raw.xml");
    const Json json = json_of({"flat", in_folder("raw"), "--no-store", "-o", xml, "--key", "crop-factor=1", "--json"});
    assert_int_equal(json["settings"].size(), 3);
    assert_true(json["left_out"].empty());
    for (const Json &setting : json["settings"]) {
        const Json &key = setting["key"];
        assert_true(setting["usable"] == true && key["lens"] == "EF24-70mm f/2.8" && key["camera_model"] == "Box 1");
        assert_true(key["processing"] == "raw");
        const double corner = 1.0 + k1[key["aperture"].get<double>()] + 0.05 - 0.02;
        assert_float_equal(setting["corner"].get<double>(), corner, 0.005);
    }
    const std::string text = text_of(xml);
    assert_int_equal(text.find("<lens>"), text.rfind("<lens>"));
    assert_true(contains(text, "focal=\"24\" aperture=\"5.6\""));
}

// What is bad, and what to do; the others are measured.
void test_bad_cards(void **) {
    const std::string lens = make_lens("bad");
    Card bad{35.0, 4.0};
    bad.clipped = true;
    shoot("bad/clipped.tif", bad);
    bad.clipped = false, bad.texture = 0.1, bad.aperture = 8.0;
    shoot("bad/textured.tif", bad);
    save_text(lens + "/broken.tif", "no picture");
    fs::copy_file(lens + "/24_2.8_0.tif", lens + "/copy.tif");
    shoot("bad/unknown.tif", Card{});
    const Json json = json_of(flat_of({lens}, {"--json"}), not_usable);
    std::map<std::string, bool> usable;
    for (const Json &setting : json["settings"]) usable[setting["label"]] = setting["usable"];
    assert_int_equal(usable.size(), 8);
    assert_false(usable["35 mm, f/4"] || usable["35 mm, f/8"]);
    assert_true(usable["24 mm, f/2.8"] && usable["70 mm, f/11"]);
    std::string reasons;
    for (const Json &card : json["left_out"]) reasons += card["reason"].get<std::string>() + "\n";
    assert_int_equal(json["left_out"].size(), 3);
    assert_true(contains(reasons, "broken.tif") && contains(reasons, "copy.tif: a copy of")
                && contains(reasons, "unknown.tif"));
    const Outcome printed = run_words(flat_of({lens}));
    assert_int_equal(printed.code, not_usable);
    assert_true(contains(printed.out, "take it again") && contains(printed.out, "left out  3 of 17 pictures"));
    fs::create_directories(in_folder("empty"));
    assert_refused(usage, flat_of({in_folder("empty")}), {"folder without pictures"});
    save_text(in_folder("empty/a.tif"), "no picture");
    assert_refused(unreadable, flat_of({in_folder("empty")}), {"a.tif"});
}

// A list of options has a value per picture given.
void test_lists_are_of_all_pictures(void **) {
    const std::string lens = make_lens("lists");
    const Words files = {lens + "/24_2.8_0.tif", lens + "/24_5.6_0.tif", lens + "/24_2.8_1.tif",
                         lens + "/24_5.6_1.tif"};
    const Json json = json_of(flat_of(files, {"--json", "--rotation", "0,0,90,180"}));
    assert_true(json["settings"][0]["result"]["images"][1]["rotation_deg"] == 90.0);
    assert_true(json["settings"][1]["result"]["images"][1]["rotation_deg"] == 180.0);
}

void test_settings_of_names(void **) {
    const auto of = [](const char *path) { return setting_of_names(path); };
    lensprof_profile_key key = of("x/vignetting_10/Canon_EF_24-70mm_f__2.8L--024mm--2.8_IMG_1.CR2");
    assert_string_equal(key.lens, "Canon EF 24-70mm f/2.8L");
    assert_true(key.focal_mm == 24.0 && key.aperture == 2.8 && key.distance_m == 10.0);
    key = of("vignetting/Lens--35mm--2.8.CR2");
    assert_true(key.focal_mm == 35.0 && std::isinf(key.distance_m));
    key = of("50mm--2.tif");
    assert_true(key.focal_mm == 50.0 && key.aperture == 2.0 && !*key.lens);
    key = of("x0--50mm--2.tif");
    assert_true(key.focal_mm == 50.0 && key.aperture == 2.0 && std::string(key.lens) == "x0");
    key = of("cards/50mm/f4/0.5m/IMG_0012.dng");
    assert_true(key.focal_mm == 50.0 && key.aperture == 4.0 && key.distance_m == 0.5 && !*key.lens);
    key = of("EF 50mm f1.4/f8_2.tif");  // the folder has the name of a lens
    assert_true(key.focal_mm == LENSPROF_UNKNOWN && key.aperture == 8.0);
    key = of("holiday 2023/DSC_24-70.jpg");
    assert_true(key.focal_mm == LENSPROF_UNKNOWN && key.aperture == LENSPROF_UNKNOWN);
    for (const char *number : {"24mm/f01.tif", "24mm_f02.tif", "f003_24mm.tif"}) {  // of a picture
        key = of(number);
        assert_true(key.focal_mm == 24.0 && key.aperture == LENSPROF_UNKNOWN);
    }
    assert_true(of("f0.95.tif").aperture == 0.95 && of("24mm_f4_2.tif").aperture == 4.0
                && of("24mm_f10.tif").aperture == 10.0 && of("f0.tif").aperture == LENSPROF_UNKNOWN);
    key = of("Lens--0mm--2.8.CR2");
    assert_true(key.focal_mm == LENSPROF_UNKNOWN);
}

// Pictures without EXIF have the settings of their names, or of a table.
void test_names_and_table(void **) {
    Card card;
    card.camera = card.lens = "";
    for (const double aperture : apertures) {
        card.aperture = LENSPROF_UNKNOWN, card.k1 = k1_of(24.0, aperture);
        shoot(format("named/Zoom_A--24mm--%g.tif", aperture), card);
        shoot(format("plain/c%g.tif", aperture), card);
    }
    const Json named = json_of(flat_of({in_folder("named")}, {"--json"}));
    assert_int_equal(named["settings"].size(), 3);
    assert_true(named["settings"][2]["key"]["lens"] == "Zoom A" && named["settings"][2]["key"]["aperture"] == 11.0);
    save_text(in_folder("table.csv"), "aperture;file;lens;focal\n2,8;c2.8.tif;Zoom B;24\n");
    assert_refused(unreadable, flat_of({in_folder("plain")}, {"--key", "table=" + in_folder("table.csv")}),
                   {"table.csv: line 2", "'2,8'", "aperture"});
    save_text(in_folder("table.csv"),
              "aperture,file,lens,focal\n2.8,c2.8.tif,\"Zoom \"\"B\"\"\",24\n5.6,plain/c5*,B,24\n"
              "11,c11.tif,B,24\n8,c8.tif,B,24\n");
    const Outcome table =
        run_words(flat_of({in_folder("plain")}, {"--json", "--key", "table=" + in_folder("table.csv")}));
    assert_int_equal(table.code, done);
    assert_true(contains(table.err, "no picture has the name c8.tif"));
    const Json json = parsed(table.out);
    assert_int_equal(json["settings"].size(), 3);
    assert_true(json["settings"][2]["key"]["lens"] == "Zoom \"B\"");
    for (const char *bad :
         {"", "lens,focal\nB,24\n", "file,size\na,1\n", "file,focal\na\n", "file,focal\na,-5\n", "file,focal\na,0x10\n",
          "file,focal\na,1e300\n", "file,file\na,b\n", "file,lens\na,\"B\n"}) {
        save_text(in_folder("table.csv"), bad);
        assert_refused(unreadable, flat_of({in_folder("plain")}, {"--key", "table=" + in_folder("table.csv")}),
                       {"table.csv: line"});
    }
}

// Overlapping pictures show that the light was brighter in the middle, and by how much.
void test_light_is_checked(void **) {
    must_exit(done, {"simulate", "-o", in_folder("photographs"), "--exif", "--vignetting", "-0.4,0.05,-0.02",
                     "--images", "6", "--size", "480x360"});
    const PictureMetadata photograph = read_metadata(in_folder("photographs/img000.png"));
    Card card{photograph.key.focal_mm, photograph.key.aperture, photograph.key.camera_model, photograph.key.lens};
    const double corner = 0.63;
    for (const double light : {0.0, 0.25}) {
        card.light = light;
        const std::string file = shoot(format("light/%g.tif", light), card),
                          db = in_folder(format("light%g.db", light));
        const Json json = json_of({"flat", file, "--linear", "--db", db, "--check", in_folder("photographs"), "-o",
                                   in_folder("light.xml"), "--key", "crop-factor=1", "--json"});
        const Json &setting = json["settings"][0];
        assert_int_equal(json["light"]["removed_from"], light > 0.0);
        assert_int_equal(json["light"]["rings"].size(), 5);
        const double sigma = setting["corner_sigma"];
        assert_true(std::fabs(setting["corner"].get<double>() - corner) < 0.01 + 2.0 * sigma && sigma < 0.05);
        assert_int_equal(json_of({"profile", "list", "--json", "--db", db})["profiles"].size(), 1);
    }
    assert_refused(not_usable,
                   flat_of({in_folder("light/0.tif")}, {"--check", in_folder("photographs"), "--aperture", "16"}),
                   {"no good setting of the cards", "0.tif", "differs in aperture"});
}

// Of cards of several settings, the pictures must state theirs: in EXIF, or in their names.
void test_light_is_checked_with_the_setting_of_names(void **) {
    must_exit(done, {"simulate", "-o", in_folder("stated"), "--response", "linear", "--format", "tiff16",
                     "--vignetting", "-0.2,0.05,-0.02", "--images", "6", "--size", "480x360"});
    fs::create_directories(in_folder("unnamed"));
    fs::create_directories(in_folder("named"));
    for (int n = 0; n < 6; n++) {  // without EXIF
        const Picture picture = read_picture(in_folder(format("stated/img%03d.tif", n)), {});
        write_picture(in_folder(format("unnamed/img%03d.tif", n)), picture, {});
        write_picture(in_folder(format("named/35mm--5.6_%d.tif", n)), picture, {});
    }
    Card card{35.0, 2.8};
    shoot("two/a.tif", card);
    card.aperture = 5.6, card.k1 = -0.2;
    shoot("two/b.tif", card);
    const Words words = flat_of({in_folder("two")}, {"--black", "0"});
    assert_refused(not_usable, words + Words{"--check", in_folder("unnamed")},
                   {"img00", "states the aperture", "35mm--2.8"});
    const Json json = json_of(words + Words{"--json", "--check", in_folder("named")});
    assert_true(contains(json["light"]["setting"].get<std::string>(), "5.6"));
    assert_int_equal(json["light"]["removed_from"], 0);
}

// A black level above the corners is refused, by the name of the file and of the option.
void test_a_black_level_above_the_corners(void **) {
    const std::string file = shoot("above/a.tif", Card{24.0, 2.8});
    assert_refused(not_usable, flat_of({file}, {"--black", "40%"}), {"a.tif", "below the black level", "--black"});
}

// A sensor of 14 bit in a file of 16 bit: what saturates is left out, though it is far below full scale.
void test_samples_that_saturate_below_full_scale(void **) {
    for (const double middle : {0.2, 0.255, 0.3}) {
        Card card{24.0, 2.8};
        card.middle = middle, card.largest = 16383.0 / 65535.0;
        const std::string file = shoot(format("saturated/%g.tif", middle), card);
        const Outcome outcome = run_words(flat_of({file}, {"--black", "0"}));
        assert_int_equal(contains(outcome.err + outcome.out, "are 16383 of 65535"), middle > 0.21);
        const Json setting =
            parsed(must_exit(middle < 0.3 ? done : not_usable, flat_of({file}, {"--black", "0", "--json"})));
        if (middle < 0.3) assert_float_equal(setting["corner"].get<double>(), 0.63, 0.006);
    }
}

// Overlaps that nothing but --linear declares linear are linear, as the cards are: the light is known well.
void test_light_is_checked_on_linear_pictures(void **) {
    must_exit(done, {"simulate", "-o", in_folder("linear"), "--exif", "--response", "linear", "--format", "tiff16",
                     "--vignetting", "-0.4,0.05,-0.02", "--images", "6", "--size", "480x360"});
    const PictureMetadata photograph = read_metadata(in_folder("linear/img000.tif"));
    assert_true(photograph.may_be_linear);
    Card card{photograph.key.focal_mm, photograph.key.aperture, photograph.key.camera_model, photograph.key.lens};
    card.light = 0.25;
    const Json json =
        json_of(flat_of({shoot("bright/a.tif", card)}, {"--black", "0", "--check", in_folder("linear"), "--json"}));
    assert_int_equal(json["light"]["removed_from"], 1);
    assert_float_equal(json["light"]["rings"][4]["ev"].get<double>(), 0.3, 0.06);
    assert_true(json["light"]["rings"][4]["sigma_ev"].get<double>() < 0.03);
    assert_float_equal(json["settings"][0]["corner"].get<double>(), 0.63, 0.015);
}

// Rendered pictures have the response of their camera, if a database has it.
void test_response_of_the_camera(void **) {
    const std::string file = shoot("rendered/a.tif", Card{24.0, 2.8}), db = in_folder("responses.db");
    assert_refused(usage, {"flat", file, "--db", db, "--no-store"}, {"a.tif", "no database has the response"});
    Words flat = {"flat", file, "--db", db, "--fit", "gamma=2.2", "--focal", "50"};
    must_exit(done, flat);  // stores a profile of the camera with this response
    const Outcome found = run_words({"flat", file, "--db", db, "--json"});
    assert_int_equal(found.code, done);
    assert_true(contains(found.err, "that of the camera in the database"));
    flat.resize(flat.size() - 2);
    assert_true(parsed(found.out)["vignetting"] == json_of(flat + Words{"--json"})["vignetting"]);
}

// By EXIF's orientation.
void test_turned(void **) {
    const std::vector<std::string> files = {shoot("turned/a.tif", Card{24.0, 2.8}),
                                            shoot("turned/b.tif", Card{24.0, 2.8})};
    assert_refused(usage, flat_of({files[0], files[1]}, {"--turned"}), {"a.tif", "--rotation"});
    assert_refused(usage, flat_of({files[0], files[1]}, {"--turned", "--rotation", "0,90"}),
                   {"--turned and --rotation"});
    CardOptions o;
    o.linear = o.turned = o.store.no_store = true;
    std::vector<CardPicture> pictures = {{files[0], read_metadata(files[0])}, {files[1], read_metadata(files[1])}};
    NoticeList events;
    for (const auto &[orientation, rotation] : {std::pair(6, 90.0), std::pair(3, 180.0), std::pair(8, 270.0)}) {
        pictures[1].metadata.orientation = static_cast<uint16_t>(orientation);
        const CardInput input = prepare_cards(o, pictures, events);
        assert_true(input.images[0].rotation_deg == 0.0 && input.images[1].rotation_deg == rotation);
    }
}

// An archive with the same bytes each time.
void test_bundle(void **) {
    const std::string lens = make_lens("bundled"), zip = in_folder("lens.zip");
    const Words words = flat_of({lens}, {"--bundle", zip, "--key", "crop-factor=1"});
    must_exit(done, words);
    const Bytes first = load(zip);
    const std::string text(first.begin(), first.end());
    for (const char *name : {"report.html", "lens.json", "lens.csv", "lens.xml", "pictures/24_2.8_0.jpg"})
        assert_true(contains(text, name));
    must_exit(done, words);
    assert_true(load(zip) == first);
    assert_refused(usage, flat_of({lens}, {"--bundle", in_folder("lens.tar")}), {"lens.tar", ".zip"});
}

// A folder of cards has no overlaps to find; ordinary pictures are not cards.
void test_cards_and_photographs(void **) {
    const std::string lens = make_lens("cards");
    must_exit(done, {"simulate", "-o", in_folder("scene2"), "--exif", "--images", "3", "--size", "320x240"});
    assert_refused(not_usable, flat_of({in_folder("scene2")}), {});
    assert_true(contains(run_words(flat_of({in_folder("scene2")})).out, "do not show an even light"));
    if (can_register()) {
        const Outcome found = run_words({"build", lens, "--no-store"});
        assert_true(found.code != done && contains(found.err, "lensprof flat"));
    }
}

// The settings that predictions need, and no others.
void test_missing_settings(void **) {
    const std::string lens = make_lens("missing");
    fs::remove(lens + "/70_2.8_0.tif"), fs::remove(lens + "/70_2.8_1.tif");
    const Json json = json_of(flat_of({lens}, {"--json"}));
    bool is_wide_open_missing = false;
    for (const Json &setting : json["missing"]) {
        is_wide_open_missing |= setting["focal_mm"] == 70.0 && setting["aperture"] == 2.8;
        for (const double aperture : apertures)
            assert_false(setting["focal_mm"] == 24.0 && setting["aperture"] == aperture);
    }
    assert_true(is_wide_open_missing);
    assert_true(contains(must_exit(done, flat_of({lens})), "missing   "));
}

// Nominal steps are settings of their own, however small; roundings of one are not, and are named.
void test_near_settings(void **) {
    for (const auto &[focal, aperture] : {std::pair(97.0, 1.7), std::pair(97.0, 1.8), std::pair(98.0, 1.8),
                                          std::pair(50.0, 2.8), std::pair(50.0, 2.83)})
        shoot(format("near/%g_%g.tif", focal, aperture), Card{focal, aperture});
    const Outcome found = run_words(flat_of({in_folder("near")}, {"--json"}));
    assert_int_equal(found.code, done);
    Words labels;
    const Json json = parsed(found.out);
    for (const Json &setting : json["settings"]) labels.push_back(setting["label"]);
    assert_true(labels == Words({"50 mm, f/2.8", "97 mm, f/1.7", "97 mm, f/1.8", "98 mm, f/1.8"}));
    assert_true(contains(found.err, "50_2.83.tif states 50 mm, f/2.83: taken as one setting"));
    assert_false(contains(found.err, "97_"));
}

// The settings, their keys and notes do not depend on the order of pictures that round to each other.
void test_order_of_near_settings(void **) {
    const std::vector<std::pair<double, double>> numbers = {
        {24.0, 4.0}, {23.6, 4.0},  {24.4, 4.0}, {35.0, 1.7}, {35.0, 1.75}, {35.0, 1.8},     {50.0, 2.8}, {50.0, 2.83},
        {4.3, 5.6},  {4.25, 5.66}, {4.25, 5.6}, {85.0, 2.8}, {85.0, 2.9},  {85.0, 2.82843}, {85.0, 2.83}};
    Words files;
    for (const auto &[focal, aperture] : numbers)
        files.push_back(shoot(format("order/%g_%g.tif", focal, aperture), Card{focal, aperture}));
    CardOptions o;
    o.linear = o.store.no_store = true;
    std::map<std::string, Words> first;
    std::set<std::string> first_notes;
    for (int turn = 0; turn < 12; turn++) {
        turn % 2 ? std::reverse(files.begin(), files.end())
                 : void(std::rotate(files.begin(), files.begin() + 2, files.end()));
        NoticeList events;
        std::map<std::string, Words> settings;
        std::set<std::string> notes;
        for (const CardSetting &setting : card_settings(files, o, nullptr, events).list) {
            assert_int_equal(settings.count(setting.label), 0);
            Words &names = settings[setting.label];
            for (const CardPicture &picture : setting.pictures) {
                names.push_back(picture.file);
                assert_true(picture.metadata.key.focal_mm == setting.key.focal_mm
                            && picture.metadata.key.aperture == setting.key.aperture);
            }
            std::sort(names.begin(), names.end());
        }
        for (const Notice &notice : events.list) notes.insert(notice.line());
        if (first.empty()) first = settings, first_notes = notes;
        assert_true(settings == first && notes == first_notes);
    }
    Words labels;
    for (const auto &[label, names] : first) labels.push_back(label);
    assert_true(labels
                == Words({"23.6 mm, f/4", "24 mm, f/4", "24.4 mm, f/4", "35 mm, f/1.7", "35 mm, f/1.75", "35 mm, f/1.8",
                          "4.25 mm, f/5.6", "50 mm, f/2.8", "85 mm, f/2.8", "85 mm, f/2.82843", "85 mm, f/2.9"}));
    assert_int_equal(first["85 mm, f/2.82843"].size(), 2);  // of 2.8 or 2.9, but both of one
    assert_int_equal(first["4.25 mm, f/5.6"].size(), 3);
    assert_int_equal(first["50 mm, f/2.8"].size(), 2);
    assert_true(
        first_notes.count("24 mm, f/4: may be 23.6 mm, f/4 or 24.4 mm, f/4, by the rounding of what cameras "
                          "state: measured alone; give a table if it is one of them"));
}

std::string reason_of(const Words &files) {
    const Json json = json_of(flat_of(files, {"--json", "-o", in_folder("odd.csv")}), not_usable);
    assert_int_equal(json["settings"].size(), 1);
    return json["settings"][0]["reason"];
}

// A picture of another lens, or of something else, is named; of two cards that contradict, both are.
void test_a_foreign_picture(void **) {
    Words cards;
    for (uint64_t n = 0; n < 4; n++) {
        Card card{24.0, 2.8};
        card.seed = 20 + n;
        cards.push_back(shoot(format("odd/card%d.tif", static_cast<int>(n)), card));
    }
    Card card{24.0, 2.8};
    card.k1 = -0.2;
    const std::string other = shoot("odd/b_lens.tif", card);
    card.k1 = -0.4, card.scene = 0.6;
    const std::string street = shoot("odd/street.tif", card);
    for (size_t count : {2, 3, 4}) {
        const Words some(cards.begin(), cards.begin() + static_cast<std::ptrdiff_t>(count));
        for (const std::string &foreign : {other, street}) {
            const std::string reason = reason_of(some + Words{foreign});
            assert_true(contains(reason, foreign));
            for (const std::string &own : some) assert_false(contains(reason, own));
        }
    }
    const std::string both = reason_of({cards[0], other});
    assert_true(contains(both, cards[0]) && contains(both, other));
    const std::string scene = reason_of({cards[0], street});
    assert_true(contains(scene, "not of an even light: " + street));
}

// Float samples above 1 are counts: of a stated number at saturation, they are those of the same card in shares.
void test_counts(void **) {
    Card card{24.0, 2.8};
    card.black = 0.06;
    for (const double counts : {1.0, 4095.0}) {
        card.counts = counts;
        shoot(format("counts/%g.tif", counts), card);
    }
    const auto of = [](const std::string &file, const Words &more) {
        return json_of(Words{"flat", in_folder(file), "--no-store", "--json"} + more)["vignetting"]["k"][0];
    };
    const Json shares = of("counts/1.tif", {"--black", "6%"});
    const Json found = of("counts/4095.tif", {"--black", "245.7", "--fit", "white-level=4095"});
    for (size_t i = 0; i < 3; i++) assert_float_equal(found[i].get<double>(), shares[i].get<double>(), 1e-4);
    assert_refused(usage, {"flat", in_folder("counts/4095.tif"), "--no-store"},
                   {"4095.tif: its float samples reach", "counts", "--fit white-level=LEVEL"});
    card.clipped = false, card.light = 1e4;  // covered
    const std::string dark = shoot("counts/dark.tif", card);
    const Json by_dark = of("counts/4095.tif", {"--dark", dark, "--fit", "white-level=4095"});
    for (size_t i = 0; i < 3; i++) assert_float_equal(by_dark[i].get<double>(), shares[i].get<double>(), 2e-3);
    assert_refused(usage, {"flat", in_folder("counts/4095.tif"), "--no-store", "--dark", dark},
                   {"4095.tif: its float samples reach", "counts", "--fit white-level=LEVEL"});
}

// A share among counts, or the reverse, is refused with the unit.
void test_units_of_levels(void **) {
    const auto shot = [](const std::string &name, double counts, double light) {
        return shoot("units/" + name, Card{24.0, 2.8, "", "", -0.4, 0.0, 7, false, light, 0.0, counts, 0.06});
    };
    const std::string counts = shot("counts.tif", 4095.0, 0.0), shares = shot("shares.tif", 1.0, 0.0),
                      dark_counts = shot("covered_counts.tif", 4095.0, 1e4), dark = shot("covered.tif", 1.0, 1e4);
    const struct {
        Words words, named;
    } cases[] = {
        {{counts, "--fit", "white-level=4095", "--black", "0.05"}, {counts, "4095", "204.75", "5%"}},
        {{counts, "--fit", "white-level=4095", "--black", "0.05:0.05:0.05"}, {counts, "5%"}},
        {{counts, "--fit", "white-level=4095", "--dark", dark}, {dark, "its level is 0.06", "counts", "--black"}},
        {{shares, "--dark", dark_counts},
         {dark_counts, "its level is 24", "full scale of " + shares + " is 1", "unit"}},
        {{counts, "--fit", "white-level=0.9"}, {counts, "a level of 0.9", "such as 4095"}},
        {{counts, "--fit", "white-level=1"}, {counts, "a level of 1", "such as 4095"}},
        {{counts, "--fit", "white-level=90%"}, {counts, "--fit white-level", "not a percentage"}},
    };
    for (const auto &one : cases) assert_refused(usage, Words{"flat", "--no-store"} + one.words, one.named);
    const Json json = json_of({"flat", shares, "--no-store", "--json", "--dark", dark});
    assert_float_equal(json["levels"]["black"][1].get<double>(), 0.06, 1e-3);
}

// Dark frames in float counts have the scale of the cards, also if the cards' file states it.
void test_dark_frames_in_counts_of_the_file(void **) {
    Card card{24.0, 2.8};
    card.black = 0.06, card.counts = 4095.0;
    const std::string file = shoot("tagged/card.tif", card);
    TIFF *tiff = TIFFOpen(file.c_str(), "r+");
    const uint32_t white = 4095;
    assert_int_equal(TIFFSetField(tiff, 50717, 1, &white), 1);
    assert_int_equal(TIFFRewriteDirectory(tiff), 1);
    TIFFClose(tiff);
    card.light = 1e4;
    const std::string dark = shoot("covered.tif", card);
    const Json json = json_of({"flat", file, "--no-store", "--json", "--dark", dark});
    assert_float_equal(json["levels"]["black"][1].get<double>(), 0.06, 1e-3);
    assert_float_equal(json["corner"].get<double>(), 0.63, 0.01);
    const std::string lit = shoot("lit.tif", Card{24.0, 2.8, "", "", -0.4, 0.0, 7, false, 0.0, 0.0, 4095.0});
    assert_refused(not_usable, {"flat", file, "--no-store", "--dark", lit}, {"lit.tif", "is not dark, its level is"});
}

// A dark frame among cards: its name and its darkness suggest the option; given so, it does not count as a card.
void test_a_dark_frame_in_the_folder(void **) {
    Card card{24.0, 2.8};
    card.black = 0.06;
    shoot("covered/a.tif", card);
    card.seed = 8;
    shoot("covered/b.tif", card);
    card.light = 1e4;
    const std::string folder = in_folder("covered"), dark = shoot("covered/dark_1.tif", card);
    const Outcome among = run_words(flat_of({folder}));
    assert_int_equal(among.code, not_usable);
    assert_true(contains(among.out, "if the lens was covered for " + dark + ", give it with --dark"));
    const Json json = json_of(flat_of({folder}, {"--dark", dark, "--json"}));
    assert_int_equal(json["settings"][0]["files"].size(), 2);
    assert_float_equal(json["settings"][0]["corner"].get<double>(), 0.63, 0.01);
    const Words named = {folder + "/a.tif", folder + "/b.tif"};
    const Outcome found = run_words(flat_of(named + Words{dark}, {"--dark", dark, "--json"}));
    assert_int_equal(found.code, done);
    assert_true(
        contains(found.err, dark + ": is a dark frame, as --dark states, and not used as a picture with light"));
    assert_true(parsed(found.out)["corner"] == json_of(flat_of(named, {"--dark", dark, "--json"}))["corner"]);
    assert_refused(usage, flat_of({dark}, {"--dark", dark}), {dark, "no other picture is given"});
    fs::rename(dark, folder + "/night.tif");  // another name: nothing is known about it
    assert_false(contains(run_words(flat_of({folder})).out, "--dark"));
    card.focal_mm = card.aperture = LENSPROF_UNKNOWN;
    shoot("covered/bias.tif", card);
    assert_true(contains(run_words(flat_of({folder})).out, "give it with --dark"));
}

// The shell gives the first dark frame of a pattern to the option, and the others as cards.
void test_dark_frames_of_a_pattern(void **) {
    Card card{24.0, 2.8};
    card.black = 0.06;
    const std::string file = shoot("pattern/card.tif", card);
    card.light = 1e4;
    Words dark;
    for (uint64_t n = 1; n < 4; n++) {
        card.seed = n;
        dark.push_back(shoot(format("pattern/black%d.tif", static_cast<int>(n)), card));
    }
    assert_refused(usage, flat_of({file}, Words{"--dark"} + dark), {"black2.tif", "repeat --dark for each file"});
    const Json json = json_of(flat_of({file}, {"--dark", dark[0], "--dark", dark[1], "--dark", dark[2], "--json"}));
    assert_float_equal(json["corner"].get<double>(), 0.63, 0.01);
}

void test_no_such_file(void **) {
    for (const char *name : {"nothing", "nothing.tif", "nothing/"}) {
        assert_refused(unreadable, flat_of({in_folder(name)}), {name, "No such file"});
        assert_false(contains(run_words(flat_of({in_folder(name)})).err, "empty"));
    }
    const Outcome among = run_words(flat_of({shoot("one.tif", Card{24.0, 2.8}), in_folder("nothing.tif")}));
    assert_true(contains(among.out, "left out  1 of 2 pictures") && contains(among.out, "No such file"));
    save_text(in_folder("empty.tif"), "");
    assert_refused(unreadable, flat_of({in_folder("empty.tif")}), {"empty.tif", "is empty"});
}

size_t lines_with(const std::string &text, const std::string &part) {
    std::istringstream lines(text);
    size_t count = 0;
    for (std::string line; std::getline(lines, line);) count += contains(line, part) ? 1 : 0;
    return count;
}

// Notes that differ in a number are one line, with the largest; the JSON has all of them. Quiet prints none.
void test_notes_of_settings(void **) {
    const std::string lens = make_lens("noted"), xml = in_folder("noted.xml");
    const Words words = flat_of({lens}, {"-o", xml, "--key", "crop-factor=1"});
    const std::string table = must_exit(done, words);
    assert_int_equal(lines_with(table, "[flat_black_level]"), 1);
    const Json json = json_of(words + Words{"--json"});
    size_t settings = 0;
    for (const Json &setting : json["settings"])
        settings += contains(setting["result"]["findings"].dump(), "flat_black_level") ? 1 : 0;
    assert_true(settings > 1);
    assert_true(
        contains(table, format("note      24 mm, f/2.8, the largest of %zu settings: the black level", settings)));
    const std::string stated = must_exit(done, words + Words{"--black", "1"});
    assert_int_equal(lines_with(stated, "does not hold its black and white level"), 1);
    for (const Words &pictures : {Words{lens}, Words{lens + "/24_2.8_0.tif"}}) {
        const Outcome quiet = run_words(flat_of(pictures, {"-q"}));
        assert_int_equal(quiet.code, done);
        assert_true(quiet.err.empty() && lines_with(quiet.out, "note ") == 0);
        assert_true(lines_with(must_exit(done, flat_of(pictures)), "note ") > 0);
    }
}

// Dark corners above a known black level are measured, not continued from the middle.
void test_a_dim_card(void **) {
    Card card{24.0, 2.8};
    card.k1 = -0.78, card.middle = 0.03, card.noise = 0.0002;
    const std::string file = shoot("dim.tif", card);
    const Json known = json_of(flat_of({file}, {"--json", "--black", "0"})),
               unknown = json_of(flat_of({file}, {"--json"}));
    const Json &k = known["vignetting"]["k"][0];
    assert_float_equal(1.0 + k[0].get<double>() + k[1].get<double>() + k[2].get<double>(), 0.25, 0.002);
    assert_false(contains(known["findings"].dump(), "\"flat_black\""));
    assert_true(contains(unknown["findings"].dump(), "\"flat_black\""));
    const Json above = json_of(flat_of({file}, {"--json", "--black", "0", "--fit", "ignore-below=0.0078"}));
    assert_true(contains(above["findings"].dump(), "\"flat_black\""));
}

// An option for all pictures may make one setting of several.
void test_replaced_settings(void **) {
    const std::string lens = make_lens("replaced");
    assert_true(contains(run_words(flat_of({lens}, {"--aperture", "4"})).err,
                         "note: --aperture replaces the aperture of 12 pictures, such as that of " + lens));
    const Outcome same = run_words(flat_of({lens + "/24_2.8_0.tif"}, {"--aperture", "2.8", "--focal", "24"}));
    assert_true(same.code == done && !contains(same.err, "replaces"));
}

// What Lensfun lacks prevents its file alone, and the option that states it is named.
void test_what_can_be_written_is(void **) {
    Card card{LENSPROF_UNKNOWN, 2.8};
    const std::string file = shoot("lacking/a.tif", card), xml = in_folder("lacking.xml"),
                      csv = in_folder("lacking.csv"), page = in_folder("lacking.html"), zip = in_folder("lacking.zip");
    const Words outputs = {"-o", xml, "-o", csv, "--report", page, "--bundle", zip};
    const struct {
        Words given, named;
    } cases[] = {{{"--key", "crop-factor=1"}, {"focal length", "a.tif", "--focal"}},
                 {{"--focal", "24"}, {"crop factor", "--key crop-factor=NUMBER"}}};
    for (const auto &one : cases) {
        for (const std::string &output : {csv, page, zip}) fs::remove(output);
        const Outcome found = run_words(flat_of({file}, outputs + one.given));
        assert_int_equal(found.code, not_usable);
        for (const std::string &name : one.named) assert_true(contains(found.err, name));
        assert_false(contains(found.err + found.out, "key.focal_mm"));
        assert_true(!fs::exists(xml) && fs::exists(csv) && fs::exists(page) && fs::exists(zip));
        assert_true(contains(found.out, "good"));
        assert_refused(usage, flat_of({file}, Words{"-o", xml} + one.given), Words{xml} + one.named);
    }
    must_exit(done, flat_of({file}, outputs + Words{"--focal", "24", "--key", "crop-factor=1"}));
    assert_true(fs::exists(xml));
}

// A falloff that k1..k3 do not describe is not good for Lensfun, which has nothing else.
void test_deep_falloffs_for_lensfun(void **) {
    Card card{24.0, 2.8};
    shoot("deep/a.tif", card);
    card.aperture = 4.0, card.k1 = -0.07, card.light = 2.8;
    shoot("deep/b.tif", card);
    const std::string csv = in_folder("deep.csv");
    const Words words =
        flat_of({in_folder("deep")}, {"-o", in_folder("deep.xml"), "-o", csv, "--key", "crop-factor=1"});
    const Json json = parsed(must_exit(not_usable, words + Words{"--json"}));
    const Json &good = json["settings"][0], &deep = json["settings"][1];
    assert_true(good["usable"] == true && good["good_for_lens_file"] == true && good["lens_file_ev"] < 0.02);
    assert_true(deep["usable"] == true && deep["good_for_lens_file"] == false && deep["lens_file_ev"] > 0.1);
    const std::string table = must_exit(not_usable, words);
    assert_true(contains(table, "good, but not for Lensfun: k1..k3 alone are off by")
                && contains(table, ": 1 setting, without 1 that it would be off by more than 0.1 EV"));
    assert_true(contains(text_of(csv), "good, but not for Lensfun"));
    const std::string xml = text_of(in_folder("deep.xml"));
    assert_true(contains(xml, "aperture=\"2.8\"") && !contains(xml, "aperture=\"4\""));
    std::filesystem::remove(in_folder("deep/a.tif"));  // nothing is left for the file
    std::filesystem::remove(in_folder("deep.xml"));
    must_exit(not_usable, words);
    assert_false(std::filesystem::exists(in_folder("deep.xml")));
}

// Errors have two significant digits; an empty file is named, and its row of the table counts as used.
void test_the_table(void **) {
    const std::string folder = in_folder("printed"), csv = in_folder("printed.csv");
    const std::string card = shoot("printed/a.tif", Card{24.0, 2.8});
    save_text(folder + "/empty.tif", "");
    save_text(csv, "file,focal,aperture\na.tif,24,2.8\nempty.tif,24,4\nnone.tif,24,8\n");
    const Outcome found = run_words(flat_of({folder}, {"--key", "table=" + csv}));
    assert_int_equal(found.code, unreadable);
    assert_true(contains(found.out, "empty.tif: is empty (0 bytes); copy it again"));
    assert_true(contains(found.err, "no picture has the name none.tif") && !contains(found.err, "name empty.tif"));
    const double sigma =
        100.0 * json_of(flat_of({card}, {"-o", csv, "--json"}))["settings"][0]["corner_sigma"].get<double>();
    assert_true(sigma > 0.0 && sigma < 0.05);
    assert_true(contains(found.out, "  " + error_text(sigma) + "  good"));
    for (const auto &[error, text] : {std::pair(0.0, "0"), std::pair(0.00996, "0.010"), std::pair(0.0421, "0.042"),
                                      std::pair(1.26, "1.3"), std::pair(9.96, "10"), std::pair(314.0, "314")})
        assert_string_equal(error_text(error).c_str(), text);
    assert_string_equal(with_decimals_of(0.0421, 62.81234).c_str(), "62.812");
}

// The list of missing settings names the camera of several.
void test_missing_settings_of_cameras(void **) {
    for (const char *camera : {"Box 1", "Box 2"}) shoot(format("two/%s.tif", camera), Card{24.0, 2.8, camera});
    const std::string table = must_exit(done, flat_of({in_folder("two")}));
    assert_true(contains(table, "Box 1, EF24-70mm f/2.8 ") && contains(table, "Box 2, EF24-70mm f/2.8 "));
    const Json json = json_of(flat_of({in_folder("two")}, {"--json"}));
    assert_true(json["missing"][0]["camera"] == "Box 1");
}

// Cells of a table may have the units that names of folders have.
void test_units_in_a_table(void **) {
    const auto table = [](const std::string &cells) {
        save_text(in_folder("units.csv"), "file,focal,aperture,distance\na.tif," + cells + "\n");
        return "table=" + in_folder("units.csv");
    };
    const auto key_of = [&](const std::string &cells) {
        table(cells);
        lensprof_profile_key key;
        lensprof_profile_key_init(&key);
        SettingTable(in_folder("units.csv")).apply("a.tif", key);
        return key;
    };
    shoot("units/a.tif", Card{24.0, 2.8});
    for (const char *cells : {"58mm,f/2.8,10m", "58 MM,F2.8,10 m", "58,2.8,10", "58 mm,f 2.8,1e1"}) {
        const lensprof_profile_key key = key_of(cells);
        assert_true(key.focal_mm == 58.0 && key.aperture == 2.8 && key.distance_m == 10.0);
    }
    assert_true(std::isinf(key_of("58,2,Infinity").distance_m) && std::isinf(key_of("58,2,inf").distance_m));
    for (const char *cells :
         {"58m,2,1", "mm,2,1", "58,f/,1", "58,2.8mm,1", "58,2,10mm", "58,2,-1m", "inf,2,1", "58,f,1"})
        assert_refused(unreadable, flat_of({in_folder("units")}, {"--key", table(cells)}), {"units.csv: line 2"});
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_a_folder),
        CLI_TEST(test_the_same_for_any_number_of_threads),
        CLI_TEST(test_outputs),
        CLI_TEST(test_raw_cards),
        CLI_TEST(test_bad_cards),
        CLI_TEST(test_lists_are_of_all_pictures),
        CLI_TEST(test_settings_of_names),
        CLI_TEST(test_names_and_table),
        CLI_TEST(test_missing_settings),
        CLI_TEST(test_light_is_checked),
        CLI_TEST(test_light_is_checked_on_linear_pictures),
        CLI_TEST(test_response_of_the_camera),
        CLI_TEST(test_turned),
        CLI_TEST(test_bundle),
        CLI_TEST(test_cards_and_photographs),
        CLI_TEST(test_near_settings),
        CLI_TEST(test_order_of_near_settings),
        CLI_TEST(test_a_foreign_picture),
        CLI_TEST(test_counts),
        CLI_TEST(test_units_of_levels),
        CLI_TEST(test_dark_frames_in_counts_of_the_file),
        CLI_TEST(test_a_dark_frame_in_the_folder),
        CLI_TEST(test_dark_frames_of_a_pattern),
        CLI_TEST(test_no_such_file),
        CLI_TEST(test_notes_of_settings),
        CLI_TEST(test_a_dim_card),
        CLI_TEST(test_replaced_settings),
        CLI_TEST(test_what_can_be_written_is),
        CLI_TEST(test_deep_falloffs_for_lensfun),
        CLI_TEST(test_light_is_checked_with_the_setting_of_names),
        CLI_TEST(test_a_black_level_above_the_corners),
        CLI_TEST(test_samples_that_saturate_below_full_scale),
        CLI_TEST(test_the_table),
        CLI_TEST(test_missing_settings_of_cameras),
        CLI_TEST(test_units_in_a_table),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
