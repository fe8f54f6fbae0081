#include "photo/calibration/pedestal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr double darkest_light = 4.0 / 255.0, brightest = 250.0 / 255.0;  // above black; of samples
constexpr size_t least_pairs = 150, most_pairs = 20000, most_images = 400;
constexpr int falloff_terms = 5;  // k1, k2, k3, and the centre to first order

// Of 80 simulated sets without a pedestal, none exceeds 4.4 standard errors or 0.33 %.
constexpr double clear_sigmas = 8.0, clear_level = 0.004;

struct PairTerms {
    uint32_t image[2];
    double value[2];
    std::array<double, falloff_terms> falloff;  // differences of the two ends
};

std::array<double, falloff_terms> falloff_at(const lensprof_pair &pair, int side, const lensprof_fit_image &image) {
    const double half = 0.5 * std::hypot(image.width, image.height);
    const double x = (pair.xy[side][0] - 0.5 * (image.width - 1.0)) / half,
                 y = (pair.xy[side][1] - 0.5 * (image.height - 1.0)) / half, r2 = x * x + y * y;
    return {r2, r2 * r2, r2 * r2 * r2, x, y};
}

std::vector<PairTerms> terms_of(const std::vector<lensprof_pair> &pairs,
                                const std::vector<lensprof_fit_image> &images) {
    std::vector<PairTerms> all;
    const size_t step = pairs.size() / most_pairs + 1;
    for (size_t p = 0; p < pairs.size(); p += step) {
        const lensprof_pair &pair = pairs[p];
        PairTerms terms{{pair.image[0], pair.image[1]}, {pair.value[0][1], pair.value[1][1]}, {}};
        const auto first = falloff_at(pair, 0, images[pair.image[0]]),
                   second = falloff_at(pair, 1, images[pair.image[1]]);
        for (size_t t = 0; t < first.size(); t++) terms.falloff[t] = first[t] - second[t];
        all.push_back(terms);
    }
    return all;
}

// The equation of a pair, linear in exposures, falloff and the change of the black level (the last unknown).
struct Equation {
    static constexpr int terms = 2 + falloff_terms + 1;
    std::array<Eigen::Index, terms> unknown;
    std::array<double, terms> factor;
    double log_ratio, noise;  // noise: of log_ratio, for noise 1 of samples
    uint64_t link;
    double weight = 1.0, residual = 0.0;  // residual: of samples
};

// Robust least squares at a black level.
class BlackFit {
public:
    // Of pairs that are light above `least`.
    BlackFit(const std::vector<PairTerms> &all, size_t images, double black, double least) {
        for (const PairTerms &pair : all) {
            const double a = pair.value[0] - black, b = pair.value[1] - black;
            const auto [dark, bright] = std::minmax(pair.value[0], pair.value[1]);
            if (!(dark > least + darkest_light && bright < brightest)) continue;
            Equation e{{}, {}, std::log(a / b), std::hypot(1.0 / a, 1.0 / b), 0};
            e.unknown[0] = pair.image[0], e.unknown[1] = pair.image[1];
            e.factor[0] = 1.0, e.factor[1] = -1.0;
            for (size_t t = 0; t < falloff_terms; t++) e.factor[2 + t] = pair.falloff[t];
            for (size_t t = 2; t < Equation::terms; t++) e.unknown[t] = static_cast<Eigen::Index>(images + t - 2);
            e.factor.back() = 1.0 / a - 1.0 / b;
            e.link = uint64_t(pair.image[0]) << 32 | pair.image[1];
            equations_.push_back(e);
        }
        size_ = static_cast<Eigen::Index>(images + falloff_terms + 1);
    }

    bool has_enough() const { return equations_.size() >= least_pairs; }

    // With a fixed black level or, `is_free`, with its change.
    void run(int rounds, bool is_free) {
        for (int round = 0; round < rounds; round++) {
            solve(is_free);
            std::vector<double> sizes;
            for (Equation &e : equations_) {
                e.residual = e.log_ratio;
                for (size_t t = 0; t < Equation::terms; t++) e.residual -= e.factor[t] * found_[e.unknown[t]];
                e.residual /= e.noise;
                sizes.push_back(std::fabs(e.residual));
            }
            noise_ = 1.4826 * quantile(sizes, 0.5) + 2e-5;  // of a normal distribution
            for (Equation &e : equations_) e.weight = std::pow(1.0 + std::pow(e.residual / (3.0 * noise_), 2), -2);
        }
    }

