#include "fit/problem/residual.hpp"

#include <algorithm>

#include "core/response.h"
#include "fit/base/parallel.hpp"

namespace lensprof {

double response_at(const Estimate &estimate, double x, double *slope) {
    return estimate.modes < 0 ? lensprof_response_eval(&estimate.fixed, x, slope)
                              : lp_curve_eval(estimate.curve.table.data(), x, slope);
}

double irradiance_of(const Estimate &estimate, double b, double *slope) {
    return estimate.modes < 0 ? lensprof_response_invert(&estimate.fixed, b, slope) : estimate.curve.invert(b, slope);
}

Attenuation attenuation(const Problem &problem, const Estimate &estimate, size_t curve, uint32_t image,
                        const double xy[2]) {
    Attenuation result{};
    const auto &frame = problem.images[image];
    const lensprof_vignetting &vignetting = estimate.vignetting[static_cast<size_t>(problem.setting_of[image])][curve];
    double gradient[2], slope;
    double r2 = lensprof_vignetting_r2(&vignetting, frame.width, frame.height, xy[0], xy[1], gradient);
    result.m = std::max(lensprof_vignetting_eval(&vignetting, r2, &slope), 1e-6);
    double inverse = 1.0 / result.m, power = r2 * inverse;
    for (int n = 0; n < 3; n++, power *= r2) result.by_k[n] = power;
    for (int d = 0; d < 2; d++) result.by_center[d] = slope * gradient[d] * inverse;
    return result;
}

Falloff falloff(const Problem &problem, const Estimate &estimate, size_t curve, const lensprof_pair &pair) {
    Falloff result{};
    for (int side = 0; side < 2; side++)
        result.end[side] = attenuation(problem, estimate, curve, pair.image[side], pair.xy[side]);
    result.ratio = result.end[0].m / result.end[1].m;
    return result;
}

Transfer transfer(const Estimate &estimate, double value1, double value2, double ratio) {
    Transfer t;
    double inverse_slope[2], value[2] = {value1, value2}, factor[2] = {ratio, 1.0 / ratio};
    for (int side = 0; side < 2; side++) t.x[side] = irradiance_of(estimate, value[side], &inverse_slope[side]);
    for (int side = 0; side < 2; side++) {
        int other = 1 - side;
        double slope;
        t.y[side] = t.x[other] * factor[side];
        t.residual[side] = value[side] - response_at(estimate, t.y[side], &slope);
        t.by_delta[side] = (side == 0 ? slope : -slope) * t.y[side];
        t.by_value[side] = slope * factor[side] * inverse_slope[other];
    }
    return t;
}

void evaluate_pair(const Problem &problem, const Estimate &estimate, const lensprof_pair &pair,
                   const double exposure_ratio[3], PairTransfer &result) {
    for (size_t c = 0; c < static_cast<size_t>(problem.vignettings); c++)
        result.fall[c] = falloff(problem, estimate, c, pair);
    for (int c = 0; c < problem.channels; c++) {
        double m = result.fall[problem.vignettings == 3 ? c : 0].ratio;
        result.channel[c] = transfer(estimate, pair.value[0][c], pair.value[1][c], m * exposure_ratio[c]);
    }
}

void for_each_chunk(const Problem &problem, const std::function<void(uint32_t)> &work) {
    for_each_parallel(static_cast<uint32_t>(problem.chunks.size()), problem.threads, work, [] { return false; });
}

ModeTable::ModeTable(int modes) : modes_(modes) {
    // One row more than there are samples: interpolation at 1 reads it, and must find the last sample.
    rows_.resize(static_cast<size_t>(LENSPROF_RESPONSE_SAMPLES + 1) * static_cast<size_t>(modes));
    for (int j = 0; j <= LENSPROF_RESPONSE_SAMPLES; j++)
        for (int l = 0; l < modes; l++)
            rows_[static_cast<size_t>(j * modes + l)] =
                lensprof_emor_table(static_cast<uint32_t>(l) + 1)[std::min(j, LP_CURVE_LAST)];
}

const double *ModeTable::at(double x, double &fraction) const {
    double position = std::clamp(x, 0.0, 1.0) * LP_CURVE_LAST;
    auto j = static_cast<int>(position);
    fraction = position - j;
    return rows_.data() + static_cast<size_t>(j) * static_cast<size_t>(modes_);
}

void ModeTable::response_by_emor(double x, double scale, double *by_emor) const {
    double fraction;
    const double *h = at(x, fraction);
    for (int l = 0; l < modes_; l++) by_emor[l] = scale * ((1.0 - fraction) * h[l] + fraction * h[l + modes_]);
}

void ModeTable::transfer_by_emor(const Transfer &t, int side, double scale, double *by_emor) const {
    // prediction = f(y), y = factor * g(other):  h(y) + f'(y) * factor * dg/dalpha,  dg/dalpha = -h(x) / f'(x)
    double fy, fx, tau = t.by_value[side];
    const double *hy = at(t.y[side], fy), *hx = at(t.x[1 - side], fx);
    double y0 = scale * (1.0 - fy), y1 = scale * fy, x0 = scale * tau * (1.0 - fx), x1 = scale * tau * fx;
    for (int l = 0; l < modes_; l++) by_emor[l] = y0 * hy[l] + y1 * hy[l + modes_] - x0 * hx[l] - x1 * hx[l + modes_];
}

}  // namespace lensprof
