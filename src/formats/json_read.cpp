// Profiles from JSON.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <memory>

#include "formats/each_format.h"

#include "formats/json.hpp"

namespace lensprof {
namespace {

constexpr double kSameCurve = 1e-6;  // between samples and the curve of their kind: blobs hold singles
constexpr size_t kMaxSamples = 65536;

void check(lensprof_status status, const JsonValue &value, const char *item) {
    if (status != LENSPROF_OK)
        value.fail(std::string("is ") + item + " (" + lensprof_status_name(status) + "); correct it", status);
}

// A text of an object; empty where it is missing or null.
template <size_t capacity>
void read_text(const JsonValue &object, const char *name, char (&field)[capacity]) {
    const JsonValue value = object[name];
    if (!value) return put_text(field, capacity, "");
    const std::string_view text = value.text();
    if (text.size() >= capacity) value.fail("is longer than " + std::to_string(capacity - 1) + " bytes; shorten it");
    for (char c : text)
        if ((c >= 0 && c < ' ') || c == 127) value.fail("has control characters; remove them");
    put_text(field, capacity, text);
}

// A number above 0 of an object; unknown where it is missing or null.
double read_known(const JsonValue &object, const char *name) {
    const JsonValue value = object[name];
    if (!value) return LENSPROF_UNKNOWN;
    const double number = value.number();
    if (!(number > 0.0)) value.fail("is not above 0; correct it, null means unknown");
    return number;
}

// The number of a word in a list.
template <size_t count>
uint32_t read_word(const JsonValue &value, const char *const (&words)[count]) {
    const std::string_view text = value.text();
    for (uint32_t i = 0; i < count; i++)
        if (text == words[i]) return i;
    std::string known = words[0];
    for (size_t i = 1; i < count; i++) known += std::string(i + 1 < count ? ", " : " or ") + words[i];
    value.fail("is " + in_quotes(text) + ", not " + known + "; correct it");
}

void read_key(const JsonValue &object, lensprof_profile_key &key) {
    lensprof_profile_key_init(&key);
    read_text(object, "camera_maker", key.camera_maker);
    read_text(object, "camera_model", key.camera_model);
    read_text(object, "lens", key.lens);
    read_text(object, "unit", key.unit);
    key.crop_factor = read_known(object, "crop_factor");
    key.focal_mm = read_known(object, "focal_mm");
    key.aperture = read_known(object, "aperture");
    const JsonValue distance = object["distance_m"];
    if (distance.is_text() && distance.text() == "infinity")
        key.distance_m = INFINITY;
    else
        key.distance_m = read_known(object, "distance_m");
    key.color_temperature_k = read_known(object, "color_temperature_k");
    key.processing = read_word(object.required("processing"), kJsonProcessings);
    read_text(object, "style", key.style);
    check(lensprof_profile_key_validate(&key), object, "not a valid key");
}

// 1 or 3 items.
uint32_t count_of_curves(const JsonValue &array) {
    const size_t count = array.is_array() ? array.size() : 0;
    if (count != 1 && count != 3) array.fail("does not have one or three curves; correct it");
    return static_cast<uint32_t>(count);
}

void read_grid(const JsonValue &object, lensprof_gain_grid &grid) {
    grid.columns = static_cast<uint32_t>(object.required("columns").integer(2, LENSPROF_GRID_SIDE));
    grid.rows = static_cast<uint32_t>(object.required("rows").integer(2, LENSPROF_GRID_SIDE));
    const JsonValue channels = object.required("attenuation");
    grid.channels = count_of_curves(channels);
    float *node = grid.attenuation;
    const float *const end = node + grid.channels * grid.rows * grid.columns;
    for (JsonValue rows = channels.first(); rows; rows = rows.next()) {
        if (!rows.is_array() || rows.size() != grid.rows) rows.fail("does not have \"rows\" rows; correct it");
        for (JsonValue row = rows.first(); row; row = row.next())
            for (double value : row.numbers(grid.columns, grid.columns)) *node++ = static_cast<float>(value);
    }
    if (node != end) channels.fail("holds null; correct it");
    check(lensprof_gain_grid_validate(&grid), object, "not a valid gain grid");
}

void read_levels(const JsonValue &object, lensprof_levels &levels) {
    const std::vector<double> black = object.required("black").numbers(3, 3);
    std::copy(black.begin(), black.end(), levels.black);
    if (const JsonValue white = object["white"]) levels.white = white.number_within(0.0, 1.0);
    if (levels.white == 1.0) levels.white = 0.0;
    check(lensprof_levels_validate(&levels), object, "black is not below white");
}

void read_circle(const JsonValue &object, lensprof_image_circle &circle) {
    const std::vector<double> center = object.required("center").numbers(2, 2);
    std::copy(center.begin(), center.end(), circle.center);
    const JsonValue radius = object.required("radius");
    circle.radius = radius.number_within(0.0, 4.0);
    if (circle.radius == 0.0) radius.fail("is 0; leave out the circle");
    check(lensprof_image_circle_validate(&circle), object, "not a valid image circle");
}

void read_responses(const JsonValue &object, lensprof_profile &profile) {
    const JsonValue values = object["values"], curves = object["curves"];
    profile.responses = values ? count_of_curves(values) : curves ? count_of_curves(curves) : 1;
    if (curves && count_of_curves(curves) != profile.responses)
        curves.fail("has not as many curves as \"values\"; correct it");
    JsonValue samples = values ? values.first() : values, curve = curves ? curves.first() : object;
    for (uint32_t c = 0; c < profile.responses; c++) {
        if (values && !samples) values.fail("holds null; correct it");
        if (curves && !curve) curves.fail("holds null; correct it");
        read_curve(curve, samples, profile.response[c]);
        if (values) samples = samples.next();
        if (curves) curve = curve.next();
    }
}

void read_covariance(const JsonValue &rows, lensprof_profile &profile) {
    const size_t n = rows.size();
    if (n > LENSPROF_COVARIANCE_MAX) rows.fail("has more than 36 parameters; correct it");
    double *out = profile.covariance;
    for (JsonValue row = rows.first(); row; row = row.next())
        for (double value : row.numbers(n, n)) *out++ = value;
    if (out != profile.covariance + n * n) rows.fail("holds null; correct it");
    profile.covariance_size = static_cast<uint32_t>(n);
}

// Before there were "prior_id" and "forced", the method ended in them: "transfer+12 (forced)".
void split_method(lensprof_provenance &provenance) {
    constexpr std::string_view kForced = " (forced)", kDigits = "0123456789";
    std::string_view method = provenance.method;
    if (method.size() >= kForced.size() && method.substr(method.size() - kForced.size()) == kForced) {
        provenance.forced = 1;
        method.remove_suffix(kForced.size());
    }
    const size_t plus = method.find_last_not_of(kDigits);
    if (plus != method.npos && plus + 1 < method.size() && method[plus] == '+') {
        const std::string_view digits = method.substr(plus + 1);
        const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), provenance.prior_id);
        if (failure != std::errc()) provenance.prior_id = 0;  // no number that an id could be
        method = method.substr(0, plus);
    }
    const std::string base(method);
    put_text(provenance.method, sizeof provenance.method, base);
}