    double mean_residual() const {
        double sum = 0.0;
        for (const Equation &e : equations_) sum += std::fabs(e.residual);
        return sum / static_cast<double>(equations_.size());
    }

    double change() const { return found_[size_ - 1]; }

    // Standard error of the black level: links err independently of each other, pairs of a link do not.
    double sigma() const {
        const Eigen::VectorXd row = normal_.solve(Eigen::VectorXd::Unit(size_, size_ - 1));
        std::map<uint64_t, double> links;
        for (const Equation &e : equations_) {
            double influence = 0.0;
            for (size_t t = 0; t < Equation::terms; t++) influence += e.factor[t] * row[e.unknown[t]];
            links[e.link] += influence * e.weight * e.residual / e.noise;
        }
        double sum = 0.0;
        for (const auto &[link, error] : links) sum += error * error;
        const double count = static_cast<double>(links.size());
        return std::max(std::sqrt(sum * count / std::max(1.0, count - 1.0)),
                        noise_ * std::sqrt(std::fabs(row[size_ - 1])));
    }

private:
    void solve(bool is_free) {
        const size_t terms = Equation::terms - (is_free ? 0 : 1);
        Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size_, size_);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(size_);
        for (const Equation &e : equations_) {
            const double weight = e.weight / (e.noise * e.noise);
            for (size_t s = 0; s < terms; s++) {
                right[e.unknown[s]] += weight * e.factor[s] * e.log_ratio;
                for (size_t t = 0; t < terms; t++)
                    matrix(e.unknown[s], e.unknown[t]) += weight * e.factor[s] * e.factor[t];
            }
        }
        if (!is_free) matrix(size_ - 1, size_ - 1) = 1.0;
        // Exposures are relative, and a group of images may have no pairs.
        const double mean = matrix.trace() / static_cast<double>(size_);
        matrix.diagonal().head(size_ - 1).array() += 1e-9 * mean;
        normal_.compute(matrix);
        found_ = normal_.solve(right);
    }

    std::vector<Equation> equations_;
    Eigen::Index size_ = 0;
    Eigen::LDLT<Eigen::MatrixXd> normal_;
    Eigen::VectorXd found_;
    double noise_ = 0.0;
};

// The start of the iteration: robust weights take dark pairs for outliers far from the solution.
double start_of(const std::vector<PairTerms> &all, size_t images) {
    constexpr double starts[] = {0.0, 0.005, 0.01, 0.02, 0.03, 0.045, 0.06, 0.08, 0.1, 0.125, 0.15};
    double best = 0.0, least = INFINITY;
    for (const double black : starts) {
        BlackFit fit(all, images, black, black);
        if (!fit.has_enough()) break;
        fit.run(5, false);
        if (fit.mean_residual() < least) least = fit.mean_residual(), best = black;
    }
    return best;
}

}  // namespace

std::optional<Pedestal> find_pedestal(const std::vector<lensprof_pair> &pairs,
                                      const std::vector<lensprof_fit_image> &images) {
    constexpr double largest_step = 0.02, enough = 0.02;  // enough: of a standard error
    if (images.size() > most_images) return std::nullopt;
    const std::vector<PairTerms> all = terms_of(pairs, images);
    Pedestal found;
    const double start = start_of(all, images.size());
    found.level = start;
    for (int round = 0; round < 12; round++) {
        // The same pairs each time: others would change the level again.
        BlackFit fit(all, images.size(), found.level, std::max(start, found.level - 0.5 * darkest_light));
        if (!fit.has_enough()) return std::nullopt;
        fit.run(4, true);
        const double change = std::clamp(fit.change(), -largest_step, largest_step);
        found.level += change;
        if (!(found.level > 0.0)) return std::nullopt;
        found.sigma = fit.sigma();
        if (std::fabs(change) > enough * found.sigma) continue;
        const bool is_clear = found.level > clear_level && found.level > clear_sigmas * found.sigma;
        return is_clear ? std::optional(found) : std::nullopt;
    }
    return std::nullopt;
}

}  // namespace lensprof
