#include "overlap.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>
#include <stdexcept>

#include "monotone.hpp"
#include "normal_equations.hpp"
#include "residual.hpp"
#include "start.hpp"

namespace lensprof {
namespace {

constexpr int kStartModes = 5;       // enough to tell the starts apart
constexpr uint32_t kStartPairs = 800;
constexpr uint32_t kSmallestHeldout = 20;
constexpr double kBlack = 0.004;         // one level of 255
constexpr double kSmallestRange = 0.05;  // of grey values
constexpr double kLargestNoise = 6.0;  // levels of 255: no camera's noise, but a model that does not fit

// Every fifth pair is left out, by a hash of its number: independent of order along images, same every time.
bool is_heldout(uint32_t p) {
    uint64_t x = p + 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return (x ^ (x >> 31)) % 5 == 0;
}

struct Split {
    std::vector<uint32_t> all, train, heldout, few;
};

Split split_pairs(uint32_t count) {
    Split split;
    for (uint32_t p = 0; p < count; p++) {
        split.all.push_back(p);
        (is_heldout(p) ? split.heldout : split.train).push_back(p);
    }
    uint32_t step = std::max(1u, static_cast<uint32_t>(split.train.size()) / kStartPairs);
    for (size_t i = 0; i < split.train.size(); i += step) split.few.push_back(split.train[i]);
    return split;
}

class Fit {
public:
    Fit(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
        const lensprof_pair *pairs, uint32_t pair_count)
        : options_(options), images_(images), image_count_(image_count), pairs_(pairs), split_(split_pairs(pair_count)),
          prior_(make_prior(options.prior_weight, pair_count)) {
        control_.max_iterations = static_cast<int>(options.max_iterations);
        control_.cancelled = [this] {
            return options_.progress && options_.progress(done_, options_.progress_user) != 0;
        };
    }

    void run(lensprof_exposure *exposures, lensprof_fit_result &result);

private:
    Problem problem(const std::vector<uint32_t> &keep) const {
        return make_problem(options_, images_, image_count_, pairs_, keep);
    }
    Loss loss() const {
        Loss l;
        l.kind = options_.loss;
        l.huber = options_.huber_levels / 255.0;
        return l;
    }
    Estimate best_start(int modes);
    Outcome fit(const std::vector<uint32_t> &keep, int modes, Loss &used, Estimate &estimate);
    int choose_modes(const Estimate &start, Estimate &best);
    std::vector<double> heldout_losses(const Estimate &estimate, const Loss &loss) const;
    void describe(const Estimate &train, const Estimate &estimate, const Loss &used, lensprof_fit_result &result) const;
    void judge(const Problem &all, int modes, lensprof_fit_result &result) const;