void read_provenance(const JsonValue &object, const char *source, lensprof_provenance &provenance) {
    read_text(object, "method", provenance.method);
    read_text(object, "software", provenance.software);
    if (object["source"] && !object["source"].text().empty())
        read_text(object, "source", provenance.source);
    else
        put_name(provenance.source, sizeof provenance.source, source);
    read_text(object, "doubt", provenance.doubt);
    if (const JsonValue created = object["created_unix_s"])
        provenance.created_unix_s = created.integer(INT64_MIN, INT64_MAX);
    if (const JsonValue images = object["images"])
        provenance.images = static_cast<uint32_t>(images.integer(0, UINT32_MAX));
    if (const JsonValue pairs = object["pairs"]) provenance.pairs = static_cast<uint32_t>(pairs.integer(0, UINT32_MAX));
    if (const JsonValue rms = object["heldout_rms"]) provenance.heldout_rms = rms.number_within(0.0, 255.0);
    if (const JsonValue share = object["inlier_share"]) provenance.inlier_share = share.number_within(0.0, 1.0);
    if (const JsonValue sigma = object["gamma_sigma"]) provenance.gamma_sigma = sigma.number_within(0.0, 1e9);
    if (!object.has("prior_id") && !object.has("forced")) return split_method(provenance);
    if (const JsonValue prior = object["prior_id"]) provenance.prior_id = prior.integer(1, INT64_MAX);
    if (const JsonValue forced = object["forced"]) provenance.forced = forced.boolean();
}

void check_schema(const JsonValue &object) {
    const JsonValue schema = object["schema"];
    if (!schema) return;
    const int64_t version = schema.integer(INT64_MIN, INT64_MAX);
    if (version < 1 || version > kJsonSchema)
        schema.fail(version > kJsonSchema ? "is above 2; use a newer lensprof" : "is not 1 or 2",
                    LENSPROF_ERROR_UNSUPPORTED);
}

void read_profile(const JsonValue &object, const char *source, lensprof_profile &profile) {
    lensprof_profile_init(&profile);
    check_schema(object);
    read_key(object.required("key"), profile.key);
    profile.vignettings = read_vignetting(object.required("vignetting"), profile.vignetting);
    if (const JsonValue grid = object["gain_grid"]) read_grid(grid, profile.grid);
    if (const JsonValue levels = object["levels"]) read_levels(levels, profile.levels);
    if (const JsonValue circle = object["image_circle"]) read_circle(circle, profile.image_circle);
    if (const JsonValue response = object["response"]) read_responses(response, profile);
    if (const JsonValue covariance = object["covariance"]) read_covariance(covariance, profile);
    if (const JsonValue provenance = object["provenance"])
        read_provenance(provenance, source, profile.provenance);
    else
        put_name(profile.provenance.source, sizeof profile.provenance.source, source);
    check(lensprof_profile_validate(&profile), object, "not a valid profile");
}

