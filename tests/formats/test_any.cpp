// One call for all formats: format detection, the results of import and export, and what both refuse.
#include <fstream>
#include <iterator>

#include "import_support.hpp"

namespace {

std::string corpus(const std::string &file) {
    std::ifstream stream(std::string(LENSPROF_CORPUS) + "/" + file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (bytes.empty()) fail_msg("%s is not there", file.c_str());
    return bytes;
}

// A file of every format, and whether its content alone identifies the format.
struct Sample {
    uint32_t format;
    const char *file, *name;
    bool by_content;
    size_t entries;
};
constexpr uint32_t kLast = LENSPROF_FORMAT_C;
constexpr Sample kSamples[] = {
    {LENSPROF_FORMAT_LENSFUN, "lensfun/version2.xml", "a.xml", true, 0},
    {LENSPROF_FORMAT_LENSFUN, "lensfun/version1.xml", "a.xml", true, 0},
    {LENSPROF_FORMAT_LCP, "lcp/attributes.lcp", "a.lcp", true, 0},
    {LENSPROF_FORMAT_LCP, "lcp/elements.lcp", "a.lcp", true, 0},
    {LENSPROF_FORMAT_JSON, "json/one.json", "a.json", true, 1},
    {LENSPROF_FORMAT_JSON, "json/several.json", "a.json", true, 0},
    {LENSPROF_FORMAT_BLOB, "blob/emor.blob", "a.blob", true, 1},
    {LENSPROF_FORMAT_DNG_OPCODES, "dng_opcodes/planes.opcodes", "a.dng", false, 1},
    {LENSPROF_FORMAT_DRONE_XMP, "drone_xmp/dji.xmp", "a.xmp", true, 1},
    {LENSPROF_FORMAT_DRONE_XMP, "drone_xmp/micasense.xmp", "a.xmp", true, 1},
    {LENSPROF_FORMAT_DRONE_XMP, "drone_xmp/sentera.xmp", "a.xmp", true, 1},
    {LENSPROF_FORMAT_ALSC, "maps/tuning.json", "a.json", true, 1},
    {LENSPROF_FORMAT_PCALIB, "curves/pcalib.txt", "a.txt", false, 1},
    {LENSPROF_FORMAT_CURVES, "curves/rgb.csv", "a.csv", false, 1},
    {LENSPROF_FORMAT_CURVES, "curves/pfs.m", "a.m", true, 1},
    {LENSPROF_FORMAT_RADICAL_RESPONSE, "maps/response.crf", "a.crf", false, 1},
    {LENSPROF_FORMAT_RADICAL_VIGNETTING, "maps/one_center.vgn", "a.vgn", true, 1},
    {LENSPROF_FORMAT_CUBE, "cube/inverse.cube", "a.cube", true, 1},
    {LENSPROF_FORMAT_CUBE, "cube/resolve.cube", "a.cube", true, 1},
};

lensprof_import_options import_options(uint32_t format = LENSPROF_FORMAT_AUTO, const char *name = nullptr) {
    lensprof_import_options options;
    lensprof_import_options_init(&options);
    options.format = format;
    options.name = name;
    options.width = 60, options.height = 40;
    options.columns = 4, options.rows = 3;
    return options;
}

// Entries, and what the file holds for each.
struct Found : Imported {
    std::vector<uint32_t> holds;
};

lensprof_status keep_holds(void *user, const lensprof_import_entry *entry) {
    auto *found = static_cast<Found *>(user);
    found->holds.push_back(entry->holds);
    return keep_entry(found, entry);
}

Found import(const std::string &bytes, const lensprof_import_options *options) {
    Found found;
    lensprof_error error{};
    found.status = lensprof_import(bytes.data(), bytes.size(), options, keep_holds, &found, &error);
    found.error = error.text;
    assert_int_equal(found.status == LENSPROF_OK, found.error.empty());
    if (found.status != LENSPROF_OK) assert_int_equal(found.profiles.size(), 0);
    return found;
}

void test_formats_are_known(void **) {
    assert_null(lensprof_format_get_info(LENSPROF_FORMAT_AUTO));
    assert_null(lensprof_format_get_info(kLast + 1));
    for (uint32_t format = 1; format <= kLast; format++) {
        const lensprof_format_info *info = lensprof_format_get_info(format);
        assert_int_equal(info->format, format);
        assert_true(*info->name && strlen(info->about) > 10 && info->holds <= LENSPROF_HOLDS_FALLOFF);
        assert_true(!info->is_many || info->holds == LENSPROF_HOLDS_PROFILES);
        assert_int_equal(info->is_written == 2, format >= LENSPROF_FORMAT_GLSL);
        assert_true(info->is_written <= 2);
    }
}

void test_content_comes_before_the_name(void **) {
    for (const Sample &sample : kSamples) {
        const std::string bytes = corpus(sample.file);
        const auto detect = [&](const char *name) { return lensprof_format_detect(bytes.data(), bytes.size(), name); };
        if (detect(sample.name) != sample.format) fail_msg("%s is detected as %u", sample.file, detect(sample.name));
        const uint32_t alone = sample.by_content ? sample.format : uint32_t(LENSPROF_FORMAT_AUTO);
        if (detect(nullptr) != alone) fail_msg("%s without a name: %u", sample.file, detect(nullptr));
        if (detect("folder.csv/none") != alone) fail_msg("%s in a folder: %u", sample.file, detect("folder.csv/none"));
        for (const char *wrong : {"a.csv", "a.vgn", "a.png"})
            if (sample.by_content && detect(wrong) != sample.format)
                fail_msg("%s as %s: %u", sample.file, wrong, detect(wrong));
    }
}

void test_words_of_other_formats_in_json(void **) {
    for (const char *word :
         {"<lensdatabase", "CameraProfiles", "VignettingModel", "a luminance_lut", "Pi rpi.hq cam"}) {
        const std::string text = std::string("\n{\"key\":{\"lens\":\"") + word + "\"}}", marked = "\xEF\xBB\xBF" + text;
        assert_int_equal(lensprof_format_detect(text.data(), text.size(), "a.xml"), LENSPROF_FORMAT_JSON);
        assert_int_equal(lensprof_format_detect(marked.data(), marked.size(), nullptr), LENSPROF_FORMAT_JSON);
    }
    const std::string table = "\xEF\xBB\xBF{\"rpi.alsc\":{}}";
    assert_int_equal(lensprof_format_detect(table.data(), table.size(), "a.json"), LENSPROF_FORMAT_ALSC);
}

void test_names_alone(void **) {
    const std::pair<const char *, uint32_t> names[] = {{"a.xml", LENSPROF_FORMAT_LENSFUN},
                                                       {"a.lcp", LENSPROF_FORMAT_LCP},
                                                       {"a.json", LENSPROF_FORMAT_JSON},
                                                       {"a.blob", LENSPROF_FORMAT_BLOB},
                                                       {"a.dng", LENSPROF_FORMAT_DNG_OPCODES},
                                                       {"a.xmp", LENSPROF_FORMAT_DRONE_XMP},
                                                       {"a.png", LENSPROF_FORMAT_MAP},
                                                       {"b/c.d/a.TIF", LENSPROF_FORMAT_MAP},
                                                       {"a.tiff", LENSPROF_FORMAT_MAP},
                                                       {"a.txt", LENSPROF_FORMAT_PCALIB},
                                                       {"a.csv", LENSPROF_FORMAT_CURVES},
                                                       {"a.m", LENSPROF_FORMAT_CURVES},
                                                       {"a.CRF", LENSPROF_FORMAT_RADICAL_RESPONSE},
                                                       {"a.vgn", LENSPROF_FORMAT_RADICAL_VIGNETTING},
                                                       {"a.cube", LENSPROF_FORMAT_CUBE},
                                                       {"a.glsl", LENSPROF_FORMAT_GLSL},
                                                       {"a.wgsl", LENSPROF_FORMAT_WGSL},
                                                       {"a.H", LENSPROF_FORMAT_C},
                                                       {"a", LENSPROF_FORMAT_AUTO},
                                                       {"", LENSPROF_FORMAT_AUTO},
                                                       {"a.jpeg2000", LENSPROF_FORMAT_AUTO},
                                                       {"a.csv/b", LENSPROF_FORMAT_AUTO}};
    for (const auto &[name, format] : names)
        if (lensprof_format_detect(nullptr, 0, name) != format) fail_msg("%s", name);
    assert_int_equal(lensprof_format_detect(nullptr, 0, nullptr), LENSPROF_FORMAT_AUTO);
    assert_int_equal(lensprof_format_detect("hello", 5, "a.csv"), LENSPROF_FORMAT_CURVES);
}

void test_each_is_read(void **) {
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    snprintf(key.lens, sizeof key.lens, "my lens");
    key.processing = LENSPROF_PROCESSING_CORRECTED;
    for (const Sample &sample : kSamples) {
        const std::string bytes = corpus(sample.file);
        auto options = import_options(LENSPROF_FORMAT_AUTO, sample.name);
        const Found plain = import(bytes, &options);
        if (plain.status != LENSPROF_OK) fail_msg("%s: %s", sample.file, plain.error.c_str());
        if (plain.profiles.empty() || (sample.entries && plain.profiles.size() != sample.entries))
            fail_msg("%s: %zu entries", sample.file, plain.profiles.size());
        const uint32_t holds = lensprof_format_get_info(sample.format)->holds;
        assert_int_equal(plain.holds[0], holds);
        if (holds == LENSPROF_HOLDS_PROFILES) continue;
        const lensprof_profile &p = *plain.profiles[0];
        assert_string_equal(p.provenance.method, "import");
        assert_string_equal(p.provenance.source, sample.name);
        const bool is_response = holds == LENSPROF_HOLDS_RESPONSE;
        assert_int_equal(p.key.processing, is_response ? LENSPROF_PROCESSING_JPEG : LENSPROF_PROCESSING_RAW);
        assert_int_equal(p.response[0].kind, is_response ? LENSPROF_RESPONSE_TABLE : LENSPROF_RESPONSE_LINEAR);
        options.key = &key;
        const Found named = import(bytes, &options);
        assert_string_equal(named.profiles[0]->key.lens, "my lens");
        assert_int_equal(named.profiles[0]->key.processing, LENSPROF_PROCESSING_CORRECTED);
        if (sample.format == LENSPROF_FORMAT_DRONE_XMP) assert_true(*named.profiles[0]->key.camera_maker != 0);
        assert_memory_equal(named.profiles[0]->vignetting, p.vignetting, sizeof p.vignetting);
    }
}

// The functions of the formats and lensprof_import give the same results.
void test_same_as_by_hand(void **) {
    const std::string table = corpus("curves/rgb.csv"), vgn = corpus("maps/centers.vgn");
    auto responses = std::make_unique<lensprof_response[]>(3);
    uint32_t count = 0;
    assert_ok(lp_curves_read(table.data(), table.size(), LENSPROF_CURVE_INVERSE, responses.get(), &count, nullptr));
    const auto options = import_options(LENSPROF_FORMAT_CURVES);
    const Found curves = import(table, &options);
    assert_int_equal(curves.profiles[0]->responses, count);
    assert_memory_equal(curves.profiles[0]->response, responses.get(), count * sizeof responses[0]);
    const auto own = profile_of(0, 0, 0);
    double worst = 0.0;
    assert_ok(lp_radical_vignetting_read(vgn.data(), vgn.size(), own.get(), &worst, nullptr));
    const Found found = import(vgn, nullptr);
    assert_memory_equal(found.profiles[0]->vignetting, own->vignetting, sizeof own->vignetting);
    assert_memory_equal(&found.profiles[0]->grid, &own->grid, sizeof own->grid);
}

void test_wrong_content_under_a_right_name(void **) {
    for (const char *name : {"a.xml", "a.lcp", "a.json", "a.blob", "a.dng", "a.xmp", "a.txt", "a.csv", "a.crf", "a.vgn",
                             "a.cube", "a.glsl", "a.wgsl", "a.h"})
        for (const char *content : {"These are not the numbers you want.", "<html><body/></html>", "\0\0\0\0"}) {
            const auto options = import_options(LENSPROF_FORMAT_AUTO, name);
            const std::string bytes(content, *content ? strlen(content) : 4);
            const Found found = import(bytes, &options);
            const bool is_known = found.status == LENSPROF_ERROR_SYNTAX || found.status == LENSPROF_ERROR_NOT_FOUND
                                  || found.status == LENSPROF_ERROR_UNSUPPORTED;
            if (!is_known && !(found.status == LENSPROF_OK && found.profiles.empty()))
                fail_msg("%s with \"%s\": %s", name, content, lensprof_status_name(found.status));
        }
    for (const Sample &sample : kSamples) {  // another format's bytes under a forced format
        const uint32_t other = sample.format == LENSPROF_FORMAT_PCALIB ? LENSPROF_FORMAT_JSON : LENSPROF_FORMAT_PCALIB;
        const auto options = import_options(other);
        assert_int_not_equal(import(corpus(sample.file), &options).status, LENSPROF_OK);
    }
}

void refused(const std::string &bytes, lensprof_import_options options, lensprof_status status, const char *words) {
    const Found found = import(bytes, &options);
    if (found.status != status || found.error.find(words) == std::string::npos)
        fail_msg("%s: %s, not %s", lensprof_status_name(found.status), found.error.c_str(), words);
}

void test_empty_large_and_unknown(void **) {
    for (uint32_t format = 0; format <= kLast; format++)
        if (format != LENSPROF_FORMAT_MAP)
            refused("", import_options(format, "a.csv"), LENSPROF_ERROR_SYNTAX, "is empty");
    refused("hello", import_options(), LENSPROF_ERROR_UNSUPPORTED, "specify the format");
    refused("hello", import_options(LENSPROF_FORMAT_AUTO, "a.doc"), LENSPROF_ERROR_UNSUPPORTED, "specify the format");
    refused("hello", import_options(kLast + 1), LENSPROF_ERROR_ARGUMENT, "unknown format");
    for (const uint32_t format : {LENSPROF_FORMAT_GLSL, LENSPROF_FORMAT_WGSL, LENSPROF_FORMAT_C})
        refused("hello", import_options(format), LENSPROF_ERROR_UNSUPPORTED, "export JSON or a blob");
    refused("hello", import_options(LENSPROF_FORMAT_AUTO, "a.h"), LENSPROF_ERROR_UNSUPPORTED, "c is written only");
    lensprof_error error{};
    Found found;
    const char byte = '{';  // only one byte is accessible: a file that is too large is not read
    assert_int_equal(lensprof_import(&byte, (size_t{64} << 20) + 1, nullptr, keep_holds, &found, &error),
                     LENSPROF_ERROR_SIZE);
    assert_non_null(strstr(error.text, "64 MiB"));
    assert_int_equal(lensprof_import(nullptr, 1, nullptr, keep_holds, &found, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_import(&byte, 1, nullptr, nullptr, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
}

void test_options_are_checked(void **) {
    auto options = import_options(LENSPROF_FORMAT_ALSC);
    options.width = 0;
    refused(corpus("maps/tuning.json"), options, LENSPROF_ERROR_SIZE, "width and height");
    options = import_options();
    options.struct_size = 8;
    refused("{}", options, LENSPROF_ERROR_STRUCT_SIZE, "struct_size");
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    key.focal_mm = -3;
    options = import_options();
    options.key = &key;
    refused(corpus("maps/one_center.vgn"), options, LENSPROF_ERROR_ARGUMENT, "key");
    const float value = 1;
    const lensprof_map map = {1, 1, 1, 0, &value};
    options = import_options(LENSPROF_FORMAT_JSON);
    options.map = &map;
    refused("{}", options, LENSPROF_ERROR_ARGUMENT, "a map");
}

void test_containers_are_the_callers(void **) {
    const std::string tiff("II*\0....", 8), png = "\x89PNG....", jpeg = "\xFF\xD8\xFF....";
    refused(tiff, import_options(LENSPROF_FORMAT_AUTO, "a.dng"), LENSPROF_ERROR_UNSUPPORTED, "OpcodeList2");
    refused(tiff, import_options(LENSPROF_FORMAT_AUTO, "a.tif"), LENSPROF_ERROR_UNSUPPORTED, "lensprof_map");
    refused(png, import_options(), LENSPROF_ERROR_UNSUPPORTED, "lensprof_map");
    refused(jpeg, import_options(), LENSPROF_ERROR_UNSUPPORTED, "XMP packet");
}

void test_maps(void **) {
    const auto truth = profile_of(-0.3, 0.05, 0);
    std::vector<float> values(60 * 40);
    assert_ok(lensprof_map_write(truth.get(), 600, 400, 60, 40, 1, LENSPROF_MAP_ATTENUATION, values.data(), nullptr));
    lensprof_map map = {60, 40, 1, LENSPROF_MAP_ATTENUATION, values.data()};
    auto options = import_options(LENSPROF_FORMAT_MAP, "vignette.png");
    options.width = 600, options.height = 400;
    options.map = &map;
    const Found found = import("", &options);
    assert_ok(found.status);
    assert_true(largest_difference(*found.profiles[0], *truth, 600, 400, 1) < 0.002);
    assert_string_equal(found.profiles[0]->provenance.doubt, "");
    map.sense = LENSPROF_MAP_GAIN;  // the inverse rises
    const Found gain = import("", &options);
    assert_non_null(strstr(gain.profiles[0]->provenance.doubt, "is it a gain?"));
}

void test_visitors_answer(void **) {
    lensprof_error error{};
    for (const Sample &sample : kSamples) {
        const std::string bytes = corpus(sample.file);
        const auto options = import_options(LENSPROF_FORMAT_AUTO, sample.name);
        const lensprof_status status =
            lensprof_import(bytes.data(), bytes.size(), &options, refuse_entry, nullptr, &error);
        if (status != LENSPROF_ERROR_CANCELLED) fail_msg("%s: %s", sample.file, error.text);
    }
}

// ---- export ----

lensprof_export_options export_options(uint32_t format = LENSPROF_FORMAT_AUTO, const char *name = nullptr) {
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = format;
    options.name = name;
    options.width = 600, options.height = 400;
    return options;
}

std::string exported(const std::vector<const lensprof_profile *> &profiles, const lensprof_export_options &options,
                     lensprof_status *status = nullptr, std::string *why = nullptr) {
    size_t count = 0;
    lensprof_error error{};
    const auto number = static_cast<uint32_t>(profiles.size());
    lensprof_status done = lensprof_export(profiles.data(), number, &options, nullptr, 0, &count, &error);
    std::string bytes(count, 0);
    if (done == LENSPROF_OK)
        done = lensprof_export(profiles.data(), number, &options, bytes.data(), count, &count, &error);
    if (status) *status = done;
    if (why) *why = error.text;
    if (!status && done != LENSPROF_OK) fail_msg("%s", error.text);
    return bytes;
}

std::unique_ptr<lensprof_profile> lens(const char *name = "Acme 50mm") {
    auto profile = profile_of(-0.3, 0.05, 0);
    snprintf(profile->key.lens, sizeof profile->key.lens, "%s", name);
    profile->key.crop_factor = 1.5, profile->key.focal_mm = 50, profile->key.aperture = 2.8;
    profile->key.processing = LENSPROF_PROCESSING_RAW;
    assert_ok(lensprof_response_set_gamma(&profile->response[0], 2.2));
    return profile;
}

// What is written under a name is read back under this name.
void test_there_and_back(void **) {
    const auto p = lens();
    for (const char *name :
         {"a.xml", "a.lcp", "a.json", "a.blob", "a.dng", "a.txt", "a.csv", "a.crf", "a.vgn", "a.cube"}) {
        const std::string bytes = exported({p.get()}, export_options(LENSPROF_FORMAT_AUTO, name));
        auto options = import_options(LENSPROF_FORMAT_AUTO, name);
        options.width = 600, options.height = 400;
        const Found found = import(bytes, &options);
        const size_t distances = !strcmp(name, "a.xml") ? 2 : 1;  // 10 and 1000 m
        if (found.status != LENSPROF_OK || found.profiles.size() != distances)
            fail_msg("%s: %s", name, found.error.c_str());
        const lensprof_profile &again = *found.profiles[0];
        const uint32_t holds = found.holds[0];
        if (holds != LENSPROF_HOLDS_RESPONSE && largest_difference(again, *p, 600, 400, 1) > 0.006)
            fail_msg("%s: another falloff", name);
        const bool has_response =
            holds == LENSPROF_HOLDS_RESPONSE || !strcmp(name, "a.json") || !strcmp(name, "a.blob");
        for (double x = 0.1; has_response && x < 1.0; x += 0.1)
            assert_close(lensprof_response_eval(&again.response[0], x, nullptr), pow(x, 1 / 2.2), 0.01);
    }
    const auto alsc = export_options(LENSPROF_FORMAT_ALSC);
    assert_int_equal(lensprof_format_detect(exported({p.get()}, alsc).data(), 200, nullptr), LENSPROF_FORMAT_ALSC);
}

void test_opcode_by_its_error(void **) {
    const auto smooth = lens(), steep = lens();
    steep->vignetting[0] = {{-3.9, 6.5, -3.55}, {0, 0}};  // which the opcode's five coefficients cannot represent
    steep->grid.columns = steep->grid.rows = 2, steep->grid.channels = 1;
    for (int i = 0; i < 4; i++) steep->grid.attenuation[i] = 0.8f;
    const auto id_of = [](const std::string &list) { return static_cast<int>(list.at(7)); };  // of the first opcode
    auto options = export_options(LENSPROF_FORMAT_DNG_OPCODES);
    assert_int_equal(id_of(exported({smooth.get()}, options)), 3);
    assert_int_equal(id_of(exported({steep.get()}, options)), 9);
    options.dng_form = LENSPROF_DNG_GAIN_MAP;
    assert_int_equal(id_of(exported({smooth.get()}, options)), 9);
}

// A file larger than the import limit is not written, even into a large enough buffer.
void test_export_too_large(void **) {
    const auto p = lens();
    p->responses = 3;
    for (uint32_t c = 0; c < 3; c++) {
        p->response[c].kind = LENSPROF_RESPONSE_TABLE;
        for (uint32_t i = 0; i < LENSPROF_RESPONSE_SAMPLES; i++)
            p->response[c].table[i] = sqrt(i / (LENSPROF_RESPONSE_SAMPLES - 1.0));
    }
    const auto options = export_options(LENSPROF_FORMAT_JSON);
    const size_t one = exported({p.get()}, options).size();
    const std::vector<const lensprof_profile *> many((size_t{64} << 20) / one + 20, p.get());
    std::string buffer(size_t{80} << 20, '?');
    lensprof_error error{};
    size_t size = 7;
    assert_int_equal(lensprof_export(many.data(), static_cast<uint32_t>(many.size()), &options, buffer.data(),
                                     buffer.size(), &size, &error),
                     LENSPROF_ERROR_SIZE);
    assert_non_null(strstr(error.text, "64 MiB"));
    assert_int_equal(size, 7);
    assert_true(buffer.find_first_not_of('?') == std::string::npos);
}

void test_export_refuses(void **) {
    const auto p = lens(), q = lens("Acme 85mm");
    const auto refuses = [&](const std::vector<const lensprof_profile *> &profiles, lensprof_export_options options,
                             lensprof_status wanted, const char *words) {
        lensprof_status status;
        std::string why;
        exported(profiles, options, &status, &why);
        if (status != wanted || why.find(words) == std::string::npos)
            fail_msg("%s: %s, not %s", lensprof_status_name(status), why.c_str(), words);
    };
    refuses({p.get()}, export_options(), LENSPROF_ERROR_UNSUPPORTED, "specify the format");
    refuses({p.get()}, export_options(LENSPROF_FORMAT_AUTO, "a.m"), LENSPROF_ERROR_UNSUPPORTED, "read only");
    refuses({p.get()}, export_options(LENSPROF_FORMAT_DRONE_XMP), LENSPROF_ERROR_UNSUPPORTED, "xmp is read only");
    refuses({p.get()}, export_options(LENSPROF_FORMAT_MAP), LENSPROF_ERROR_UNSUPPORTED, "lensprof_map_write");
    refuses({p.get()}, export_options(99), LENSPROF_ERROR_ARGUMENT, "unknown format");
    refuses({p.get(), q.get()}, export_options(LENSPROF_FORMAT_BLOB), LENSPROF_ERROR_ARGUMENT, "holds one profile");
    refuses({}, export_options(LENSPROF_FORMAT_BLOB), LENSPROF_ERROR_ARGUMENT, "holds one profile");
    for (const uint32_t format : {LENSPROF_FORMAT_BLOB, LENSPROF_FORMAT_JSON, LENSPROF_FORMAT_LCP}) {
        const auto of_none = export_options(format);
        refuses({nullptr}, of_none, LENSPROF_ERROR_ARGUMENT, "profile 0: is ");
        const lensprof_profile *const none = nullptr;
        lensprof_error error{};
        size_t size = 0;
        assert_int_equal(lensprof_export(&none, 1, &of_none, nullptr, 0, &size, &error), LENSPROF_ERROR_ARGUMENT);
        assert_int_equal(error.item.kind, LENSPROF_ITEM_PROFILE);
        assert_int_equal(error.item.text_bytes, strlen("profile 0"));
    }
    auto options = export_options(LENSPROF_FORMAT_RADICAL_VIGNETTING);
    options.width = 0;
    refuses({p.get()}, options, LENSPROF_ERROR_SIZE, "");
    options = export_options(LENSPROF_FORMAT_BLOB);
    options.pack = 8;
    refuses({p.get()}, options, LENSPROF_ERROR_ARGUMENT, "flags");
    options.struct_size = 4;
    refuses({p.get()}, options, LENSPROF_ERROR_STRUCT_SIZE, "struct_size");
    for (uint32_t format = LENSPROF_FORMAT_AUTO + 1; format <= kLast; format++) {
        const auto broken = std::make_unique<lensprof_profile>(*p);
        broken->responses = 2000000000;
        auto of_broken = export_options(format);
        of_broken.width = 60, of_broken.height = 40;
        const lensprof_profile *const pointer = broken.get();
        lensprof_error error{};
        size_t size = 0;
        assert_int_not_equal(lensprof_export(&pointer, 1, &of_broken, nullptr, 0, &size, &error), LENSPROF_OK);
        assert_true(*error.text);
    }
    const Found both = import(exported({p.get(), q.get()}, export_options(LENSPROF_FORMAT_JSON)), nullptr);
    assert_int_equal(both.profiles.size(), 2);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_formats_are_known),
        cmocka_unit_test(test_content_comes_before_the_name),
        cmocka_unit_test(test_words_of_other_formats_in_json),
        cmocka_unit_test(test_names_alone),
        cmocka_unit_test(test_each_is_read),
        cmocka_unit_test(test_same_as_by_hand),
        cmocka_unit_test(test_wrong_content_under_a_right_name),
        cmocka_unit_test(test_empty_large_and_unknown),
        cmocka_unit_test(test_options_are_checked),
        cmocka_unit_test(test_containers_are_the_callers),
        cmocka_unit_test(test_maps),
        cmocka_unit_test(test_visitors_answer),
        cmocka_unit_test(test_there_and_back),
        cmocka_unit_test(test_opcode_by_its_error),
        cmocka_unit_test(test_export_too_large),
        cmocka_unit_test(test_export_refuses),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
