#include "formats/falloff/refit.hpp"

#include <cmath>

#include <Eigen/QR>

#include "formats/falloff/radius.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr int kSteps = 256;  // samples of r^2

}  // namespace

EvenRefit refit_even(const std::function<double(double)> &target, uint32_t count) {
    const double middle = target(0.0);
    Eigen::MatrixXd powers(kSteps + 1, count);
    Eigen::VectorXd rest(kSteps + 1);
    for (int i = 0; i <= kSteps; i++) {
        const double t = double(i) / kSteps, value = target(t) / middle;
        if (!std::isfinite(value))
            throw FormatFailure{LENSPROF_ERROR_NOT_FINITE, "a falloff that is not finite; correct it"};
        if (!(value > 0.0)) throw FormatFailure{LENSPROF_ERROR_VIGNETTING, "a falloff that is not above 0; correct it"};
        double power = t / value;
        for (uint32_t n = 0; n < count; n++, power *= t) powers(i, n) = power;
        rest[i] = 1.0 - 1.0 / value;
    }
    const Eigen::VectorXd terms = powers.colPivHouseholderQr().solve(rest);
    return {std::vector<double>(terms.data(), terms.data() + count), (powers * terms - rest).cwiseAbs().maxCoeff()};
}

RadialRefit refit_radial(const std::function<double(double)> &attenuation, double reach) {
    const EvenRefit refit = refit_even([&](double t) { return attenuation(t * reach * reach); }, 3);
    return {in_half_diagonals({refit.terms[0], refit.terms[1], refit.terms[2]}, reach), refit.worst};
}

}  // namespace lensprof
