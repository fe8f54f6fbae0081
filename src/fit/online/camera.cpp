#include "fit/online/camera.hpp"

#include <algorithm>

#include "core/response.h"
#include "fit/problem/curve_shape.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr double kLeastFalloff = 1e-3, kLeastLight = 1e-9;

// f with these modes; the ends stay 0 and 1.
void fill_table(const Globals &globals, const Camera &camera, double *table) {
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        table[j] = camera.first[j];
        for (int l = 0; l < camera.modes; l++) table[j] += globals[l] * static_cast<double>(camera.mode[j][l]);
    }
    table[0] = 0.0, table[LP_CURVE_LAST] = 1.0;
}

}  // namespace

Prediction predict(const Camera &camera, double log_light) {
    const double x = std::exp(std::min(log_light, 0.0));
    double slope;
    const double value = lp_curve_eval(camera.table, x, &slope);
    return {value, slope * x, x * LP_CURVE_LAST};
}

double log_light_of(const Camera &camera, double value, Prediction *at) {
    double inverse_slope;
    const double x = std::max(lp_curve_invert(camera.table, value, &inverse_slope), kLeastLight);
    *at = {value, inverse_slope > 0.0 ? x / inverse_slope : 0.0, x * LP_CURVE_LAST};
    return std::log(x);
}

double log_falloff_of(const Camera &camera, double r2) {
    const double *k = camera.globals.data() + kModes;
    const lensprof_vignetting falloff = {{k[0], k[1], k[2]}, {0.0, 0.0}};
    return std::log(std::max(lensprof_vignetting_eval(&falloff, r2, nullptr), kLeastFalloff));
}

void set_globals(const Globals &globals, Camera &camera) {
    camera.globals = globals;
    fill_table(globals, camera, camera.table);
}

bool is_possible(const Globals &globals, const Camera &camera) {
    double table[LENSPROF_RESPONSE_SAMPLES];
    fill_table(globals, camera, table);
    for (int j = 0; j < kRises; j++)
        if (!(table[j + 1] - table[j] >= 0.5 * kSmallestRise)) return false;
    return is_positive(globals.data() + kModes, camera.center);
}

}  // namespace online
}  // namespace lensprof
