// Measured exposures (exposures.json): written files read back the same in every bit, and damaged ones are refused with
// the path of the fault.
#include <cmath>
#include <string>
#include <vector>

extern "C" {
#include "support.h"
}

#include <lensprof/exposures.h>

namespace {

struct Contents {
    lensprof_exposures_info info;
    std::vector<lensprof_exposures_camera> cameras;
    std::vector<lensprof_exposures_lens> lenses;
    std::vector<lensprof_exposures_image> images;
};

struct Owner {
    lensprof_exposures *handle = nullptr;
    ~Owner() { lensprof_exposures_destroy(handle); }
};

lensprof_status write(const Contents &all, std::string &text, lensprof_error *error = nullptr) {
    size_t count = 0;
    const auto call = [&](void *data, size_t capacity) {
        return lensprof_exposures_write(&all.info, all.cameras.data(), all.lenses.data(), all.images.data(), data,
                                        capacity, &count, error);
    };
    lensprof_status status = call(nullptr, 0);
    if (status != LENSPROF_OK) return status;
    text.resize(count);
    return call(text.data(), count);
}

std::string written(const Contents &all) {
    std::string text;
    lensprof_error error;
    if (write(all, text, &error) != LENSPROF_OK) print_error("%s\n", error.text);
    assert_string_equal(error.text, "");
    assert_false(text.empty());
    return text;
}

Contents contents_of(const lensprof_exposures *handle) {
    Contents all;
    lensprof_exposures_info_init(&all.info);
    assert_ok(lensprof_exposures_get_info(handle, &all.info, nullptr));
    for (uint32_t i = 0; i < all.info.camera_count; i++) {
        lensprof_exposures_camera_init(&all.cameras.emplace_back());
        assert_ok(lensprof_exposures_get_camera(handle, i, &all.cameras.back(), nullptr));
    }
    for (uint32_t i = 0; i < all.info.lens_count; i++) {
        lensprof_exposures_lens_init(&all.lenses.emplace_back());
        assert_ok(lensprof_exposures_get_lens(handle, i, &all.lenses.back(), nullptr));
    }
    for (uint32_t i = 0; i < all.info.image_count; i++) {
        lensprof_exposures_image_init(&all.images.emplace_back());
        assert_ok(lensprof_exposures_get_image(handle, i, &all.images.back(), nullptr));
    }
    return all;
}

lensprof_status read(const std::string &text, Owner &owner, std::string &message) {
    lensprof_error error;
    const lensprof_status status = lensprof_exposures_read(text.data(), text.size(), &owner.handle, &error);
    message = error.text;
    assert_true((status == LENSPROF_OK) == message.empty());
    assert_true((status == LENSPROF_OK) == (owner.handle != nullptr));
    return status;
}

lensprof_exposures_image image_of(const char *name, uint32_t lens, double ev) {
    lensprof_exposures_image image;
    lensprof_exposures_image_init(&image);
    image.name = name, image.lens = lens;
    image.width = 1600, image.height = 1200;
    image.exposure.ev = ev;
    return image;
}

// Every kind of response, one and three curves, and every member in both of its forms; no number has a short decimal
// form.
Contents full() {
    Contents all;
    lensprof_exposures_info_init(&all.info);
    all.info.reference = 1;
    all.info.software = "lensprof 9.9.9";
    all.cameras.resize(5);
    for (auto &camera : all.cameras) lensprof_exposures_camera_init(&camera);
    const double emor[3] = {0.1 + 0.2, -1.0 / 7, 1e-5 / 3}, table[4] = {0, 0.5 / 3, 0.7, 1};
    all.cameras[0].name = "Acme \"quoted\" \\ Modèle\n1";
    assert_ok(lensprof_response_set_emor(&all.cameras[0].response, emor, 3));
    assert_ok(lensprof_response_set_gamma(&all.cameras[1].response, 2.2 / 3 * 3.1));
    assert_ok(lensprof_response_set_table(&all.cameras[2].response, table, 4));
    all.cameras[3].response = all.cameras[0].response;  // in single precision, as a blob holds it
    for (double &value : all.cameras[3].response.table) value = static_cast<float>(value);
    all.lenses.resize(2);
    for (auto &lens : all.lenses) lensprof_exposures_lens_init(&lens);
    all.lenses[0].name = "50 mm, f/2.8", all.lenses[0].camera = 4, all.lenses[0].vignettings = 3;
    for (double &k : all.lenses[0].vignetting[1].k) k = -0.1 / 3;
    for (auto &curve : all.lenses[0].vignetting) curve.center[0] = 1.0 / 17, curve.center[1] = -1e-7 / 3;
    all.lenses[1].vignetting[0].k[2] = 1e-20 / 7;
    all.images = {image_of("a.jpg", 0, -1.0), image_of("b/é.jpg", 1, 0.0), image_of("c.jpg", 1, NAN),
                  image_of("d.jpg", 0, 1.0 / 3)};
    all.images[0].file = "../pictures/a.jpg";
    all.images[0].ev_sigma = 1e-4 / 3;
    for (int c = 0; c < 3; c++) all.images[0].white_balance_sigma[c] = c * 0.1 / 7;
    all.images[1].ev_sigma = 0.0;
    all.images[3].exposure.white_balance[0] = 4.0 / 3;
    all.images[3].width = 1, all.images[3].height = 1 << 20;
    all.info.camera_count = 5, all.info.lens_count = 2, all.info.image_count = 4;
    return all;
}

void assert_same_text(const char *a, const char *b) {
    assert_true(!a == !b);
    if (a) assert_string_equal(a, b);
}

void test_round_trip(void **) {
    const Contents given = full();
    const std::string text = written(given);
    Owner owner;
    std::string message;
    assert_ok(read(text, owner, message));
    const Contents again = contents_of(owner.handle);
    assert_string_equal(written(again).c_str(), text.c_str());
    assert_int_equal(again.info.reference, 1);
    assert_string_equal(again.info.software, "lensprof 9.9.9");
    assert_int_equal(again.cameras.size(), 5);
    for (size_t i = 0; i < 5; i++) {
        assert_same_text(again.cameras[i].name, given.cameras[i].name);
        assert_memory_equal(&again.cameras[i].response, &given.cameras[i].response, sizeof(lensprof_response));
    }
    assert_int_equal(again.lenses.size(), 2);
    for (size_t i = 0; i < 2; i++) {
        assert_same_text(again.lenses[i].name, given.lenses[i].name);
        assert_int_equal(again.lenses[i].camera, given.lenses[i].camera);
        assert_int_equal(again.lenses[i].vignettings, given.lenses[i].vignettings);
        assert_memory_equal(again.lenses[i].vignetting, given.lenses[i].vignetting,
                            again.lenses[i].vignettings * sizeof(lensprof_vignetting));
    }
    assert_int_equal(again.images.size(), 4);
    for (size_t i = 0; i < 4; i++) {
        const auto &a = again.images[i], &b = given.images[i];
        assert_same_text(a.name, b.name);
        assert_same_text(a.file, b.file);
        assert_true(a.width == b.width && a.height == b.height && a.lens == b.lens);
        assert_int_equal(std::isnan(a.exposure.ev), i == 2);
        if (i == 2) continue;
        assert_memory_equal(&a.exposure, &b.exposure, sizeof a.exposure);
        assert_memory_equal(&a.ev_sigma, &b.ev_sigma, sizeof a.ev_sigma);
        assert_memory_equal(a.white_balance_sigma, b.white_balance_sigma, sizeof a.white_balance_sigma);
    }
}

// A file by hand, in the layout of docs/reconstructions.md.
const std::string kShort =
    "{\n \"schema\": 1,\n \"file\": \"lensprof exposures\",\n \"software\": \"me\",\n \"reference\": \"b\",\n"
    " \"mean\": {\n  \"ev\": 1.5,\n  \"white_balance\": [\n   2.0,\n   1.0,\n   1.0\n  ]\n },\n"
    " \"cameras\": [\n  {\n   \"name\": \"C\",\n   \"response\": {\n    \"kind\": \"linear\"\n   },\n"
    "   \"light_of_level\": [";
const std::string kRest =
    "\n   ]\n  }\n ],\n"
    " \"lenses\": [\n  {\n   \"name\": \"L\",\n   \"camera\": 0,\n   \"vignetting\": {\n    \"k\": [\n     [\n"
    "      -0.5,\n      0.0,\n      0.001\n     ]\n    ],\n    \"center\": [\n     0.25,\n     0.0\n    ]\n   }\n  }\n ],\n"
    " \"images\": [\n  {\n   \"name\": \"a\",\n   \"file\": \"p/a\",\n   \"width\": 640,\n   \"height\": 480,\n"
    "   \"lens\": 0,\n   \"ev\": 3.0,\n   \"white_balance\": [\n    4.0,\n    1.0,\n    1.0\n   ],\n"
    "   \"ev_sigma\": 0.125,\n   \"white_balance_sigma\": [\n    0.5,\n    0.0,\n    null\n   ]\n  },\n"
    "  {\n   \"name\": \"b\",\n   \"width\": 640,\n   \"height\": 480,\n   \"lens\": 0,\n   \"ev\": 0.0,\n"
    "   \"white_balance\": [\n    1.0,\n    1.0,\n    1.0\n   ],\n   \"ev_sigma\": null,\n"
    "   \"white_balance_sigma\": [\n    null,\n    null,\n    null\n   ]\n  },\n"
    "  {\n   \"name\": \"c\",\n   \"width\": 640,\n   \"height\": 480,\n   \"lens\": 0,\n   \"ev\": null\n  }\n ]\n}\n";

std::string sample() {
    std::string light;
    for (int level = 0; level < 256; level++) {
        char number[40];
        for (int digits = 1; digits <= 17; digits++) {  // the shortest that reads back the same
            snprintf(number, sizeof number, "%.*g", digits, level / 255.0);
            if (strtod(number, nullptr) == level / 255.0) break;
        }
        if (!strchr(number, '.')) strcat(number, ".0");
        light += std::string(level ? "," : "") + "\n    " + number;
    }
    return kShort + light + kRest;
}

// The layout, the values, and the members that follow from others: the geometric mean of 3 and 0 EV is 1.5 EV, that of
// 4 and 1 is 2.
void test_sample(void **) {
    Owner owner;
    std::string message;
    assert_ok(read(sample(), owner, message));
    Contents all = contents_of(owner.handle);
    assert_string_equal(written(all).c_str(), sample().c_str());
    assert_int_equal(all.info.reference, 1);
    assert_string_equal(all.images[0].file, "p/a");
    assert_true(all.images[0].exposure.ev == 3.0 && all.images[0].ev_sigma == 0.125);
    assert_true(all.images[0].white_balance_sigma[2] == LENSPROF_UNKNOWN && all.images[1].ev_sigma == LENSPROF_UNKNOWN);
    assert_true(std::isnan(all.images[2].exposure.ev));
    assert_true(all.lenses[0].vignetting[0].k[0] == -0.5 && all.lenses[0].vignetting[0].center[0] == 0.25);
    all.info.software = nullptr;
    assert_non_null(
        strstr(written(all).c_str(), (std::string("\"software\": \"lensprof ") + lensprof_version()).c_str()));
}

std::string with(std::string text, const std::string &part, const std::string &by) {
    const size_t at = text.find(part);
    assert_true(at != text.npos);
    return text.replace(at, part.size(), by);
}

std::string without_light(const std::string &text) {
    const size_t begin = text.find(",\n   \"light_of_level\""), end = text.find(']', begin);
    return text.substr(0, begin) + text.substr(end + 1);
}

// Members that follow from others, and names that nothing refers to, may be missing.
void test_missing(void **) {
    std::string text = without_light(sample());
    for (const char *part : {"\"software\"", "\"mean\"", "\"name\": \"C\"", "\"name\": \"L\"", "\"file\": \"p/a\""})
        text = with(text, part, std::string("\"x") + (part + 1));
    text = with(text, "\"ev_sigma\": 0.125", "\"more\": [{}]");
    Owner owner;
    std::string message;
    assert_ok(read(text, owner, message));
    const Contents all = contents_of(owner.handle);
    assert_true(!all.info.software && !all.cameras[0].name && !all.lenses[0].name && !all.images[0].file);
    assert_true(all.images[0].ev_sigma == LENSPROF_UNKNOWN);
}

void test_refused(void **) {
    const std::string good = sample();
    const struct {
        std::string text;
        lensprof_status status;
        const char *words;
    } cases[] = {
        {"", LENSPROF_ERROR_SYNTAX, "line 1: not JSON"},
        {"[]", LENSPROF_ERROR_SYNTAX, "the JSON is not an object"},
        {"{}", LENSPROF_ERROR_SYNTAX, "has no \"file\""},
        {good.substr(0, 40), LENSPROF_ERROR_SYNTAX, "line 3: not JSON"},
        {with(good, "lensprof exposures", "other"), LENSPROF_ERROR_SYNTAX, "file is not \"lensprof exposures\""},
        {with(good, "\"schema\": 1", "\"schema\": 2"), LENSPROF_ERROR_UNSUPPORTED, "schema is not 1; use the version"},
        {with(good, "\"schema\": 1", "\"schema\": 1.5"), LENSPROF_ERROR_SYNTAX, "schema is not an integer"},
        {with(good, "\"schema\"", "\"s\""), LENSPROF_ERROR_SYNTAX, "has no \"schema\""},
        {with(good, "\"me\"", "7"), LENSPROF_ERROR_SYNTAX, "software is not a text"},
        {with(good, "\"ev\": 1.5", "\"ev\": \"1\""), LENSPROF_ERROR_SYNTAX, "mean.ev is not a number"},
        {with(good, "2.0,\n", ""), LENSPROF_ERROR_SYNTAX, "mean.white_balance has 2 items, not 3"},
        {with(good, "\"reference\": \"b\"", "\"reference\": \"x\""), LENSPROF_ERROR_SYNTAX,
         "reference is \"x\", not the name of an image"},
        {with(good, "\"reference\"", "\"r\""), LENSPROF_ERROR_SYNTAX, "has no \"reference\""},
        {with(good, "\"cameras\"", "\"c\""), LENSPROF_ERROR_SYNTAX, "has no \"cameras\""},
        {with(good, "\"lenses\": [", "\"lenses\": [],\"l\": ["), LENSPROF_ERROR_SYNTAX,
         "lenses is not an array of obj"},
        {with(good, "\"images\": [", "\"images\": 3,\"l\": ["), LENSPROF_ERROR_SYNTAX, "images is not an array of obj"},
        {with(good, "\"images\": [", "\"images\": [null,"), LENSPROF_ERROR_SYNTAX, "images holds null"},
        {with(good, "\"images\": [", "\"images\": [5,"), LENSPROF_ERROR_SYNTAX, "images[0] is not an object"},
        {with(good, "\"name\": \"C\"", "\"name\": {}"), LENSPROF_ERROR_SYNTAX, "cameras[0].name is not a text"},
        {with(good, "\"name\": \"C\"", "\"name\": \"\\u0000\""), LENSPROF_ERROR_SYNTAX,
         "cameras[0].name has a zero byte"},
        {with(good, "\"response\"", "\"r\""), LENSPROF_ERROR_SYNTAX, "cameras[0] has no \"response\""},
        {with(good, "\"kind\": \"linear\"", "\"kind\": \"x\""), LENSPROF_ERROR_SYNTAX,
         "cameras[0].response.kind is \"x\""},
        {with(good, "\"linear\"", "\"gamma\""), LENSPROF_ERROR_SYNTAX, "cameras[0].response has no \"gamma\""},
        {with(good, "\"linear\"", "\"gamma\", \"gamma\": 11"), LENSPROF_ERROR_RESPONSE,
         "cameras[0].response.gamma is not an"},
        {with(good, "\"linear\"", "\"emor\", \"emor\": [300]"), LENSPROF_ERROR_RESPONSE,
         "cameras[0].response.emor is not a response"},
        {with(good, "\"linear\"", "\"table\", \"values\": [[0, 1, 0.5, 1]]"), LENSPROF_ERROR_RESPONSE,
         "cameras[0].response.values[0] is not a response"},
        {with(good, "\"linear\"", "\"table\", \"values\": [[0, 1], [0, 1]]"), LENSPROF_ERROR_SYNTAX,
         "cameras[0].response.values does not hold one list"},
        {with(good, "[\n    0.0,", "["), LENSPROF_ERROR_SYNTAX, "cameras[0].light_of_level has 255 items, not 256"},
        {with(good, "\"camera\": 0", "\"camera\": 1"), LENSPROF_ERROR_SYNTAX,
         "lenses[0].camera is 1, not within 0 to 0"},
        {with(good, "\"vignetting\"", "\"v\""), LENSPROF_ERROR_SYNTAX, "lenses[0] has no \"vignetting\""},
        {with(good, "-0.5", "-1.5"), LENSPROF_ERROR_VIGNETTING, "lenses[0].vignetting.k[0] is not a valid falloff"},
        {with(good, " 0.25,", " null,"), LENSPROF_ERROR_SYNTAX, "lenses[0].vignetting.center[0] is not a number"},
        {with(good, "\"name\": \"a\"", "\"name\": \"\""), LENSPROF_ERROR_SYNTAX, "images[0].name is empty"},
        {with(good, "\"name\": \"a\"", "\"n\": \"a\""), LENSPROF_ERROR_SYNTAX, "images[0] has no \"name\""},
        {with(good, "\"name\": \"c\"", "\"name\": \"a\""), LENSPROF_ERROR_SYNTAX,
         "images[2].name is that of another image"},
        {with(good, "\"p/a\"", "\"\""), LENSPROF_ERROR_SYNTAX, "images[0].file is empty"},
        {with(good, "\"width\": 640", "\"width\": 0"), LENSPROF_ERROR_SYNTAX,
         "images[0].width is 0, not within 1 to 1048576"},
        {with(good, "\"height\": 480", "\"height\": 1048577"), LENSPROF_ERROR_SYNTAX, "images[0].height is 1048577"},
        {with(good, "\"width\": 640", "\"width\": 640.5"), LENSPROF_ERROR_SYNTAX, "images[0].width is not an integer"},
        {with(good, "\"lens\": 0", "\"lens\": -1"), LENSPROF_ERROR_SYNTAX, "images[0].lens is -1"},
        {with(good, "\"ev\": 3.0", "\"e\": 3.0"), LENSPROF_ERROR_SYNTAX, "images[0] has no \"ev\""},
        {with(good, "\"ev\": 3.0", "\"ev\": 64.5"), LENSPROF_ERROR_SYNTAX,
         "images[0].ev is 64.5, not within -64 to 64"},
        {with(good, "4.0", "0.0"), LENSPROF_ERROR_EXPOSURE, "images[0].white_balance is not three factors"},
        {with(good, "4.0", "1e999"), LENSPROF_ERROR_SYNTAX, "\"1e999\" is out of range"},
        {with(good, "\"ev_sigma\": 0.125", "\"ev_sigma\": -0.125"), LENSPROF_ERROR_SYNTAX,
         "images[0].ev_sigma is below 0"},
        {with(good, " 0.5,\n", " -0.5,\n"), LENSPROF_ERROR_SYNTAX, "images[0].white_balance_sigma[0] is below 0"},
        {with(good, " 0.5,\n", " 0.5, 1,\n"), LENSPROF_ERROR_SYNTAX,
         "images[0].white_balance_sigma is not an array of"},
        {with(with(good, "\"ev\": 3.0", "\"ev\": null"), "\"ev\": 0.0", "\"ev\": null"), LENSPROF_ERROR_EXPOSURE,
         "images has no image with an \"ev\""},
        {std::string((size_t{64} << 20) + 1, ' '), LENSPROF_ERROR_SIZE, "over 64 MiB"},
    };
    for (const auto &c : cases) {
        Owner owner;
        std::string message;
        const lensprof_status status = read(c.text, owner, message);
        if (status != c.status || message.find(c.words) == message.npos)
            print_error("%s: %s, not %s\n", lensprof_status_name(status), message.c_str(), c.words);
        assert_int_equal(status, c.status);
        assert_non_null(strstr(message.c_str(), c.words));
    }
}

void test_not_written(void **) {
    const struct {
        void (*damage)(Contents &);
        lensprof_status status;
        const char *words;
    } cases[] = {
        {[](Contents &all) { all.info.camera_count = 0; }, LENSPROF_ERROR_ARGUMENT, "no cameras"},
        {[](Contents &all) { all.info.struct_size = 0; }, LENSPROF_ERROR_STRUCT_SIZE, "struct_size is not set"},
        {[](Contents &all) { all.images[1].struct_size -= 8; }, LENSPROF_ERROR_STRUCT_SIZE,
         "images: struct_size differs"},
        {[](Contents &all) { all.lenses[0].struct_size = 4000; }, LENSPROF_ERROR_STRUCT_SIZE,
         "lenses: struct_size is that"},
        {[](Contents &all) { all.info.reference = 4; }, LENSPROF_ERROR_ARGUMENT, "reference is not the index"},
        {[](Contents &all) { all.cameras[1].response.table[9] = 2; }, LENSPROF_ERROR_RESPONSE,
         "camera 1: is not a resp"},
        {[](Contents &all) { all.lenses[1].camera = 5; }, LENSPROF_ERROR_ARGUMENT, "lens 1: camera is not the index"},
        {[](Contents &all) { all.lenses[0].vignettings = 2; }, LENSPROF_ERROR_ARGUMENT,
         "lens 0: vignettings is neither"},
        {[](Contents &all) { all.lenses[0].vignetting[2].k[0] = -2; }, LENSPROF_ERROR_VIGNETTING,
         "lens 0: is not a fall"},
        {[](Contents &all) { all.images[3].lens = 2; }, LENSPROF_ERROR_ARGUMENT, "image 3: lens is not the index"},
        {[](Contents &all) { all.images[0].name = nullptr; }, LENSPROF_ERROR_ARGUMENT, "image 0: has no name"},
        {[](Contents &all) { all.images[3].name = "a.jpg"; }, LENSPROF_ERROR_ARGUMENT,
         "image 3: has the name of another"},
        {[](Contents &all) { all.images[0].file = ""; }, LENSPROF_ERROR_ARGUMENT, "image 0: file is empty"},
        {[](Contents &all) { all.images[0].width = 0; }, LENSPROF_ERROR_ARGUMENT, "image 0: width or height is not"},
        {[](Contents &all) { all.images[0].height = 2000000; }, LENSPROF_ERROR_ARGUMENT, "image 0: width or height is"},
        {[](Contents &all) { all.images[1].exposure.ev = 65; }, LENSPROF_ERROR_EXPOSURE, "image 1: is not an exposure"},
        {[](Contents &all) { all.images[1].ev_sigma = -2; }, LENSPROF_ERROR_ARGUMENT,
         "image 1: a standard error is bel"},
        {[](Contents &all) {
             for (auto &image : all.images) image.exposure.ev = NAN;
         },
         LENSPROF_ERROR_ARGUMENT, "no image has an exposure"},
    };
    for (const auto &c : cases) {
        Contents all = full();
        c.damage(all);
        lensprof_error error;
        std::string text = "untouched";
        assert_int_equal(write(all, text, &error), c.status);
        assert_string_equal(text.c_str(), "untouched");
        if (!strstr(error.text, c.words)) print_error("%s, not %s\n", error.text, c.words);
        assert_non_null(strstr(error.text, c.words));
    }
    Contents all = full();
    lensprof_error error;
    all.images[3].lens = 2;
    std::string text;
    assert_int_equal(write(all, text, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(error.item.kind, LENSPROF_ITEM_IMAGE);
    assert_int_equal(error.item.index, 3);
}

// Written files are not larger than those that are read.
void test_large(void **) {
    Contents all = full();
    const size_t count = 68;
    std::vector<std::string> names(count, std::string(1000000, 'x'));
    all.images.clear();
    for (size_t i = 0; i < count; i++) {
        names[i] += std::to_string(i);
        all.images.push_back(image_of(names[i].c_str(), 0, 0.0));
    }
    std::string text;
    lensprof_error error;
    all.info.image_count = count;
    assert_int_equal(write(all, text, &error), LENSPROF_ERROR_SIZE);
    assert_non_null(strstr(error.text, "over 64 MiB"));
    all.info.image_count = 60;
    Owner owner;
    std::string message;
    assert_ok(read(written(all), owner, message));
}

void test_arguments(void **) {
    Owner owner;
    std::string message;
    lensprof_error error;
    assert_int_equal(lensprof_exposures_read(nullptr, 1, &owner.handle, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_exposures_read("{}", 2, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_ok(read(sample(), owner, message));
    lensprof_exposures_image image;
    lensprof_exposures_image_init(&image);
    image.lens = 77;
    assert_int_equal(lensprof_exposures_get_image(owner.handle, 3, &image, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_exposures_get_image(nullptr, 0, &image, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_exposures_get_image(owner.handle, 0, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    image.struct_size = 0;
    assert_int_equal(lensprof_exposures_get_image(owner.handle, 0, &image, &error), LENSPROF_ERROR_STRUCT_SIZE);
    assert_int_equal(image.lens, 77);
    assert_non_null(strstr(error.text, "_init"));
    lensprof_exposures_destroy(nullptr);
}

// The mean of 1 and 3 EV is 2 EV, that of the factors 1 and 4 is 2; those left out do not count.
void test_mean(void **) {
    const lensprof_exposure exposures[3] = {{1.0, {1.0, 1.0, 0.25}}, {NAN, {9.0, 9.0, 9.0}}, {3.0, {4.0, 1.0, 1.0}}};
    lensprof_exposure mean;
    lensprof_exposure_mean(exposures, 3, &mean);
    assert_true(mean.ev == 2.0);
    assert_close(mean.white_balance[0], 2.0, 1e-15);
    assert_close(mean.white_balance[1], 1.0, 0.0);
    assert_close(mean.white_balance[2], 0.5, 1e-15);
    lensprof_exposure_mean(exposures + 1, 1, &mean);
    assert_true(std::isnan(mean.ev) && std::isnan(mean.white_balance[2]));
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip), cmocka_unit_test(test_sample),      cmocka_unit_test(test_missing),
        cmocka_unit_test(test_refused),    cmocka_unit_test(test_not_written), cmocka_unit_test(test_large),
        cmocka_unit_test(test_arguments),  cmocka_unit_test(test_mean),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
