// The symmetric grey value transfer error of one pair and its exact derivatives.
//
//   forward   B1 - f( g(B2) t ),    backward   B2 - f( g(B1) / t ),
//   t = s1/s2 = exp(delta),  delta = ln M(p1) + a1 - ln M(p2) - a2              (d'Angelo eq. 5, 8 and section 3)
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "fit/problem/problem.hpp"

namespace lensprof {

// Both residuals of one channel: [0] forward, [1] backward.
struct Transfer {
    double residual[2];
    double by_delta[2];  // d prediction / d delta
    double by_value[2];  // d prediction / d the other grey value: tau'
    double x[2], y[2];   // irradiances of the two values, and arguments of f in the two predictions
};

// f and g of an estimate; slopes as lensprof_response_eval and _invert.
double response_at(const Estimate &estimate, double x, double *slope);
double irradiance_of(const Estimate &estimate, double b, double *slope);

// M at a place of an image, and the derivatives of its logarithm: by_k[n], by_center[0..1].
struct Attenuation {
    double m;
    double by_k[3];
    double by_center[2];
};
Attenuation attenuation(const Problem &problem, const Estimate &estimate, size_t curve, uint32_t image,
                        const double xy[2]);

// M(p1) / M(p2) of a pair, and its parts.
struct Falloff {
    double ratio;
    Attenuation end[2];
};

// ratio: s1/s2.
Transfer transfer(const Estimate &estimate, double value1, double value2, double ratio);

// All channels of a pair, at an estimate. exposure_ratio[c]: e1 w1 / (e2 w2).
struct PairTransfer {
    std::array<Falloff, 3> fall;  // only the first if one curve serves all channels
    std::array<Transfer, 3> channel;
};
void evaluate_pair(const Problem &problem, const Estimate &estimate, const lensprof_pair &pair,
                   const double exposure_ratio[3], PairTransfer &result);

// M1/M2 by one of the falloff curves of each image's setting.
Falloff falloff(const Problem &problem, const Estimate &estimate, size_t curve, const lensprof_pair &pair);

inline std::array<double, 3> exposure_ratios(const Problem &problem, const Estimate &estimate, const Edge &edge) {
    std::array<double, 3> ratio{1.0, 1.0, 1.0};
    const auto &a1 = estimate.log_exposure[edge.image[0]], &a2 = estimate.log_exposure[edge.image[1]];
    for (int c = 0; c < problem.channels; c++) ratio[c] = std::exp(a1[c] - a2[c]);
    return ratio;
}

// Calls visit(number of the pair, its transfer) for every pair of a chunk, in order.
template <class Visit>
void for_each_transfer(const Problem &problem, const Chunk &chunk, const Estimate &estimate, Visit visit) {
    PairTransfer transfer;
    for (size_t p = chunk.first, e = chunk.first_edge; p < chunk.last; e++) {
        auto ratio = exposure_ratios(problem, estimate, problem.edges[e]);
        for (size_t last = std::min(chunk.last, problem.edges[e].last); p < last; p++) {
            evaluate_pair(problem, estimate, problem.pairs[p], ratio.data(), transfer);
            visit(p, transfer);
        }
    }
}

// The same for all pairs, in order.
template <class Visit>
void for_each_transfer(const Problem &problem, const Estimate &estimate, Visit visit) {
    for (const Chunk &chunk : problem.chunks) for_each_transfer(problem, chunk, estimate, visit);
}

// Calls work(number of a chunk) for every chunk, on the problem's threads.
void for_each_chunk(const Problem &problem, const std::function<void(uint32_t)> &work);

// The EMoR modes in use, interleaved: all modes at one irradiance are adjacent.
class ModeTable {
public:
    explicit ModeTable(int modes);
    int modes() const { return modes_; }

    // h_l(x) of all modes, times `scale`.
    void response_by_emor(double x, double scale, double *by_emor) const;

    // d prediction[side] / d emor[l] for all modes, times `scale`.
    void transfer_by_emor(const Transfer &t, int side, double scale, double *by_emor) const;

private:
    const double *at(double x, double &fraction) const;

    int modes_;
    std::vector<double> rows_;  // 1024 + 1 rows of `modes`
};

}  // namespace lensprof
