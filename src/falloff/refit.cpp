#include "falloff/refit.hpp"

#include <algorithm>
#include <cmath>

#include "falloff/failure.hpp"
#include "falloff/power_fit.hpp"

namespace lensprof {
namespace {

constexpr int kSteps = 256;  // samples of r^2

}  // namespace

EvenRefit refit_even(const std::function<double(double)> &target, uint32_t count) {
    const double middle = target(0.0);
    std::vector<double> values;
    for (int i = 0; i <= kSteps; i++) {
        const double value = target(double(i) / kSteps) / middle;
        if (!std::isfinite(value))
            throw FalloffFailure{LENSPROF_ERROR_NOT_FINITE, "the falloff is not finite; correct it"};
        if (!(value > 0.0)) throw FalloffFailure{LENSPROF_ERROR_VIGNETTING, "the falloff is not above 0; correct it"};
        values.push_back(value);
    }
    std::vector<int> powers;
    for (uint32_t n = 1; n <= count; n++) powers.push_back(static_cast<int>(n));
    const Eigen::VectorXd terms = fit_powers(powers.data(), static_cast<int>(count), kSteps + 1, 1, [&](int i) {
        const double value = values[static_cast<size_t>(i)];
        return PowerSample{double(i) / kSteps, value - 1.0, 1.0 / (value * value)};
    });
    EvenRefit refit{std::vector<double>(terms.data(), terms.data() + count), 0.0};
    for (int i = 0; i <= kSteps; i++) {
        const double t = double(i) / kSteps;
        double polynomial = 0.0;
        for (uint32_t n = count; n-- > 0;) polynomial = (polynomial + refit.terms[n]) * t;
        refit.worst = std::max(refit.worst, std::fabs((1.0 + polynomial) / values[static_cast<size_t>(i)] - 1.0));
    }
    return refit;
}

RadialRefit refit_radial(const std::function<double(double)> &attenuation, double reach) {
    const EvenRefit refit = refit_even([&](double t) { return attenuation(t * reach * reach); }, 3);
    return {in_half_diagonals({refit.terms[0], refit.terms[1], refit.terms[2]}, reach), refit.worst};
}

std::array<double, 3> refit_samples(const std::vector<FrameSample> &samples, int count) {
    constexpr int kScaledPowers[] = {0, 1, 2, 3};
    const PowerTerms terms = fit_powers(kScaledPowers, count + 1, static_cast<int>(samples.size()), 1, [&](int i) {
        const FrameSample &at = samples[static_cast<size_t>(i)];
        return PowerSample{at.r2, at.attenuation, at.weight / (at.attenuation * at.attenuation)};
    });
    std::array<double, 3> k{};
    for (int n = 1; n <= count; n++) k[static_cast<size_t>(n - 1)] = terms[n] / terms[0];
    return k;
}

}  // namespace lensprof
