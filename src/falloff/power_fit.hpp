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

#include <Eigen/Core>

namespace lensprof {

// One sample of the curve: any unit and scale; weight > 0 is the inverse of a variance.
struct PowerSample {
    double r2, value, weight;
};

constexpr int kMaxPowers = 6;

// Bounded, which keeps it off the heap.
using PowerTerms = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxPowers, 1>;

// c for the powers p[count], 1 <= count <= kMaxPowers, of the samples sample_at(of, 0), ..., sample_at(of, samples -
// 1).
PowerTerms fit_powers(const int *power, int count, int samples, int refinements,
                      PowerSample (*sample_at)(const void *context, int i), const void *context);

// The same, of samples sample_at(i).
template <class SampleAt>
PowerTerms fit_powers(const int *power, int count, int samples, int refinements, const SampleAt &sample_at) {
    const auto call = [](const void *context, int i) { return (*static_cast<const SampleAt *>(context))(i); };
    return fit_powers(power, count, samples, refinements, call, &sample_at);
}

}  // namespace lensprof
