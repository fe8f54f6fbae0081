// Lens shading tables of libcamera's Raspberry Pi tuning files, to a falloff.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/each_format.h"

#include "formats/alsc.hpp"
#include "formats/falloff/map.hpp"
#include "formats/text/json_text.hpp"

namespace lensprof {
namespace {

constexpr double kMaxGain = 1000.0;
constexpr size_t kMaxValues = 65536;

// libcamera reads tuning files as YAML, which accepts a comma before a closing bracket. Blanks keep the line numbers.
std::string without_last_commas(std::string_view text) {
    std::string plain(text);
    size_t comma = std::string::npos;  // the one that may be the last of its bracket
    char before = '[';                 // the last character that is not blank
    bool is_quoted = false;
    for (size_t i = 0; i < plain.size(); i++) {
        const char c = plain[i];
        if (is_quoted) {
            if (c == '\\')
                i++;
            else
                is_quoted = c != '"';
            continue;
        }
        if (is_blank(c) || c == '\r' || c == '\n') continue;
        if ((c == ']' || c == '}') && comma != std::string::npos) plain[comma] = ' ';
        const bool follows_value = before != '[' && before != '{' && before != ',' && before != ':';
        comma = c == ',' && follows_value ? i : std::string::npos;
        is_quoted = c == '"';
        before = c;
    }
    return plain;
}

[[noreturn]] void fail_without_table(const JsonValue &value, const std::string &what) {
    value.fail("has no " + what + ", that is, no table of lens shading; give another file", LENSPROF_ERROR_NOT_FOUND);
}

// The algorithm's object: the text itself, a member of it (tuning files of version 1), or a member of an item of
// `algorithms` (version 2).
JsonValue find_alsc(const JsonValue &root) {
    if (!root.is_object()) root.fail("is not an object; give a tuning file of libcamera, or its \"rpi.alsc\"");
    if (const JsonValue direct = root[kAlscName]) return direct;
    if (const JsonValue list = root["algorithms"]) {
        for (JsonValue item = list.first(); item; item = item.next())
            if (item.is_object() && item[kAlscName]) return item[kAlscName];
        fail_without_table(list, "\"rpi.alsc\"");
    }
    for (JsonValue item = root.first(); item; item = item.next())
        if (item.path().rfind("rpi.", 0) == 0) fail_without_table(root, "\"rpi.alsc\"");
    return root;
}

// Green's gains, which libcamera takes as 1 where they are missing.
JsonValue luminance_of(const JsonValue &root, const JsonValue &alsc) {
    const bool is_in_tuning_file = alsc.path() != root.path();
    if (is_in_tuning_file && alsc.is_object() && !alsc["luminance_lut"]) fail_without_table(alsc, "\"luminance_lut\"");
    if (alsc.is_object() && alsc["corner_strength"])
        alsc["corner_strength"].fail("makes libcamera ignore \"luminance_lut\"; remove it to read the table",
                                     LENSPROF_ERROR_UNSUPPORTED);
    return alsc.required("luminance_lut");
}

// Columns and rows of a table of so many values.
void find_shape(const JsonValue &table, size_t count, uint32_t &columns, uint32_t &rows) {
    if (!columns && !rows) {
        if (count == 16 * 12)
            columns = 16, rows = 12;
        else if (count == 32 * 32)
            columns = rows = 32;
        else
            table.fail("has " + std::to_string(count) + " values, not 16 x 12 or 32 x 32; give columns and rows");
    }
    if (uint64_t{columns} * rows != count)
        table.fail("has " + std::to_string(count) + " values, not " + std::to_string(columns) + " x "
                   + std::to_string(rows) + "; give other columns and rows");
}

std::vector<double> gains_of(const JsonValue &table) {
    const std::vector<double> gains = table.numbers(4, kMaxValues);
    for (size_t i = 0; i < gains.size(); i++)
        if (!(gains[i] >= 1.0 / kMaxGain && gains[i] <= kMaxGain))
            table.fail(
                "has " + number_text(gains[i]) + " at " + std::to_string(i) + ", which is not a gain; correct it",
                LENSPROF_ERROR_VIGNETTING);
    return gains;
}

// The table of a colour temperature, as libcamera finds it: between the two nearest ones linearly, beyond the ends as
// there. All 1 without a table.
std::vector<double> ratios_at(const JsonValue &calibrations, double ct, size_t count) {
    std::vector<double> ratios(count, 1.0);
    if (!calibrations) return ratios;
    if (!calibrations.is_array()) calibrations.fail("is not an array; correct it");
    double before_ct = 0.0;
    std::vector<double> before;
    for (JsonValue item = calibrations.first(); item; item = item.next()) {
        const double item_ct = item.required("ct").number_within(1.0, 1e6);
        const JsonValue table = item.required("table");
        const std::vector<double> gains = gains_of(table);
        if (gains.size() != count)
            table.fail("has " + std::to_string(gains.size()) + " values, the luminance " + std::to_string(count)
                       + "; correct it");
        if (item_ct <= before_ct) item.fail("does not have a higher ct than the one before; sort them");
        const double share = before.empty() ? 1.0 : std::clamp((ct - before_ct) / (item_ct - before_ct), 0.0, 1.0);
        if (before.empty() || ct > before_ct)
            for (size_t i = 0; i < count; i++)
                ratios[i] = before.empty() ? gains[i] : before[i] + share * (gains[i] - before[i]);
        before = gains, before_ct = item_ct;
    }
    return ratios;
}

struct Shape {
    uint32_t columns, rows, width, height;
};

double read_alsc(std::string_view text, double ct, Shape shape, lensprof_profile &profile) {
    const std::string plain = without_last_commas(text);
    const JsonText json(plain);
    const JsonValue alsc = find_alsc(json.root());
    const JsonValue table = luminance_of(json.root(), alsc);
    const std::vector<double> luminance = gains_of(table);
    const size_t count = luminance.size();
    find_shape(table, count, shape.columns, shape.rows);
    if (ct == LENSPROF_UNKNOWN)
        ct = alsc["default_ct"] ? alsc["default_ct"].number_within(1.0, 1e6) : kAlscTemperatureK;
    const std::vector<double> red = ratios_at(alsc["calibrations_Cr"], ct, count),
                              blue = ratios_at(alsc["calibrations_Cb"], ct, count);
    const bool grey = !alsc["calibrations_Cr"] && !alsc["calibrations_Cb"];
    profile.key.color_temperature_k = grey ? LENSPROF_UNKNOWN : ct;
    std::vector<float> gains;
    for (size_t i = 0; i < count; i++) {
        if (!grey) gains.push_back(static_cast<float>(luminance[i] * red[i]));
        gains.push_back(static_cast<float>(luminance[i]));
        if (!grey) gains.push_back(static_cast<float>(luminance[i] * blue[i]));
    }
    return fit_values({shape.columns, shape.rows, grey ? 1u : 3u, true, {0, 1, 2}}, gains.data(), shape.width,
                      shape.height, profile);
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_alsc_read(const void *data, size_t size, double ct, uint32_t columns, uint32_t rows, uint32_t width,
                             uint32_t height, lensprof_profile *profile, double *worst, lensprof_error *error) {
    if ((!data && size) || !profile || !(ct == LENSPROF_UNKNOWN || (ct > 0.0 && ct <= 1e6))) {
        set_error(error,
                  "lensprof_import: give a buffer, a profile and a colour temperature of up to 1000000 K or unknown");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        double error_found = 0.0;
        change_profile(profile, [&](lensprof_profile &target) {
            error_found = read_alsc(view_of(data, size), ct, {columns, rows, width, height}, target);
        });
        if (worst) *worst = error_found;
    });
}
