#include "fit/methods/transfer_function/transfer_function.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/constants.hpp"
#include "fit/methods/method.hpp"
#include "fit/methods/transfer_function/jackknife.hpp"
#include "fit/methods/transfer_function/log_equations.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/solver/start.hpp"
#include "fit/verdict/finish.hpp"
#include "fit/verdict/judge.hpp"
#include "fit/verdict/limits.hpp"
#include "fit/verdict/quality.hpp"

namespace lensprof {
namespace {

constexpr int kFirstModes = 5;  // of the fits that look for falloff and gauge
constexpr int kFirstRounds = 6, kCandidateRounds = 2, kAgainRounds = 4, kLastRounds = 20;
constexpr double kStill = 1e-3;  // largest visible change in a round at convergence
// Paths that flip between two neighbours make the rounds cycle: a change this small that no longer falls indicates it.
constexpr double kCycle = 0.03;
constexpr int kMinRounds = 4;
constexpr double kHalf = 128.0 / 255.0;
const double kPaperGrey = std::log(0.5);  // g(128) if nothing determines gamma (section 2.4)

// The state that the rounds improve.
struct State {
    Estimate estimate;  // response fixed to that of `model`
    LogModel model;
    double grey = kPaperGrey;  // g(128)
    bool is_solved = false;
};

struct Candidate : HeldoutLoss {
    State state;
};

double log_grey(const Estimate &estimate) {
    return std::log(std::clamp(estimate.curve.invert(kHalf, nullptr), 1e-9, 1.0 - 1e-9));
}

// Moves a state along its family to the required g(128).
void restore_grey(const Problem &problem, State &state) {
    Estimate moved = with_exponent(problem, state.estimate, std::log(state.grey / log_grey(state.estimate)));
    if (!is_feasible(moved, problem.vignettings)) moved.vignetting = state.estimate.vignetting;
    state.estimate = moved;
    state.model.g = log_inverse(state.estimate.fixed);
}

class Fit : Method {
public:
    Fit(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
        const lensprof_pair *pairs, uint32_t pair_count)
        : Method(options, pair_count, image_count),
          images_(images),
          image_count_(image_count),
          pairs_(pairs),
          pair_count_(pair_count),
          gauge_(options, all_ = problem(split_.all)),
          is_free_((options.free & LENSPROF_FREE_RESPONSE) && options.modes != 0),
          has_falloff_(options.free & (LENSPROF_FREE_FALLOFF | LENSPROF_FREE_CENTER)),
          as_paper_(options.loss == LENSPROF_LOSS_SQUARED) {
        train_ = problem(split_.has_heldout() ? split_.train : split_.all);
        if (split_.has_heldout()) heldout_ = problem(split_.heldout);
    }

    void run(lensprof_exposure *exposures, FitResult &result);

private:
    Problem problem(const std::vector<uint32_t> &keep) const {
        return make_problem(options_, images_, image_count_, pairs_, keep);
    }
    void advance(double done) {
        done_ = std::max(done_, done);
        if (is_cancelled(done_)) throw Cancelled();
    }
    // True if the pictures leave gamma open: g(128) is then held, at the determined gamma or at the paper's value.
    bool holds_grey() const { return is_free_ && (gauge_.is_open() || gauge_.from() == LENSPROF_GAMMA_NONE); }

    State start();
    bool fit_response(const Problem &problem, Gauge &gauge, bool find_gamma, State &state) const;
    void fit_falloff(const Problem &problem, Gauge &gauge, State &state) const;
    int alternate(const Problem &problem, Gauge &gauge, bool find_gamma, int rounds, State &state,
                  const std::function<void()> &report, bool &is_still) const;
    Candidate candidate(const State &from, int modes);
    Candidate choose_modes(const State &start);
    Estimate in_emor(const State &state) const;
    void judge_exposures(const State &state, FitResult &result) const;
    double log_exponent(const Estimate &estimate, const Estimate &other) const;
    Covariance scatter(const State &state);

