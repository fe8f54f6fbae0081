#include "residual.hpp"

#include <algorithm>
#include <cmath>

#include "core/response.h"

namespace lensprof {
namespace {

double eval(const Estimate &estimate, double x, double *slope) {
    return estimate.modes < 0 ? lensprof_response_eval(&estimate.fixed, x, slope)
                              : lp_curve_eval(estimate.table.data(), x, slope);
}

double invert(const Estimate &estimate, double b, double *slope) {
    return estimate.modes < 0 ? lensprof_response_invert(&estimate.fixed, b, slope)
                              : lp_curve_invert(estimate.table.data(), b, slope);
}

}  // namespace

Falloff falloff(const Problem &problem, const Estimate &estimate, const lensprof_pair &pair) {
    Falloff result{};
    double log_m[2];
    for (int side = 0; side < 2; side++) {
        const auto &image = problem.images[pair.image[side]];
        double gradient[2], slope, sign = side == 0 ? 1.0 : -1.0;
        double r2 = lensprof_vignetting_r2(&estimate.vignetting, image.width, image.height, pair.xy[side][0],
                                           pair.xy[side][1], gradient);
        double m = std::max(lensprof_vignetting_eval(&estimate.vignetting, r2, &slope), 1e-6);
        log_m[side] = std::log(m);
        double power = r2;
        for (int n = 0; n < 3; n++, power *= r2) result.by_k[n] += sign * power / m;
        for (int d = 0; d < 2; d++) result.by_center[d] += sign * slope * gradient[d] / m;
    }
    result.log_ratio = log_m[0] - log_m[1];
    return result;
}

Transfer transfer(const Estimate &estimate, double value1, double value2, double delta) {
    Transfer t;
    double inverse_slope[2], ratio = std::exp(delta), value[2] = {value1, value2};
    for (int side = 0; side < 2; side++) {
        t.x[side] = invert(estimate, value[side], &inverse_slope[side]);
        t.slope_x[side] = inverse_slope[side] > 0.0 ? 1.0 / inverse_slope[side] : 0.0;
    }
    for (int side = 0; side < 2; side++) {
        int other = 1 - side;
        double factor = side == 0 ? ratio : 1.0 / ratio;
        t.y[side] = t.x[other] * factor;
        t.residual[side] = value[side] - eval(estimate, t.y[side], &t.slope_y[side]);
        t.by_delta[side] = (side == 0 ? 1.0 : -1.0) * t.slope_y[side] * t.y[side];
        t.by_value[side] = t.slope_y[side] * factor * inverse_slope[other];
    }
    return t;
}

PairTransfer evaluate_pair(const Problem &problem, const Estimate &estimate, const lensprof_pair &pair) {
    PairTransfer result;
    result.fall = falloff(problem, estimate, pair);
    const auto &a1 = estimate.log_exposure[pair.image[0]], &a2 = estimate.log_exposure[pair.image[1]];
    for (int c = 0; c < problem.channels; c++)
        result.channel[c] =
            transfer(estimate, pair.value[0][c], pair.value[1][c], result.fall.log_ratio + a1[c] - a2[c]);
    return result;
}

void transfer_by_emor(const Estimate &estimate, const Transfer &t, int side, double *by_emor) {
    // prediction = f(y), y = factor * g(other):  h(y) + f'(y) * factor * dg/dalpha,  dg/dalpha = -h(x) / f'(x)
    double x = t.x[1 - side];
    for (int l = 0; l < estimate.modes; l++) {
        const double *mode = lensprof_emor_table(static_cast<uint32_t>(l) + 1);
        by_emor[l] = -(lp_curve_eval(mode, t.y[side], nullptr) - t.by_value[side] * lp_curve_eval(mode, x, nullptr));
    }
}

}  // namespace lensprof
