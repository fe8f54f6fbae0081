#include "fit/flat/model.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {

constexpr double kRotated = 0.5;  // radians

size_t FlatModel::angles() const {
    std::vector<std::array<double, 2>> apart;
    for (const auto &a : turn)
        if (std::none_of(apart.begin(), apart.end(),
                         [&](const auto &b) { return a[0] * b[0] + a[1] * b[1] >= std::cos(kRotated); }))
            apart.push_back(a);
    return apart.size();
}

lensprof_vignetting falloff_of(const FlatModel &model, const Eigen::VectorXd &u, int curve) {
    lensprof_vignetting v{};
    for (int i = 0; i < 3 && model.form == FalloffForm::powers; i++) v.k[i] = u[model.k(curve) + i];
    for (int d = 0; d < 2; d++) v.center[d] = u[model.center() + d];
    return v;
}

void set_falloff(const FlatModel &model, const lensprof_vignetting &vignetting, Eigen::VectorXd &u) {
    for (int curve = 0; curve < model.curves && model.form == FalloffForm::powers; curve++)
        for (int i = 0; i < 3; i++) u[model.k(curve) + i] = vignetting.k[i];
    for (int d = 0; d < 2; d++) u[model.center() + d] = vignetting.center[d];
}

double power_base(FalloffForm form, double r2, double *slope) {
    const double part = form == FalloffForm::powers ? 1.0 : 1.0 / (1.0 + r2);
    *slope = part * part;
    return r2 * part;
}

FalloffAt falloff_at(const FlatModel &model, const Eigen::VectorXd &u, int curve, double r2) {
    const bool is_log = model.form == FalloffForm::logarithm;
    FalloffAt at{};
    double by_r2, base = power_base(model.form, r2, &by_r2), power = 1.0;
    for (size_t n = 0; n < static_cast<size_t>(model.terms()); n++) {
        const double term = u[model.k(curve) + static_cast<int>(n)];
        at.slope_by_term[n] = static_cast<double>(n + 1) * power * by_r2;
        power *= base;
        at.by_term[n] = power;
        at.slope += term * at.slope_by_term[n];
        at.value += term * power;
    }
    at.value = is_log ? std::exp(at.value) : 1.0 + at.value;
    if (!is_log) return at;
    at.slope *= at.value;
    for (size_t n = 0; n < kMaxFalloffTerms; n++) {
        at.slope_by_term[n] = at.slope_by_term[n] * at.value + at.by_term[n] * at.slope;
        at.by_term[n] *= at.value;
    }
    return at;
}

// Beyond the data, ln M continues with the value and slope q = (dM/dr^2) / M that it has at their end.
FalloffAt continued_falloff(const FlatModel &model, const Eigen::VectorXd &u, int curve, double r2) {
    if (r2 <= model.reach) return falloff_at(model, u, curve, r2);
    const FalloffAt end = falloff_at(model, u, curve, model.reach);
    const double q = std::min(end.slope / end.value, 0.0);
    const double step = q < 0.0 ? std::min(r2, model.held) - model.reach : 0.0;
    FalloffAt at{};
    at.value = end.value * std::exp(q * step);
    at.slope = r2 < model.held ? q * at.value : 0.0;
    for (size_t n = 0; n < kMaxFalloffTerms; n++)
        at.by_term[n] = at.value / end.value * (end.by_term[n] + step * (end.slope_by_term[n] - q * end.by_term[n]));
    return at;
}

Prediction predict(const FlatModel &model, const Eigen::VectorXd &u, int shot, int channel, double x, double y) {
    const CellGrid &grid = model.grid;
    const int curve = model.curve_of(channel), level = model.level(shot, channel);
    lensprof_vignetting v = falloff_of(model, u, curve);
    double by_center[2], r2 = lensprof_vignetting_r2(&v, grid.width, grid.height, x, y, by_center);
    const FalloffAt falloff = falloff_at(model, u, curve, r2);
    Prediction p;
    p.falloff = falloff.value;
    double log_light = u[level] + (model.several ? u[model.exposure_error(shot)] : 0.0);
    double half = lensprof_half_diagonal(grid.width, grid.height), cosine = model.turn[static_cast<size_t>(shot)][0];
    double dx = (x - 0.5 * (grid.width - 1.0)) / half, dy = (y - 0.5 * (grid.height - 1.0)) / half;
    double sine = model.turn[static_cast<size_t>(shot)][1], qx = cosine * dx - sine * dy, qy = sine * dx + cosine * dy;
    const double basis[kMaxLightTerms] = {qx, qy, qx * qx - qy * qy, 2.0 * qx * qy};
    for (int j = 0; j < model.light_terms; j++) log_light += u[model.light(shot, channel) + j] * basis[j];
    const double light = std::exp(log_light);
    p.value = light * p.falloff;
    for (int n = 0; n < model.terms(); n++) p.add(model.k(curve) + n, light * falloff.by_term[static_cast<size_t>(n)]);
    for (int d = 0; d < 2; d++) p.add(model.center() + d, light * falloff.slope * by_center[d]);
    p.add(level, p.value);
    if (model.several) p.add(model.exposure_error(shot), p.value);
    for (int j = 0; j < model.light_terms; j++) p.add(model.light(shot, channel) + j, p.value * basis[j]);
    return p;
}

std::array<double, 2> light_gradient(const FlatModel &model, const Eigen::VectorXd &u, int shot) {
    std::array<double, 2> scene{}, frame{};
    if (model.light_terms < 2) return frame;
    for (int c = 0; c < model.channels; c++)
        for (int d = 0; d < 2; d++) scene[static_cast<size_t>(d)] += u[model.light(shot, c) + d] / model.channels;
    const auto [cosine, sine] = model.turn[static_cast<size_t>(shot)];
    frame[0] = cosine * scene[0] + sine * scene[1];
    frame[1] = -sine * scene[0] + cosine * scene[1];
    return frame;
}

}  // namespace lensprof