    const lensprof_fit_image *images_;
    uint32_t image_count_;
    const lensprof_pair *pairs_;
    uint32_t pair_count_;
    Gauge gauge_;
    const bool is_free_, has_falloff_, as_paper_;
};

// Tries several held responses and starts from the one under which falloff and exposures explain most. Without a free
// falloff, starts from the mean of the model.
State Fit::start() {
    Problem brief = problem(brief_subset());
    brief.vignettings = all_.vignettings;
    std::vector<Estimate> starts = start_estimates(has_falloff_ ? brief : train_, options_, is_free_ ? kFirstModes : 0);
    for (Estimate &start : starts)
        if (start.modes >= 0) set_fixed(start, table_response(start));
    Gauge unconstrained = gauge_.unconstrained();
    State best;
    best.estimate = has_falloff_ ? best_brief_fit(brief, unconstrained, nullptr, starts) : starts.front();
    start_exposures(train_, kRoughWidth, best.estimate);
    if (gauge_.is_open() && is_free_) gauge_.apply_gamma(train_, best.estimate);
    best.model.is_free = is_free_;
    best.model.modes = is_free_ ? kFirstModes : 0;
    best.model.g = log_inverse(best.estimate.fixed);
    if (gauge_.is_open()) best.grey = log_grey(best.estimate);
    return best;
}

// Computes transfer functions under the current falloff, and the response and exposures that explain them. With
// `find_gamma`, gamma is determined again.
bool Fit::fit_response(const Problem &problem, Gauge &gauge, bool find_gamma, State &state) const {
    constexpr int kRounds = 4;
    std::vector<TransferCurve> curves = transfer_curves(problem, state.estimate, as_paper_);
    std::vector<double> noise;
    for (const TransferCurve &curve : curves)
        if (curve.noise > 0.0) noise.push_back(curve.noise);
    LogWeights weights;
    weights.as_paper = as_paper_;
    if (!noise.empty()) weights.noise = median(noise);
    Prior known;
    gauge.renew(problem, state.estimate, known);
    for (int round = 0; round < kRounds; round++) {
        weights.adjusted = !as_paper_ && state.is_solved;
        LogEquations equations(problem, curves, weights, state.model, state.estimate);
        equations.add_known(known.known, state.estimate);
        if (!equations.eliminate()) return false;
        if (!equations.solve(options_.prior_weight, holds_grey(), state.model, state.estimate)) return false;
        state.is_solved = equations.points() > 0.0;
        if (!is_free_) continue;
        set_fixed(state.estimate, response_of(state.model.g));
        if (find_gamma && gauge.is_open()) {
            gauge.apply_gamma(problem, state.estimate);
            state.model.g = log_inverse(state.estimate.fixed);
            state.grey = log_grey(state.estimate);
        } else if (holds_grey()) {
            restore_grey(problem, state);
        }
    }
    return true;
}

void Fit::fit_falloff(const Problem &problem, Gauge &gauge, State &state) const {
    if (!has_falloff_) return;
    Control brief;
    brief.max_iterations = std::min(static_cast<int>(options_.max_iterations), 12);
    brief.rounds = 1;
    brief.flat = 1e-2;
    Loss used = loss();
    solve(problem, prior_, gauge, used, true, brief, state.estimate);
}

// Alternates falloff and response until neither moves; returns the number of rounds.
int Fit::alternate(const Problem &problem, Gauge &gauge, bool find_gamma, int rounds, State &state,
                   const std::function<void()> &report, bool &is_still) const {
    is_still = false;
    int round = 0;
    double last = 0.0;
    while (round < rounds && !is_still) {
        report();
        Estimate before = state.estimate;
        if (!fit_response(problem, gauge, find_gamma, state)) {
            state.is_solved = false;
            return round;
        }
        round++;
        fit_falloff(problem, gauge, state);
        double moved = largest_change(before, state.estimate);
        bool cycles = round >= kMinRounds && moved < kCycle && moved > 0.5 * last;
        is_still = moved < kStill || cycles || (!has_falloff_ && round > 1);
        last = moved;
    }
    return round;
}

// A fit to the training pairs, and its loss on the others.
Candidate Fit::candidate(const State &from, int modes) {
    Candidate result;
    result.state = from;
    result.state.model.modes = modes;
    bool is_still;
    alternate(
        train_, gauge_, true, kCandidateRounds, result.state, [this] { advance(done_); }, is_still);
    static_cast<HeldoutLoss &>(result) = heldout_loss(heldout_, result.state.estimate, common_);
    advance(std::min(0.7, done_ + 0.06));
    return result;
}

// The smallest number of modes whose held-out loss is within one standard error of the best.
Candidate Fit::choose_modes(const State &start) {
    std::vector<Candidate> tried;
    for (int modes : {1, 2, 3, 4, 5, 7, 9, 12, 15, 20}) tried.push_back(candidate(start, modes));
    const Candidate &best = best_of(tried);
    for (const Candidate &candidate : tried)
        if (&candidate == &best || is_as_good(candidate, best)) return candidate;
    return best;
}

// The response as coefficients of all EMoR modes, as in the other methods; a held one stays.
Estimate Fit::in_emor(const State &state) const {
    Estimate estimate = state.estimate;
    if (is_free_) set_response(estimate, project_curve(estimate.fixed.table, kMaxModes).data(), kMaxModes);
    return estimate;
}

// Transfer functions of pictures with equal exposures are the identity, whatever the response.
void Fit::judge_exposures(const State &state, FitResult &r) const {
    if ((!r.usable && r.converged) || !is_free_) return;  // with equal exposures, they do not converge either
    double usual = exposure_spread(all_, state.estimate);
    if (usual < kSmallestSpread && !has_code(r.verdict, LENSPROF_REASON_EXPOSURES_EQUAL))
        report_first(r, found_by_method(LENSPROF_REASON_EXPOSURES_EQUAL, of_value(usual)));
}

// ln of the exponent that takes the exposures of an estimate to those of another, as nearly as one exponent can; 0 if
// they differ too little to determine one.
double Fit::log_exponent(const Estimate &estimate, const Estimate &other) const {
    double square = 0.0, product = 0.0;
    for (uint32_t i = 0; i < image_count_; i++)
        for (size_t c = 0; c < static_cast<size_t>(all_.channels); c++) {
            double x = estimate.log_exposure[i][c] - estimate.log_exposure[all_.reference][c];
            square += x * x;
            product += x * (other.log_exposure[i][c] - other.log_exposure[all_.reference][c]);
        }
    const double spread = kSmallestSpread * kLn2, terms = static_cast<double>(image_count_) * all_.channels;
    return square > spread * spread * terms && product > 0.0 ? std::log(product / square) : 0.0;
}

// There is no scatter along the family: gamma has an error of its own (Gauge::sigma).
Covariance Fit::scatter(const State &state) {
    return jackknife(
        all_, pair_count_,
        [&](const std::vector<uint32_t> &keep) {
            Problem part = problem(keep);
            part.vignettings = all_.vignettings;
            part.threads = 1;
            Gauge gauge = gauge_;
            State part_state = state;
            bool is_still;
            alternate(
                part, gauge, false, kAgainRounds, part_state, [] {}, is_still);
            if (!part_state.is_solved) return Estimate();
            if (holds_grey())
                part_state.estimate =
                    with_exponent(part, part_state.estimate, log_exponent(part_state.estimate, state.estimate));
            return in_emor(part_state);
        },
        [this] { return is_cancelled(done_); });
}

void Fit::run(lensprof_exposure *exposures, FitResult &result) {
    bool any_modes = is_free_ && options_.modes == LENSPROF_MODES_AUTO && split_.has_heldout();
    bool any_curves = may_choose_vignettings(split_.has_heldout());
    int max_rounds = std::min(static_cast<int>(std::min(options_.max_iterations, 1000u)), kLastRounds);
    auto report = [this] { advance(done_); };
    bool is_still;

    set_vignettings(options_.vignettings == 3 && options_.channels == 3 ? 3 : 1);
    advance(0.0);
    Candidate best;
    best.state = start();
    advance(0.1);
    if (is_free_ && options_.modes != LENSPROF_MODES_AUTO) best.state.model.modes = static_cast<int>(options_.modes);
    alternate(train_, gauge_, true, std::min(max_rounds, kFirstRounds), best.state, report, is_still);
    common_ = loss();
    common_.noise = estimate_noise(train_, best.state.estimate, common_.noise);
    if (any_modes)
        best = choose_modes(best.state);
    else if (any_curves)
        best = candidate(best.state, best.state.model.modes);
    if (any_curves)
        choose_vignettings(
            best, [this](int count) { set_vignettings(count); },
            [&] { return candidate(best.state, best.state.model.modes); });
    advance(0.7);

    State last = best.state;
    int rounds = alternate(all_, gauge_, true, max_rounds, last, report, is_still);
    advance(0.8);
    Covariance found = scatter(last);
    Estimate estimate = in_emor(last);
    finish(
        {all_, gauge_, estimate, split_.has_heldout() ? heldout_ : all_, best.state.estimate, split_.has_heldout(),
         estimate_noise(all_, estimate, common_.noise), found, static_cast<uint32_t>(rounds), is_still},
        [&](FitResult &r) { judge_exposures(last, r); }, exposures, result);
}

}  // namespace

void fit_transfer_functions(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                            const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures,
                            FitResult &result) {
    Fit(options, images, image_count, pairs, pair_count).run(exposures, result);
}

}  // namespace lensprof
