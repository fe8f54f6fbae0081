// `lensprof flat --units`: cameras of one type, each measured alone and compared with the others.
#include "cli_runs.hpp"

#include <cstring>
#include <map>

#include "photo/base/format.hpp"
#include "photo/cards/card_units.hpp"
#include "photo/cards/unit_shading.hpp"

namespace {

using namespace cli_runs;

constexpr uint32_t width = 128, height = 96;

struct Module {
    double k1 = -0.45, centre_x = 0.0, centre_y = 0.0;
    double tilt = 0.0;     // slope of the light to the right, share per half diagonal
    double corner = 0.0;   // what k3 takes off
    double blue = 0.0;     // k1 of blue less that of green
    double covered = 0.0;  // share of the width at the left without light
    double circle = 9.0;   // radius of its light, half diagonals
    uint32_t layout = LENSPROF_LAYOUT_RGB;
    const char *camera = "Cam 7";
};

lensprof_vignetting falloff_of(const Module &module, uint32_t channel) {
    return {{module.k1 + (channel == 2 ? module.blue : 0.0), 0.05, -0.02 - module.corner},
            {module.centre_x, module.centre_y}};
}

void shoot(const std::string &name, const Module &module, uint64_t seed) {
    Picture picture = make_noise(width, height, LENSPROF_SAMPLE_U16, module.layout);
    const uint32_t channels = module.layout == LENSPROF_LAYOUT_RGB ? 3 : 1;
    auto *at = reinterpret_cast<uint16_t *>(picture.pixels.data());
    uint64_t random = seed;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < channels; c++) {
                const lensprof_vignetting falloff = falloff_of(module, c);
                const double r2 = lensprof_vignetting_r2(&falloff, width, height, x, y, nullptr),
                             right = (x - 0.5 * (width - 1.0)) / lensprof_half_diagonal(width, height);
                const bool is_lit = x >= module.covered * width && r2 <= module.circle * module.circle;
                const double light = 0.6 * lensprof_vignetting_eval(&falloff, r2, nullptr) * (1.0 + module.tilt * right)
                                     * (is_lit ? 1.0 : 0.01);
                *at++ = static_cast<uint16_t>(std::lround(65535.0 * (light + 0.001 * lp_normal(&random))));
            }
    PictureMetadata metadata = unknown_metadata();
    set_text(metadata.key.camera_model, sizeof metadata.key.camera_model, module.camera);
    WriteOptions options;
    options.metadata = &metadata;
    const std::string path = in_folder(name);
    fs::create_directories(fs::path(path).parent_path());
    write_picture(path, picture, options);
}

// Good units scatter by 0.7 % in the corner and 0.6 % in the centre.
Module good_unit(uint64_t &random) {
    Module module;
    module.k1 += 0.004 * lp_normal(&random);
    module.centre_x = 0.006 * lp_normal(&random), module.centre_y = 0.006 * lp_normal(&random);
    return module;
}

std::string make_units(const std::string &folder, size_t count, const std::map<size_t, Module> &others = {}) {
    uint64_t random = 3;
    for (size_t n = 0; n < count; n++) {
        const Module own = good_unit(random);
        shoot(format("%s/u%02zu/card.tif", folder.c_str(), n), others.count(n) ? others.at(n) : own, n + 1);
    }
    return in_folder(folder);
}

Words units_of(const std::string &folder, const Words &more = {}) {
    return Words{"flat", folder, "--linear", "--black", "0", "--lens", "L"} + more;
}

Json unit_named(const Json &batch, const std::string &name) {
    for (const Json &unit : batch["units"])
        if (unit["unit"] == name) return unit;
    fail_msg("no unit %s", name.c_str());
    return {};
}

