#include "fit/trial/exposures.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "fit/trial/robust.hpp"

namespace lensprof {
namespace {

constexpr double kTolerance = 1e-20;  // of the squared residual

// Weighted differences of all pairs of images as one least squares problem.
class Links {
public:
    explicit Links(uint32_t images) : right_(images), diagonal_(images) {}

    void add(const IrradianceDifference &d, double weight) {
        double &link_weight = weights_[{d.image[0], d.image[1]}];
        link_weight += weight;
        for (int side = 0; side < 2; side++) {
            diagonal_[d.image[side]] += weight;
            right_[d.image[side]] += (side ? -weight : weight) * d.log_ratio;
        }
    }

    // Conjugate gradients from zero, which leave the constant of each connected group at zero.
    std::vector<double> solve() const {
        const size_t n = right_.size();
        std::vector<double> x(n), remainder = right_, step = scaled(remainder), image(n);
        double norm = product(remainder, step);
        const double limit = kTolerance * norm;
        for (size_t round = 0; round < 2 * n + 20 && norm > limit && norm > 0.0; round++) {
            apply(step, image);
            const double along = product(step, image);
            if (!(along > 0.0)) break;
            const double length = norm / along;
            for (size_t i = 0; i < n; i++) x[i] += length * step[i], remainder[i] -= length * image[i];
            const std::vector<double> next = scaled(remainder);
            const double next_norm = product(remainder, next);
            for (size_t i = 0; i < n; i++) step[i] = next[i] + next_norm / norm * step[i];
            norm = next_norm;
        }
        return x;
    }

private:
    std::vector<double> scaled(const std::vector<double> &values) const {
        std::vector<double> all(values.size());
        for (size_t i = 0; i < values.size(); i++) all[i] = diagonal_[i] > 0.0 ? values[i] / diagonal_[i] : 0.0;
        return all;
    }
    void apply(const std::vector<double> &x, std::vector<double> &image) const {
        for (size_t i = 0; i < x.size(); i++) image[i] = diagonal_[i] * x[i];
        for (const auto &[ends, weight] : weights_) {
            image[ends.first] -= weight * x[ends.second];
            image[ends.second] -= weight * x[ends.first];
        }
    }
    static double product(const std::vector<double> &a, const std::vector<double> &b) {
        double sum = 0.0;
        for (size_t i = 0; i < a.size(); i++) sum += a[i] * b[i];
        return sum;
    }

    std::map<std::pair<uint32_t, uint32_t>, double> weights_;
    std::vector<double> right_, diagonal_;
};

// The residual of each difference, levels; 0 without information.
std::vector<double> residual_levels(const std::vector<IrradianceDifference> &differences,
                                    const std::vector<double> &x) {
    std::vector<double> residuals;
    for (const IrradianceDifference &d : differences)
        residuals.push_back(d.sigma > 0.0 ? std::fabs(d.log_ratio - x[d.image[0]] + x[d.image[1]]) / d.sigma : 0.0);
    return residuals;
}

}  // namespace

std::vector<double> log_exposures(const std::vector<IrradianceDifference> &differences, uint32_t images) {
    std::vector<double> x(images);
    if (differences.empty()) return x;
    solve_robustly(differences.size(), [&](const std::vector<double> &residuals, double, double end) {
        Links links(images);
        for (size_t p = 0; p < differences.size(); p++) {
            const double sigma = differences[p].sigma;
            if (sigma > 0.0) links.add(differences[p], robust_weight(residuals[p], end) / (sigma * sigma));
        }
        x = links.solve();
        return residual_levels(differences, x);
    });
    return x;
}

}  // namespace lensprof
