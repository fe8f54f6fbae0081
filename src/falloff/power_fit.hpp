// Least squares of a sum of powers of r^2 to a sampled curve: k1..k3 of a falloff, alone or with a scale or more terms.
//
//     minimise over c   sum_i w_i (v_i - sum_n c_n t_i^p_n)^2,        t = r^2
//
// With a row a_i = (t_i^p_0, t_i^p_1, ...) the minimum solves the normal equations  A c = b,
//     A = sum_i w_i a_i a_i',   b = sum_i w_i v_i a_i.
// Their condition is the square of that of the rows, which costs up to 1e-10 of c for five powers. Each refinement
// solves them once more, for the rest v_i - a_i c that the rows themselves leave (corrected semi-normal equations,
// Bjorck 1987): one makes c as exact as an orthogonal factorisation of the rows would, without holding them.
// Samples at fewer radii than there are powers leave A singular: then a solution with as many terms as A has rank is
// taken, where a Cholesky factor would divide by rounding errors.
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace lensprof {

// One sample of the curve: any unit and scale; weight > 0 is the inverse of a variance.
struct PowerSample {
    double r2, value, weight;
};

// Most: bound of the number of powers, which keeps everything off the heap; Dynamic: none.
template <int Most = Eigen::Dynamic>
using PowerTerms = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, Most, 1>;

// c for the powers p[count], count >= 1, of the samples sample_at(0), ..., sample_at(samples - 1).
template <int Most = Eigen::Dynamic, class SampleAt>
PowerTerms<Most> fit_powers(const int *power, int count, int samples, int refinements, SampleAt sample_at) {
    using Vector = PowerTerms<Most>;
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, Most, Most>;
    Matrix normal = Matrix::Zero(count, count);
    Vector terms = Vector::Zero(count), right(count), row(count);
    Eigen::LDLT<Matrix> factor;
    Eigen::ColPivHouseholderQR<Matrix> of_rank;
    bool is_singular = false;
    for (int round = 0; round <= refinements; round++) {
        right.setZero();
        for (int i = 0; i < samples; i++) {
            const PowerSample s = sample_at(i);
            for (int n = 0; n < count; n++) row[n] = std::pow(s.r2, power[n]);
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