// A tilted lens, an off-centre one and one with dark corners fail; the others pass, and the mean is that of them.
void test_a_line(void **) {
    Module tilted, shifted, dark;
    tilted.tilt = 0.08, shifted.centre_x = 0.05, dark.corner = 0.058;
    const std::string folder = make_units("line", 30, {{4, tilted}, {11, shifted}, {20, dark}}),
                      csv = in_folder("line.csv"), page = in_folder("line.html"), db = in_folder("line.db");
    const Words words = units_of(folder, {"--units", "by=folder", "-o", csv, "--report", page, "--db", db, "--json"});
    const Json json = parsed(must_exit(not_usable, words));
    assert_int_equal(json["batches"].size(), 1);
    const Json &batch = json["batches"][0];
    size_t pass = 0;
    for (const Json &unit : batch["units"]) pass += unit["verdict"] == "pass";
    assert_int_equal(pass, 27);
    const std::map<std::string, const char *> expected = {{"u04", "frame"}, {"u11", "center"}, {"u20", "corner"}};
    for (const auto &[name, figure] : expected) {
        const Json unit = unit_named(batch, name);
        assert_true(unit["verdict"] == "fail" && unit["reason"].is_string());
        assert_true(std::fabs(unit[figure]["value"].get<double>()) > json["limits"][figure].get<double>());
        assert_true(unit[figure]["sigma"].get<double>() > 0.0);
    }
    assert_float_equal(unit_named(batch, "u20")["corner"]["value"].get<double>(), -0.10, 0.01);
    assert_float_equal(unit_named(batch, "u11")["center"]["value"].get<double>(), 0.05, 0.004);
    assert_float_equal(batch["mean"]["vignetting"]["center"][0].get<double>(), 0.0, 0.003);
    const Json k = batch["mean"]["vignetting"]["k"][0];
    assert_float_equal(1.0 + k[0].get<double>() + k[1].get<double>() + k[2].get<double>(), 0.58, 0.0025);
    const std::string rows = text_of(csv);
    assert_int_equal(std::count(rows.begin(), rows.end(), '\n'), 31);
    assert_true(contains(rows, "\nu20,Cam 7,L,,,1,fail,") && contains(rows, "\nu00,Cam 7,L,,,1,pass,"));
    assert_true(contains(text_of(page), "\"kind\":\"units\"") && contains(text_of(page), "27 of 30 units pass."));
    const Json stored = json_of({"profile", "list", "--json", "--db", db})["profiles"];
    assert_int_equal(stored.size(), 1);
}

// Of two units that differ, none is the unusual one; a stored profile shows which.
void test_few_units(void **) {
    Module dark;
    dark.corner = 0.058;
    const std::string type = make_units("type", 5), few = make_units("few", 2, {{1, dark}}), db = in_folder("few.db");
    must_exit(done, units_of(type, {"--units", "by=folder,store=yes", "--db", db}));
    assert_int_equal(json_of({"profile", "list", "--json", "--db", db})["profiles"].size(), 6);
    const std::string unknown = must_exit(not_usable, units_of(few, {"--units", "by=folder", "--no-store"}));
    assert_true(contains(unknown, "fewer than 3 units") && contains(unknown, "2 not compared"));
    const std::string known =
        must_exit(not_usable, units_of(few, {"--units", "by=folder,against=1", "--no-store", "--db", db}));
    assert_true(contains(known, "1 pass, 1 fail") && contains(known, "u01") && contains(known, "corner -"));
    must_exit(done, units_of(few, {"--units", "against=1,corner=15%,frame=15%", "--no-store", "--db", db}));
}

// A slope of the light that all units see cancels, and so does a falloff of blue that all have.
void test_one_light_for_all(void **) {
    uint64_t random = 5;
    for (size_t n = 0; n < 6; n++) {
        Module module = good_unit(random);
        module.tilt = 0.03, module.blue = n == 3 ? 0.05 : -0.03;
        shoot(format("light/u%zu/1.tif", n), module, n + 1);
    }
    const Json json =
        parsed(must_exit(not_usable, units_of(in_folder("light"), {"--units", "by=folder", "--no-store", "--json"})));
    for (const Json &unit : json["batches"][0]["units"])
        assert_true((unit["verdict"] == "fail") == (unit["unit"] == "u3"));
    assert_true(contains(unit_named(json["batches"][0], "u3")["reason"], "colour"));
    assert_true(contains(json["batches"][0]["note"], "slope"));
}

// The centre of a portrait picture that may have been rotated either way is unknown: it does not pass for being in the
// middle.
void test_rotated_pictures(void **) {
    const std::string folder = make_units("rotated", 4);
    const std::string first = in_folder("rotated/u00/card.tif");
    const Picture upright = read_picture(first);
    Picture picture = make_noise(height, width, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB);
    for (uint32_t y = 0; y < width; y++)
        for (uint32_t x = 0; x < height; x++)
            std::memcpy(picture.pixels.data() + y * picture.row_bytes + 6 * x,
                        upright.pixels.data() + x * upright.row_bytes + 6 * y, 6);
    fs::remove(first);
    PictureMetadata metadata = unknown_metadata();
    set_text(metadata.key.camera_model, sizeof metadata.key.camera_model, "Cam 7");
    WriteOptions options;
    options.metadata = &metadata;
    write_picture(first, picture, options);
    const std::string out = must_exit(not_usable, units_of(folder, {"--units", "by=folder", "--no-store"}));
    assert_true(contains(out, "3 pass, 1 not measured") && contains(out, "higher than wide"));
}

