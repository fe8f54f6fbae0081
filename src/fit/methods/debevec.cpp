#include "fit/methods/debevec.hpp"

#include <cmath>

#include "falloff/dense.hpp"
#include "fit/base/levels.hpp"
#include "fit/base/parallel.hpp"
#include "fit/problem/residual.hpp"
#include "fit/solver/heldout.hpp"
#include "fit/solver/start.hpp"
#include "fit/verdict/finish.hpp"
#include "fit/verdict/quality.hpp"
#include "fit/verdict/reason.hpp"

namespace lensprof {
namespace {

constexpr int kGaugeLevel = 128;      // G is 0 there (section 2.1)
constexpr double kLambda = 10.0;      // weight of the smoothness, at a prior weight of 1,
constexpr double kTheirRows = 300.0;  // relative to as many equations as in the paper; more equations increase lambda
constexpr double kSmallestPrior = 1e-6;  // without smoothness, levels without pairs would be undetermined
constexpr double kRidge =
    1e-9;  // relative to the equations: holds unknowns that neither pairs nor smoothness determine
constexpr double kFirstNoise = 1.0 / 255.0;

using LogInverse = std::array<double, kLevels>;

// Column of an element of G; -1 if fixed at 0.
int column_of(int element) { return element + 1 == kGaugeLevel ? -1 : element - (element + 1 > kGaugeLevel); }

// The hat function (eq. 4), plus one, so that the levels at the ends have some weight.
double hat(double level) { return std::min(level, 255.0 - level) + 1.0; }

// One equation  G(B1) - G(B2) = ln t, t = s1/s2,  of a pair and channel. Eliminating the radiance L of the pair from
// the two terms w^2 (G(B) - ln L - ln s)^2 of eq. 3 leaves the weight w1^2 w2^2 / (w1^2 + w2^2). False for
// values below level 1, which have no unknown, and for white values, which carry no information.
bool add_equation(double b1, double b2, double log_ratio, NormalRows &rows) {
    if (std::min(b1, b2) * 255.0 < 1.0 || std::max(b1, b2) >= 1.0) return false;
    const Place place1 = place_of(b1), place2 = place_of(b2);
    const int column[4] = {column_of(place1.low), column_of(place1.low + 1), column_of(place2.low),
                           column_of(place2.low + 1)};
    const double coefficient[4] = {1.0 - place1.share, place1.share, place2.share - 1.0, -place2.share};
    double w1 = std::pow(hat(255.0 * b1), 2), w2 = std::pow(hat(255.0 * b2), 2);
    rows.add(column, coefficient, 4, log_ratio, w1 * w2 / (w1 + w2));
    return true;
}

// Adds the equations of all pairs and channels and returns their number.
size_t add_pairs(const Problem &problem, const Estimate &given, NormalRows &rows) {
    size_t count = 0;
    for (const Edge &edge : problem.edges) {
        const auto ratios = exposure_ratios(problem, given, edge);
        for (size_t p = edge.first; p < edge.last; p++) {
            const lensprof_pair &pair = problem.pairs[p];
            double fall = falloff(problem, given, 0, pair).ratio;
            for (int c = 0; c < problem.channels; c++)
                count += add_equation(pair.value[0][c], pair.value[1][c],
                                      std::log(fall * ratios[static_cast<size_t>(c)]), rows);
        }
    }
    return count;
}

// lambda (w(z) G''(z))^2 (eq. 3).
void add_smoothness(double lambda, NormalRows &rows) {
    for (int k = 1; k + 1 < kLevels; k++) {
        const int column[3] = {column_of(k - 1), column_of(k), column_of(k + 1)};
        const double bent[3] = {1.0, -2.0, 1.0};
        rows.add(column, bent, 3, 0.0, lambda * std::pow(hat(k + 1), 2));
    }
}

// One curve for all channels (the paper: one per channel), by plain least squares: it may fall.
LogInverse log_inverse_of(const Problem &problem, const Estimate &given, double prior_weight) {
    NormalRows rows(kLevels - 1);
    auto count = static_cast<double>(add_pairs(problem, given, rows));
    add_smoothness(kLambda * std::max(prior_weight, kSmallestPrior) * std::max(count, 1.0) / kTheirRows, rows);
    rows.normal.diagonal().array() += kRidge * std::max(count, 1.0);
    const Eigen::VectorXd found = solve_symmetric(rows.normal, rows.right);
    LogInverse g{};
    for (int k = 0; k < kLevels; k++)
        if (column_of(k) >= 0) g[static_cast<size_t>(k)] = found[column_of(k)];
    return g;
}

// Sets f = G^-1, made monotone where G falls. Up to level 1 it is linear.
void set_log_inverse(const LogInverse &g, Estimate &estimate) {
    const double highest = *std::max_element(g.begin(), g.end());
    const auto f = response_samples(
        [&](double b) { return std::min(255.0 * b, 1.0) * std::exp(value_at(g, place_of(b)) - highest); });
    set_table(estimate, f.data());
}

// Whether G rises over the middle half of the grey values: it falls if the exposures are in reverse order.
bool rises(const LogInverse &g) { return g[191] > g[63]; }

class Fit {
public:
    Fit(const lensprof_fit_options &options, std::vector<lensprof_fit_image> images, const lensprof_pair *pairs,
        uint32_t pair_count)
        : options_(options),
          images_(std::move(images)),
          pairs_(pairs),
          split_(split_pairs(pair_count, static_cast<uint32_t>(images_.size()))),
          all_(problem(split_.all)) {}

