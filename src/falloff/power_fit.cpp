#include "falloff/power_fit.hpp"

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace lensprof {

namespace {

double power_of(double base, int exponent) {
    double product = 1.0;
    for (int n = 0; n < exponent; n++) product *= base;
    return product;
}

}  // namespace

PowerTerms fit_powers(const int *power, int count, int samples, int refinements,
                      PowerSample (*sample_at)(const void *context, int i), const void *context) {
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxPowers, kMaxPowers>;
    Matrix normal = Matrix::Zero(count, count);
    PowerTerms terms = PowerTerms::Zero(count), right(count), row(count);
    Eigen::LDLT<Matrix> factor;
    Eigen::ColPivHouseholderQR<Matrix> of_rank;
    bool is_singular = false;
    for (int round = 0; round <= refinements; round++) {
        right.setZero();
        for (int i = 0; i < samples; i++) {
            const PowerSample s = sample_at(context, i);
            for (int n = 0; n < count; n++) row[n] = power_of(s.r2, power[n]);
            if (round == 0) normal += s.weight * row * row.transpose();
            right += s.weight * row * (round == 0 ? s.value : s.value - row.dot(terms));
        }
        if (round == 0) {
            factor.compute(normal);
            const double smallest = factor.vectorD().cwiseAbs().minCoeff(),
                         largest = factor.vectorD().cwiseAbs().maxCoeff();
            is_singular = !(smallest > count * std::numeric_limits<double>::epsilon() * largest);
            if (is_singular) of_rank.compute(normal);
        }
        if (is_singular)
            terms += of_rank.solve(right);
        else
            terms += factor.solve(right);
    }
    return terms;
}

}  // namespace lensprof
