// Response and falloff at one light, with derivatives.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

// A grey value predicted from ln of the light, or the reverse.
struct Prediction {
    double value;   // f
    double by_log;  // df / d ln x; 0 where f is flat
    double place;   // x on the table, 0..1023
    double bend;    // second derivative by ln x
};

// f at exp(log_light).
Prediction predict(const Camera &camera, double log_light);

// ln f^-1 at a grey value; *at receives what predict() would.
double log_light_of(const Camera &camera, double value, Prediction *at);

// ln M at r^2; at least that of M = 0.001.
double log_falloff_of(const Camera &camera, double r2);

// Whether an observation with this expected grey value and variance of its noise counts. Those that noise takes beyond
// black or white are missing, so that the mean of the others is wrong near both.
bool is_inside(const State &state, double value, double noise);

// Derivatives of the grey value by the globals, at a given L e.
template <class Vector>
void by_globals(const Camera &camera, const Prediction &at, double r2, double log_falloff, Vector &derivative);

// f with these modes; the ends stay 0 and 1.
void fill_table(const Globals &globals, const Camera &camera, double *table);

// What one standard error of each mode that the fit omits adds to a grey value.
OmittedSlope omitted_by_sigma(const State &state, const Prediction &at);

// Sets the globals, and the table of the response.
void set_globals(const Globals &globals, Camera &camera);

// Whether a camera may have these globals: the response rises, and the falloff is positive.
bool is_possible(const Globals &globals, const Camera &camera);

}  // namespace online
}  // namespace lensprof

#include <cmath>

namespace lensprof {
namespace online {

template <class Vector>
void by_globals(const Camera &camera, const Prediction &at, double r2, double log_falloff, Vector &derivative) {
    using Number = typename Vector::Scalar;
    const auto j = static_cast<int>(at.place);
    const auto fraction = static_cast<float>(at.place - j);
    const float *low = camera.mode[j], *high = camera.mode[j + 1];
    for (int l = 0; l < kModes; l++) derivative[l] = static_cast<Number>(low[l] + fraction * (high[l] - low[l]));
    double power = at.by_log * std::exp(-log_falloff);
    for (int n = 0; n < 3; n++) derivative[kModes + n] = static_cast<Number>(power *= r2);
}

}  // namespace online
}  // namespace lensprof