// Two types are two batches, grey pictures have no colours, and names of units are not settings.
void test_types_are_not_mixed(void **) {
    uint64_t random = 7;
    for (size_t n = 0; n < 6; n++) {
        Module module = good_unit(random);
        module.layout = LENSPROF_LAYOUT_GREY;
        if (n >= 3) module.camera = "Cam 8", module.k1 -= 0.2;
        shoot(format("types/f%zu/1.tif", n + 1), module, n + 1);
    }
    const Json json =
        json_of(units_of(in_folder("types"), {"--units", "by=folder,center=6%,frame=12%", "--no-store", "--json"}));
    assert_int_equal(json["batches"].size(), 2);
    for (const Json &batch : json["batches"]) {
        assert_int_equal(batch["units"].size(), 3);
        assert_true(batch["key"]["aperture"].is_null() && batch["units"][0]["color"]["value"].is_null());
    }
}

void test_unknown_units(void **) {
    const std::string folder = make_units("unknown", 3);
    shoot("unknown/loose.tif", {}, 1);
    const std::string out = must_exit(unreadable, units_of(folder, {"--units", "by=folder", "--no-store"}));
    assert_true(contains(out, "3 pass") && contains(out, "loose.tif: is not in a folder of a unit"));
    assert_refused(usage, units_of(folder, {"--units", "by=auto", "--no-store"}),
                   {"neither folders nor serial numbers"});
    assert_refused(usage, units_of(folder, {"--units", "by=card", "--no-store"}), {"--units by", "{unit}"});
    assert_refused(usage, units_of(folder, {"--units", "corner=3", "--no-store"}), {"--units corner", "3%"});
    assert_refused(usage, units_of(folder, {"--units", "by=folder", "-o", in_folder("x.xml"), "--no-store"}),
                   {"--units and -o FILE.xml"});
    assert_refused(usage, units_of(folder, {"--units", "store=yes", "--no-store"}), {"--units store", "--no-store"});
}

// Pictures in folders, with serial numbers.
struct Shelf {
    std::vector<NamedPicture> named;
    std::vector<CardPicture> pictures;

    void add(const std::string &subfolder, const std::string &name, const std::string &serial = {}) {
        named.push_back({"line/" + (subfolder.empty() ? "" : subfolder + "/") + name, subfolder, true});
        CardPicture picture{named.back().file, unknown_metadata(), pictures.size()};
        set_text(picture.metadata.key.unit, sizeof picture.metadata.key.unit, serial);
        pictures.push_back(picture);
    }
};

void test_units_by_folder_and_serial(void **) {
    NoticeList events;
    Shelf shelf;
    shelf.add("a", "1.tif", "S1"), shelf.add("a/f4", "2.tif", "S1"), shelf.add("b", "1.tif", "S2");
    Shelf same = shelf, double_serial = shelf, mixed = shelf, by_serial = shelf;
    assert_true(assign_units({}, shelf.named, shelf.pictures, events).empty());
    assert_true(shelf.pictures[0].unit == "a" && shelf.pictures[1].unit == "a" && shelf.pictures[2].unit == "b");
    double_serial.add("c", "1.tif", "S2");
    assert_failure(LENSPROF_ERROR_ARGUMENT, "folders and serial numbers",
                   [&] { (void)assign_units({}, double_serial.named, double_serial.pictures, events); });
    events.list.clear();
    assert_true(assign_units({UnitRule::By::folder, {}}, double_serial.named, double_serial.pictures, events).empty());
    assert_int_equal(events.list.size(), 1);
    assert_true(contains(events.list[0].text, "S2") && contains(events.list[0].text, "two units"));
    mixed.add("b", "2.tif", "S3");
    const auto left_out = assign_units({UnitRule::By::folder, {}}, mixed.named, mixed.pictures, events);
    assert_int_equal(left_out.size(), 2);
    assert_true(contains(left_out[0].reason, "S2") && contains(left_out[0].reason, "S3"));
    assert_int_equal(mixed.pictures.size(), 2);
    by_serial.add("c", "1.tif");
    assert_int_equal(assign_units({UnitRule::By::serial, {}}, by_serial.named, by_serial.pictures, events).size(), 1);
    assert_true(by_serial.pictures[2].unit == "S2");
}

