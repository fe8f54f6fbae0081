#include "fit/flat/model.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {

namespace {

constexpr double kRotated = 0.5;  // radians

}  // namespace

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

double falloff_value(const FlatModel &model, const Eigen::VectorXd &u, int curve, double r2) {
    double slope, base = power_base(model.form, r2, &slope), sum = 0.0;
    for (int n = model.terms() - 1; n >= 0; n--) sum = (sum + u[model.k(curve) + n]) * base;
    return model.form == FalloffForm::logarithm ? std::exp(sum) : 1.0 + sum;
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

// What all channels share at a place in a shot.
struct FlatLight::Place {
    double r2, by_center[2], basis[kMaxLightTerms];
};

FlatLight::FlatLight(const FlatModel &model, const Eigen::VectorXd &u)
    : model_(model), u_(u), about_center_{{}, {u[model.center()], u[model.center() + 1]}} {
    for (int shot = 0; shot < model.shots; shot++)
        for (int c = 0; c < model.channels; c++)
            even_.push_back(std::exp(u[model.level(shot, c)] + (model.several ? u[model.exposure_error(shot)] : 0.0)));
}

FlatLight::Place FlatLight::place_of(int shot, double x, double y) const {
    const auto [cosine, sine] = model_.turn[static_cast<size_t>(shot)];
    Place place{};
    place.r2 = lensprof_vignetting_r2(&about_center_, model_.grid.width, model_.grid.height, x, y, place.by_center);
    const double dx = about_center_.center[0] - 0.5 * place.by_center[0],
                 dy = about_center_.center[1] - 0.5 * place.by_center[1];
    const double qx = cosine * dx - sine * dy, qy = sine * dx + cosine * dy;
    const double basis[] = {qx, qy, qx * qx - qy * qy, 2.0 * qx * qy};
    std::copy_n(basis, kMaxLightTerms, place.basis);
    return place;
}

// Exposure times radiance.
double FlatLight::without_falloff(int shot, int channel, const Place &place) const {
    const double even = even_[static_cast<size_t>(shot * model_.channels + channel)];
    if (model_.light_terms == 0) return even;
    double slope = 0.0;
    for (int j = 0; j < model_.light_terms; j++) slope += u_[model_.light(shot, channel) + j] * place.basis[j];
    return even * std::exp(slope);
}

std::array<double, 3> FlatLight::at(int shot, double x, double y) const {
    const Place place = place_of(shot, x, y);
    std::array<double, 3> falloff{}, light{};
    for (int curve = 0; curve < model_.curves; curve++)
        falloff[static_cast<size_t>(curve)] = falloff_value(model_, u_, curve, place.r2);
    for (int c = 0; c < model_.channels; c++)
        light[static_cast<size_t>(c)] =
            without_falloff(shot, c, place) * falloff[static_cast<size_t>(model_.curve_of(c))];
    return light;
}

std::array<Prediction, 3> FlatLight::with_derivatives(int shot, double x, double y) const {
    const Place place = place_of(shot, x, y);
    std::array<FalloffAt, 3> falloffs;
    for (int curve = 0; curve < model_.curves; curve++)
        falloffs[static_cast<size_t>(curve)] = falloff_at(model_, u_, curve, place.r2);
    std::array<Prediction, 3> all;
    for (int c = 0; c < model_.channels; c++) {
        Prediction &p = all[static_cast<size_t>(c)];
        const int curve = model_.curve_of(c);
        const FalloffAt &falloff = falloffs[static_cast<size_t>(curve)];
        const double light = without_falloff(shot, c, place);
        p.value = light * falloff.value;
        for (int n = 0; n < model_.terms(); n++)
            p.add(model_.k(curve) + n, light * falloff.by_term[static_cast<size_t>(n)]);
        for (int d = 0; d < 2; d++) p.add(model_.center() + d, light * falloff.slope * place.by_center[d]);
        p.add(model_.level(shot, c), p.value);
        if (model_.several) p.add(model_.exposure_error(shot), p.value);
        for (int j = 0; j < model_.light_terms; j++) p.add(model_.light(shot, c) + j, p.value * place.basis[j]);
    }
    return all;
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
