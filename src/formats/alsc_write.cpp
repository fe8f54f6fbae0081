// A falloff to lens shading tables of libcamera's Raspberry Pi tuning files.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "formats/each_format.h"

#include "formats/alsc.hpp"
#include "formats/falloff/map.hpp"
#include "formats/text/json_text.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMaxSide = 256;
constexpr double kSigma = 0.005;  // what the tuning tool writes for a single colour temperature

struct Shape {
    uint32_t columns, rows, width, height;
};

// Gains to 3 decimals, a line a row.
void write_table(JsonWriter &json, const Shape &shape, const std::function<double(size_t)> &gain) {
    json.open('[');
    for (size_t i = 0; i < size_t(shape.columns) * shape.rows; i++) {
        if (i % shape.columns == 0) json.line();
        json.number(std::round(1000.0 * gain(i)) / 1000.0);
    }
    json.close(']');
}

void write_calibration(JsonWriter &json, const char *name, double ct, const Shape &shape,
                       const std::function<double(size_t)> &gain) {
    json.line();
    json.name(name);
    json.open('[');
    json.open('{');
    json.name("ct");
    json.integer(std::llround(ct));
    json.name("table");
    write_table(json, shape, gain);
    json.close('}');
    json.close(']');
}

void write_setting(JsonWriter &json, const char *name, double value) {
    json.name(name);
    json.number(value);
}

// Ratios to green and green alone, of attenuations [channel][value].
void write_tables(JsonWriter &json, const std::vector<double> &attenuation, double ct, const Shape &shape) {
    const size_t count = size_t(shape.columns) * shape.rows;
    const double *red = attenuation.data(), *green = red + count, *blue = green + count;
    const double brightest = *std::max_element(green, green + count);
    write_calibration(json, "calibrations_Cr", ct, shape, [&](size_t i) { return green[i] / red[i]; });
    write_calibration(json, "calibrations_Cb", ct, shape, [&](size_t i) { return green[i] / blue[i]; });
    json.line();
    json.name("luminance_lut");
    write_table(json, shape, [&](size_t i) { return brightest / green[i]; });
}

std::string alsc_text(const lensprof_profile &profile, double ct, const Shape &shape) {
    check_profile(profile);
    check_frame(shape.width, shape.height);
    if (shape.columns < 2 || shape.rows < 2 || shape.columns > kMaxSide || shape.rows > kMaxSide)
        throw FormatFailure{LENSPROF_ERROR_SIZE, "tables of " + std::to_string(shape.columns) + " x "
                                                     + std::to_string(shape.rows) + "; give 16 x 12 or 32 x 32"};
    JsonWriter json;
    json.open('{');
    json.name(kAlscName);
    json.open('{');
    json.line();
    write_setting(json, "omega", 1.3);
    json.name("n_iter");
    json.integer(100);
    write_setting(json, "luminance_strength", 1.0);
    write_tables(json, attenuations_of(profile, shape.width, shape.height, shape.columns, shape.rows, 3), ct, shape);
    json.line();
    write_setting(json, "sigma", kSigma);
    write_setting(json, "sigma_Cb", kSigma);
    json.close('}');
    json.close('}');
    return json.all();
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_alsc_write(const lensprof_profile *profile, double ct, uint32_t columns, uint32_t rows,
                              uint32_t width, uint32_t height, void *data, size_t capacity, size_t *count,
                              lensprof_error *error) {
    if (!profile || !(ct == LENSPROF_UNKNOWN || (ct >= 1.0 && ct <= 1e6)) || (!data && capacity)) {
        set_error(error,
                  "lensprof_export: give a profile, a colour temperature of 1 to 1000000 K or unknown, and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    if (ct == LENSPROF_UNKNOWN) ct = profile->key.color_temperature_k;
    if (ct == LENSPROF_UNKNOWN) ct = kAlscTemperatureK;
    return write_at_boundary(data, capacity, count, error, [&] {
        return alsc_text(*profile, std::max(ct, 1.0), {columns, rows, width, height});
    });
}