    void run(lensprof_exposure *exposures, FitResult &result) const;

private:
    Problem problem(const std::vector<uint32_t> &keep) const {
        return make_problem(options_, images_.data(), static_cast<uint32_t>(images_.size()), pairs_, keep);
    }
    void advance(double done) const {
        if (options_.progress && options_.progress(done, options_.progress_user) != 0) throw Cancelled();
    }
    Estimate fit(const Problem &problem, bool &is_rising) const {
        Estimate estimate = start_estimates(problem, options_, 0).front();  // everything except the response is given
        const LogInverse g = log_inverse_of(problem, estimate, options_.prior_weight);
        is_rising = rises(g);
        set_log_inverse(g, estimate);
        return estimate;
    }
    void judge_exposures(const Estimate &estimate, bool is_rising, FitResult &r) const;

    const lensprof_fit_options &options_;
    const std::vector<lensprof_fit_image> images_;
    const lensprof_pair *pairs_;
    const Split split_;
    const Problem all_;
};

// Detects exposures that make the equations of the response uninformative or wrong.
void Fit::judge_exposures(const Estimate &estimate, bool is_rising, FitResult &r) const {
    const double usual = exposure_spread(all_, estimate);
    if (usual >= kSmallestSpread && is_rising) return;
    if (usual < kSmallestSpread)
        refuse(r, {LENSPROF_REASON_KNOWN_ALIKE, {usual}});
    else
        refuse(r, {LENSPROF_REASON_KNOWN_REVERSED, {}});
}

void Fit::run(lensprof_exposure *exposures, FitResult &result) const {
    const bool has_heldout = split_.has_heldout();
    bool is_rising;
    advance(0.0);
    const Estimate train = fit(has_heldout ? problem(split_.train) : all_, is_rising);
    advance(0.4);
    const Estimate estimate = fit(all_, is_rising);
    advance(0.8);

    Gauge gauge(options_, all_);
    Prior prior;
    gauge.renew(all_, estimate, prior);
    finish(
        {all_, gauge, estimate, has_heldout ? problem(split_.heldout) : all_, train, has_heldout,
         estimate_noise(all_, estimate, kFirstNoise), Covariance(), 1, true},
        [&](FitResult &r) { judge_exposures(estimate, is_rising, r); }, exposures, result);
}

}  // namespace

double known_exposure(const lensprof_fit_image *images, uint32_t reference, uint32_t i) {
    const double zero = images[images[reference].ev_of].known_ev;
    return given_exposure(images, reference).ev + images[images[i].ev_of].known_ev - zero;
}

void fit_debevec(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures, FitResult &result) {
    std::vector<lensprof_fit_image> held(images, images + image_count);
    for (uint32_t i = 0; i < image_count; i++) {
        held[i].exposure.ev = images[images[i].ev_of].free & LENSPROF_FREE_EV
                                  ? known_exposure(images, options.reference, i)
                                  : given_exposure(images, i).ev;  // held by the caller
        held[i].free = 0;
    }
    Fit(options, std::move(held), pairs, pair_count).run(exposures, result);
}

}  // namespace lensprof