    const lensprof_fit_options &options_;
    const lensprof_fit_image *images_;
    uint32_t image_count_;
    const lensprof_pair *pairs_;
    Split split_;
    Prior prior_;
    Control control_;
    double done_ = 0.0;
};

// Short fits from every start at one fixed noise level, so that their costs compare; the best one.
Estimate Fit::best_start(int modes) {
    Problem few = problem(split_.few.empty() ? split_.all : split_.few);
    Control brief = control_;
    brief.max_iterations = std::min(control_.max_iterations, 15);
    Estimate best;
    double lowest = 0.0;
    bool first = true;
    for (Estimate &start : start_estimates(few, options_, modes)) {
        Loss used = loss();
        used.noise = 3.0 / 255.0;
        Outcome outcome = solve(few, prior_, used, false, brief, start);
        if (first || outcome.cost < lowest) {
            best = start;
            lowest = outcome.cost;
            first = false;
        }
    }
    return best;
}

Outcome Fit::fit(const std::vector<uint32_t> &keep, int modes, Loss &used, Estimate &estimate) {
    if (estimate.modes >= 0 && modes < estimate.modes)
        set_response(estimate, project_curve(estimate.table.data(), modes).data(), modes);
    else if (estimate.modes >= 0)
        set_response(estimate, estimate.emor.data(), modes);
    return solve(problem(keep), prior_, used, true, control_, estimate);
}

// Cost of every held-out pair under the robust loss at one common noise level.
std::vector<double> Fit::heldout_losses(const Estimate &estimate, const Loss &common) const {
    Problem heldout = problem(split_.heldout);
    NoiseWeights weights = noise_weights(heldout, estimate, common);
    std::vector<double> losses;
    for (size_t p = 0; p < heldout.pairs.size(); p++) {
        PairTransfer t = evaluate_pair(heldout, estimate, heldout.pairs[p]);
        losses.push_back(
            pair_cost(weighted_residuals(t, heldout.channels, weights[p]), heldout.channels, common, nullptr));
    }
    return losses;
}

// The smallest number of modes whose held-out loss is within one standard error (of the paired difference) of the best.
int Fit::choose_modes(const Estimate &start, Estimate &best) {
    static const int candidates[] = {1, 2, 3, 5, 7, 9, 12};
    constexpr int count = sizeof candidates / sizeof *candidates;
    std::vector<Estimate> fits(count);
    std::vector<std::vector<double>> losses(count);
    Loss common;
    Estimate from = start;
    for (int i = 3; i < count; i++) {  // 5 modes first: its noise level is the common one
        Loss used = loss();
        fit(split_.train, candidates[i], used, from);
        fits[i] = from;
        if (i == 3) common.noise = used.noise;
        done_ += 0.08;
    }
    from = fits[3];
    for (int i = 2; i >= 0; i--) {
        Loss used = loss();
        fit(split_.train, candidates[i], used, from);
        fits[i] = from;
        done_ += 0.08;
    }
    std::vector<double> mean(count);
    for (int i = 0; i < count; i++) {
        losses[i] = heldout_losses(fits[i], common);
        mean[i] = std::accumulate(losses[i].begin(), losses[i].end(), 0.0) / static_cast<double>(losses[i].size());
    }
    int lowest = static_cast<int>(std::min_element(mean.begin(), mean.end()) - mean.begin()), chosen = lowest;
    for (int i = lowest - 1; i >= 0; i--) {
        double sum2 = 0.0;
        for (size_t p = 0; p < losses[i].size(); p++) {
            double d = losses[i][p] - losses[lowest][p] - (mean[i] - mean[lowest]);
            sum2 += d * d;
        }
        auto n = static_cast<double>(losses[i].size());
        if (mean[i] - mean[lowest] <= std::sqrt(sum2 / (n * (n - 1.0)))) chosen = i;
    }
    best = fits[chosen];
    return candidates[chosen];
}

void Fit::run(lensprof_exposure *exposures, lensprof_fit_result &result) {
    auto began = std::chrono::steady_clock::now();
    bool has_heldout = split_.heldout.size() >= kSmallestHeldout;
    const auto &train = has_heldout ? split_.train : split_.all;
    bool is_free = (options_.free & LENSPROF_FREE_RESPONSE) && options_.modes != 0;
    int modes = options_.modes == LENSPROF_MODES_AUTO ? kStartModes : static_cast<int>(options_.modes);

    Estimate train_fit = best_start(is_free ? std::min(std::max(modes, 1), kStartModes) : 0);
    done_ = 0.2;
    Loss used = loss();
    if (is_free && options_.modes == LENSPROF_MODES_AUTO && has_heldout) modes = choose_modes(train_fit, train_fit);
    else fit(train, modes, used, train_fit);
    done_ = 0.8;

    Estimate estimate = train_fit;
    Outcome outcome = fit(split_.all, modes, used, estimate);

    lensprof_fit_result r = result;
    r.iterations = static_cast<uint32_t>(outcome.iterations);
    r.converged = outcome.converged;
    describe(train_fit, estimate, used, r);
    judge(problem(split_.all), estimate.modes, r);
    r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    for (uint32_t i = 0; i < image_count_; i++) {
        const auto &a = estimate.log_exposure[i];
        const auto &given = images_[i].exposure;
        int green = options_.channels == 3 ? 1 : 0;
        exposures[i] = given;
        exposures[i].ev = (a[green] - (green ? std::log(given.white_balance[1]) : 0.0)) / std::log(2.0);
        if (green)
            for (int c : {0, 2}) exposures[i].white_balance[c] = std::exp(a[c] - a[1]) * given.white_balance[1];
    }
    result = r;
}

void set_result_response(const Estimate &estimate, lensprof_response &response) {
    if (estimate.modes < 0) response = estimate.fixed;
    else if (lensprof_response_set_emor(&response, estimate.emor.data(), static_cast<uint32_t>(estimate.modes))
             != LENSPROF_OK)
        throw std::runtime_error("the fitted response is not monotone");
}

std::vector<double> residual_levels(const Problem &problem, const Estimate &estimate) {
    std::vector<double> values;
    for (const auto &pair : problem.pairs) {
        PairTransfer t = evaluate_pair(problem, estimate, pair);
        for (int c = 0; c < problem.channels; c++)
            for (double r : t.channel[c].residual) values.push_back(255.0 * std::abs(r));
    }
    return values;
}

Summary summarise(std::vector<double> values) {
    Summary summary;
    if (values.empty()) return summary;
    double sum2 = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
    summary.rms = std::sqrt(sum2 / static_cast<double>(values.size()));
    auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    summary.median = *middle;
    return summary;
}

void Fit::describe(const Estimate &train, const Estimate &estimate, const Loss &used, lensprof_fit_result &r) const {
    set_result_response(estimate, r.response);
    r.vignetting = estimate.vignetting;
    Problem all = problem(split_.all);
    r.pairs = static_cast<uint32_t>(split_.all.size());
    r.components = all.component_count();

    bool has_heldout = split_.heldout.size() >= kSmallestHeldout;
    Problem tested = problem(has_heldout ? split_.heldout : split_.all);
    Summary summary = summarise(residual_levels(tested, train));
    r.heldout_rms = has_heldout ? summary.rms : LENSPROF_UNKNOWN;
    r.heldout_median = has_heldout ? summary.median : LENSPROF_UNKNOWN;
    std::vector<double> before;
    for (const auto &pair : tested.pairs)
        for (int c = 0; c < tested.channels; c++)
            before.push_back(255.0 * std::abs(pair.value[0][c] - pair.value[1][c]));
    r.before_rms = summarise(before).rms;

    double noise = estimate_noise(all, estimate, used.noise);
    r.noise_levels = 255.0 * noise;
    size_t inliers = 0;
    for (double z : all_chi2(all, estimate, noise)) inliers += z < inlier_limit(all.channels);
    r.inlier_share = static_cast<double>(inliers) / static_cast<double>(all.pairs.size());

    Loss final = used;
    final.noise = noise;
    Eigen::MatrixXd covariance = shared_covariance(all, prior_, final, estimate);
    int modes = static_cast<int>(r.response.modes), n = covariance.isZero() ? 0 : modes + 5;
    auto column = [&](int i) { return i < modes ? i : kMaxModes + i - modes; };
    r.covariance_size = static_cast<uint32_t>(n);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) r.covariance[i * n + j] = covariance(column(i), column(j));
}

// Pairs that tell something: different from each other, with both grey values of a channel between black and white.
size_t count_informative(const Problem &problem) {
    std::set<std::array<double, 10>> seen;
    for (const auto &p : problem.pairs) {
        bool tells = false;
        for (int c = 0; c < problem.channels; c++)
            tells = tells
                    || (std::min(p.value[0][c], p.value[1][c]) > kBlack
                        && std::max(p.value[0][c], p.value[1][c]) < 1.0 - kBlack);
        if (tells)
            seen.insert({p.xy[0][0], p.xy[0][1], p.xy[1][0], p.xy[1][1], p.value[0][0], p.value[0][1], p.value[0][2],
                         p.value[1][0], p.value[1][1], p.value[1][2]});
    }
    return seen.size();
}

// From the darkest to the brightest grey value of all pairs, without a twentieth at either end.
double grey_range(const Problem &problem) {
    std::vector<double> values;
    for (const auto &p : problem.pairs)
        for (const auto &side : p.value) values.insert(values.end(), side, side + problem.channels);
    std::sort(values.begin(), values.end());
    return values[values.size() - 1 - values.size() / 20] - values[values.size() / 20];
}

// Plain words for what makes a result unusable.
void Fit::judge(const Problem &all, int modes, lensprof_fit_result &r) const {
    size_t unknowns = free_columns(all, modes).size() + static_cast<size_t>(all.image_unknowns);
    size_t informative = count_informative(all);
    r.usable = 0;
    if (r.components > 1)
        std::snprintf(r.reason, sizeof r.reason,
                      "the images fall into %u groups without usable overlap between them; add pictures that join them",
                      r.components);
    else if (informative * static_cast<size_t>(all.channels) < 2 * unknowns)
        std::snprintf(r.reason, sizeof r.reason,
                      "%zu different pairs between black and white are too few for %zu unknowns; sample more",
                      informative, unknowns);
    else if (grey_range(all) < kSmallestRange)
        std::snprintf(r.reason, sizeof r.reason,
                      "the pairs cover %.0f grey levels only, which does not show a response", 255.0 * grey_range(all));
    else if (r.inlier_share < 0.3)
        std::snprintf(r.reason, sizeof r.reason,
                      "only %.0f %% of the pairs agree with one camera model; check the alignment of the pictures",
                      100.0 * r.inlier_share);
    else if (r.noise_levels > kLargestNoise)
        std::snprintf(r.reason, sizeof r.reason,
                      "the pairs scatter by %.1f levels about the best camera model; free more parameters, or check "
                      "the alignment",
                      r.noise_levels);
    else if (!r.converged)
        std::snprintf(r.reason, sizeof r.reason, "the fit did not settle in %u iterations", r.iterations);
    else
        r.usable = 1, r.reason[0] = 0;
}

}  // namespace

void fit_overlap(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures,
                 lensprof_fit_result &result) {
    Fit(options, images, image_count, pairs, pair_count).run(exposures, result);
}

Summary transfer_summary(const lensprof_response &response, const lensprof_vignetting &vignetting,
                         const lensprof_fit_image *images, const lensprof_exposure *exposures, uint32_t image_count,
                         const lensprof_pair *pairs, uint32_t pair_count, int channels) {
    Estimate estimate;
    estimate.modes = -1;
    estimate.fixed = response;
    estimate.vignetting = vignetting;
    for (uint32_t i = 0; i < image_count; i++) {
        std::array<double, 3> a{};
        for (int c = 0; c < 3; c++)
            a[c] = exposures[i].ev * std::log(2.0) + (channels == 1 ? 0.0 : std::log(exposures[i].white_balance[c]));
        estimate.log_exposure.push_back(a);
    }
    Problem problem;
    problem.channels = channels;
    problem.images = images;
    problem.image_count = image_count;
    problem.pairs.assign(pairs, pairs + pair_count);
    return summarise(residual_levels(problem, estimate));
}

}  // namespace lensprof