// Calls use(profile) for every profile of the text until it does not return OK.
template <typename Use>
lensprof_status walk(const JsonText &text, const char *source, lensprof_profile &profile, Use use) {
    const JsonValue root = text.root();
    if (!root.is_object()) root.fail("is not an object; give that of a profile, or one with a list of profiles");
    const JsonValue list = root["profiles"];
    if (!list) {
        read_profile(root, source, profile);
        return use(profile);
    }
    check_schema(root);
    if (!list.is_array()) list.fail("is not an array; correct it");
    lensprof_status status = LENSPROF_OK;
    size_t read = 0;
    for (JsonValue item = list.first(); item && status == LENSPROF_OK; item = item.next(), read++) {
        read_profile(item, source, profile);
        status = use(profile);
    }
    if (status == LENSPROF_OK && read != list.size()) list.fail("holds null; remove it");
    return status;
}

}  // namespace

uint32_t read_vignetting(const JsonValue &object, lensprof_vignetting (&vignetting)[3]) {
    const JsonValue curves = object.required("k"), center = object["center"];
    const uint32_t count = count_of_curves(curves);
    lensprof_vignetting *v = vignetting;
    for (JsonValue k = curves.first(); k; k = k.next(), v++) {
        const std::vector<double> terms = k.numbers(3, 3);
        std::copy(terms.begin(), terms.end(), v->k);
        if (center) {
            const std::vector<double> xy = center.numbers(2, 2);
            std::copy(xy.begin(), xy.end(), v->center);
        }
        check(lensprof_vignetting_validate(v), k, "not a valid falloff");
    }
    if (v != vignetting + count) curves.fail("holds null; correct it");
    return count;
}

void read_curve(const JsonValue &object, const JsonValue &samples, lensprof_response &response) {
    const uint32_t kind = read_word(object.required("kind"), kJsonResponseKinds);
    if (kind == LENSPROF_RESPONSE_TABLE) {
        if (!samples) object.fail("has no \"values\"; add them");
        const std::vector<double> values = samples.numbers(2, kMaxSamples);
        return check(lensprof_response_set_table(&response, values.data(), static_cast<uint32_t>(values.size())),
                     samples, "not a response that rises from 0 to 1");
    }
    if (kind == LENSPROF_RESPONSE_GAMMA) {
        const JsonValue gamma = object.required("gamma");
        check(lensprof_response_set_gamma(&response, gamma.number()), gamma, "not an exponent of 0.1 to 10");
    } else if (kind == LENSPROF_RESPONSE_EMOR) {
        const JsonValue emor = object.required("emor");
        const std::vector<double> terms = emor.numbers(0, LENSPROF_EMOR_MODES);
        lensprof_response_set_linear(&response);
        check(lensprof_response_set_emor(&response, terms.data(), static_cast<uint32_t>(terms.size())), emor,
              "not a response that rises");
    } else {
        lensprof_response_set_linear(&response);
    }
    if (!samples) return;
    const std::vector<double> values = samples.numbers(LENSPROF_RESPONSE_SAMPLES, LENSPROF_RESPONSE_SAMPLES);
    for (size_t j = 0; j < values.size(); j++)
        if (!(std::fabs(values[j] - response.table[j]) <= kSameCurve))
            samples.fail("does not match the curve of its kind; leave \"values\" out, or set the kind to \"table\"");
    std::copy(values.begin(), values.end(), response.table);
    check(lensprof_response_validate(&response), samples, "not a response that rises from 0 to 1");
}

}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_json_read(const void *data, size_t size, const char *source, lensprof_import_visitor visit,
                             void *user, lensprof_error *error) {
    if ((!data && size) || !visit) {
        set_error(error, "lensprof_import: data or visit is NULL; pass a buffer and a function");
        return LENSPROF_ERROR_ARGUMENT;
    }
    lensprof_status visited = LENSPROF_OK;
    const lensprof_status status = at_boundary(error, [&] {
        const JsonText json(view_of(data, size));
        const auto profile = std::make_unique<lensprof_profile>();
        walk(json, source, *profile, [](lensprof_profile &) { return LENSPROF_OK; });  // all are checked first
        visited = walk(json, source, *profile, [&](lensprof_profile &found) {
            const lensprof_import_entry entry = {&found, 1, 0, 0.0};
            return visit(user, &entry);
        });
    });
    return status == LENSPROF_OK ? visited : status;
}
