#include "fit/online/camera.hpp"

#include <algorithm>

#include "core/response.h"
#include "fit/problem/curve_shape.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr double kLeastFalloff = 1e-3, kLeastLight = 1e-9;
constexpr double kMargin = 3.0;      // standard errors of the noise
constexpr double kMostMargin = 0.1;  // of the range from black to white; noise is measured by what counts
constexpr double kReach = 1.15;      // from the light to those of the difference that gives its second derivative

double by_log_at(const double *table, double x) {
    double slope;
    lp_curve_eval(table, std::min(x, 1.0 - 1e-9), &slope);
    return slope * x;
}

// Differences over a range, because f is piecewise linear.
void fill_bend(Camera &camera) {
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        const double x = std::max(j, 1) / static_cast<double>(LP_CURVE_LAST);
        const double high = std::min(x * kReach, 1.0), low = x / kReach;
        camera.bend[j] =
            static_cast<float>((by_log_at(camera.table, high) - by_log_at(camera.table, low)) / std::log(high / low));
    }
}

}  // namespace

void fill_table(const Globals &globals, const Camera &camera, double *table) {
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) {
        table[j] = camera.first[j];
        for (int l = 0; l < camera.modes; l++) table[j] += globals[l] * static_cast<double>(camera.mode[j][l]);
    }
    table[0] = 0.0, table[LP_CURVE_LAST] = 1.0;
}

Prediction predict(const Camera &camera, double log_light) {
    const double x = std::exp(std::min(log_light, 0.0));
    double slope;
    const double value = lp_curve_eval(camera.table, x, &slope);
    const double place = x * LP_CURVE_LAST;
    return {value, slope * x, place, static_cast<double>(camera.bend[static_cast<int>(place)])};
}

double log_light_of(const Camera &camera, double value, Prediction *at) {
    double inverse_slope;
    const double x = std::max(lp_curve_invert(camera.table, value, &inverse_slope), kLeastLight);
    const double place = x * LP_CURVE_LAST;
    *at = {value, inverse_slope > 0.0 ? x / inverse_slope : 0.0, place,
           static_cast<double>(camera.bend[static_cast<int>(place)])};
    return std::log(x);
}

OmittedSlope omitted_by_sigma(const State &state, const Prediction &at) {
    OmittedSlope change = OmittedSlope::Zero();
    if (!state.camera.modes) return change;
    const auto j = static_cast<int>(at.place), next = std::min(j + 1, LP_CURVE_LAST);
    for (int m = 0; m < kOmitted; m++) {
        const double *h = lensprof_emor_table(static_cast<uint32_t>(state.camera.modes + m + 1));
        change[m] = state.omitted_sigma[m] * (h[j] + (at.place - j) * (h[next] - h[j]));
    }
    return change;
}

bool is_inside(const State &state, double value, double noise) {
    const double margin = std::min(kMargin * std::sqrt(noise), kMostMargin * (state.white - state.black));
    return value > state.black + margin && value < state.white - margin;
}

double log_falloff_of(const Camera &camera, double r2) {
    const double *k = camera.globals.data() + kModes;
    const lensprof_vignetting falloff = {{k[0], k[1], k[2]}, {0.0, 0.0}};
    return std::log(std::max(lensprof_vignetting_eval(&falloff, r2, nullptr), kLeastFalloff));
}

void set_globals(const Globals &globals, Camera &camera) {
    camera.globals = globals;
    fill_table(globals, camera, camera.table);
    fill_bend(camera);
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