// A pattern that fits in two ways splits units, and never joins them.
void test_units_by_name(void **) {
    NoticeList events;
    Shelf shelf;
    shelf.add("", "cam_SN_1_0.tif"), shelf.add("", "cam_SN_2_0.tif"), shelf.add("", "other.tif");
    const UnitRule rule{UnitRule::By::name, "cam_{unit}_*"};
    assert_int_equal(assign_units(rule, shelf.named, shelf.pictures, events).size(), 1);
    assert_true(shelf.pictures[0].unit == "SN_1" && shelf.pictures[1].unit == "SN_2");
    assert_true(is_unit_pattern("{unit}*") && !is_unit_pattern("cam_*") && !is_unit_pattern("{unit}_{unit}"));
}

void test_middles(void **) {
    const Middle middle = middle_of({1.0, 2.0, 3.0, 100.0, NAN});
    assert_float_equal(middle.median, 2.5, 1e-12);
    assert_float_equal(middle.scatter, 1.4826, 1e-12);
    assert_true(std::isnan(middle_of({1.0, NAN, NAN}).median));
}

// A fit leaves out what is black, and continues the falloff there: such units do not pass.
void test_covered_units(void **) {
    Module covered, circle;
    covered.covered = 0.12, circle.circle = 0.7;
    const std::string line = make_units("covered", 8, {{0, circle}, {5, covered}}), db = in_folder("covered.db");
    const Json json = parsed(must_exit(not_usable, units_of(line, {"--units", "by=folder", "--db", db, "--json"})));
    const Json &batch = json["batches"][0];
    for (const char *name : {"u00", "u05"}) {
        const Json unit = unit_named(batch, name);
        assert_true(unit["verdict"] == "fail" && contains(unit["reason"].get<std::string>(), "covered"));
        assert_true(unit["unseen"].get<double>() > 0.08);
    }
    for (const char *name : {"u01", "u02", "u03", "u04", "u06", "u07"})
        assert_true(unit_named(batch, name)["verdict"] == "pass");
    const std::string shown = must_exit(0, {"profile", "show", "1", "--db", db});
    assert_true(contains(shown, "flat") && !contains(shown, "image circle"));
    const Json alone = parsed(
        must_exit(not_usable, units_of(line, {"--units", "by=folder,against=1", "--db", db, "--no-store", "--json"})));
    for (const char *name : {"u00", "u05"}) assert_true(unit_named(alone["batches"][0], name)["verdict"] == "fail");
}

// A folder without a picture that can be used is a unit that was not measured.
void test_units_without_pictures(void **) {
    const std::string line = make_units("absent", 4), csv = in_folder("absent.csv");
    std::filesystem::create_directory(line + "/u90");
    std::filesystem::create_directory(line + "/u91");
    std::ofstream(line + "/u91/card.tif") << "no picture";
    const Json json =
        parsed(must_exit(not_usable, units_of(line, {"--units", "by=folder", "-o", csv, "--no-store", "--json"})));
    assert_int_equal(json["without_pictures"].size(), 2);
    assert_true(json["without_pictures"][0]["unit"] == "u90" && json["without_pictures"][1]["unit"] == "u91");
    assert_true(contains(json["without_pictures"][1]["reason"].get<std::string>(), "card.tif"));
    const std::string rows = text_of(csv);
    assert_true(contains(rows, "\nu90,,,,,0,not measured,") && contains(rows, "\nu91,,,,,0,not measured,"));
    const auto commas = [](const std::string &row) { return std::count(row.begin(), row.end(), ','); };
    assert_int_equal(commas(rows.substr(0, rows.find('\n'))),
                     commas(rows.substr(rows.find("\nu90"), rows.find("\nu91") - rows.find("\nu90"))));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        CLI_TEST(test_a_line),
        CLI_TEST(test_covered_units),
        CLI_TEST(test_units_without_pictures),
        CLI_TEST(test_few_units),
        CLI_TEST(test_one_light_for_all),
        CLI_TEST(test_rotated_pictures),
        CLI_TEST(test_types_are_not_mixed),
        CLI_TEST(test_unknown_units),
        CLI_TEST(test_units_by_folder_and_serial),
        CLI_TEST(test_units_by_name),
        CLI_TEST(test_middles),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
