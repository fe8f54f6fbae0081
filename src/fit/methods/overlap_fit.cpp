#include "fit/methods/overlap_fit.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "falloff/rise.hpp"
#include "fit/base/constants.hpp"
#include "fit/base/quantile.hpp"
#include "fit/methods/refine.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/solver/objective.hpp"
#include "fit/solver/start.hpp"
#include "fit/verdict/finish.hpp"

namespace lensprof {
namespace {

constexpr double kFollows = 0.02;  // of ln gamma, allowed distance of modes from the requested value

}  // namespace

// The best of short fits from every start, with its gamma determined.
Estimate OverlapFit::best_start(int modes) {
    Problem brief = problem_(options_, brief_subset());
    brief.vignettings = all_.vignettings;
    Gauge unconstrained = gauge_.unconstrained();
    Estimate best = best_brief_fit(brief, unconstrained, control_.cancelled, start_estimates(brief, options_, modes));
    start_exposures(all_, kRoughWidth, best);  // sets the exposures of images that had few pairs here
    gauge_.apply_gamma(train_, best);
    return best;
}

static void set_modes(Estimate &estimate, int modes) {
    if (estimate.modes >= 0 && modes < estimate.modes)
        set_response(estimate, project_curve(estimate.curve.table.data(), modes).data(), modes);
    else if (estimate.modes >= 0)
        set_response(estimate, estimate.emor.data(), modes);
}

// A fit to the training pairs at the common noise level.
Candidate OverlapFit::candidate(const Estimate &from, int modes) {
    Candidate result;
    result.estimate = from;
    set_modes(result.estimate, modes);
    Control brief = control_;
    brief.rounds = 1;
    brief.flat = 0.05;
    brief.max_iterations = std::min(control_.max_iterations, 12);
    Loss used = common_;
    solve(train_, prior_, gauge_, used, false, brief, result.estimate);
    static_cast<HeldoutLoss &>(result) = heldout_loss(heldout_, result.estimate, common_);
    done_ = std::min(0.75, done_ + 0.08);
    return result;
}

// Frees the response from its modes, first at the noise level that they left, then at the remaining noise level.
void OverlapFit::refine(const Problem &problem, Loss &used, Estimate &estimate) {
    const Estimate of_modes = estimate;
    refine_response(problem, used, estimate);
    used.noise = estimate_noise(problem, estimate, used.noise);
    estimate = of_modes;
    refine_response(problem, used, estimate);
}

// Whether a response free of its modes is not worse on held-out pairs by more than a standard error.
bool OverlapFit::is_as_good_refined(const Candidate &best, const Loss &used, Candidate &refined) {
    HeldoutLoss modes = heldout_loss(heldout_, best.estimate, common_);
    refined.estimate = best.estimate;
    Loss refined_loss = used;
    refine(train_, refined_loss, refined.estimate);
    static_cast<HeldoutLoss &>(refined) = heldout_loss(heldout_, refined.estimate, common_);
    double error, difference = loss_difference(refined, modes, error);
    return difference < error;
}

// Recomputes the exposures from the fitted response and all pairs. If pairs that agree by chance had misled an image,
// the fit of `problem` from there has a lower cost.
void OverlapFit::reconsider(const Problem &problem, const Loss &used, Estimate &estimate) {
    constexpr double kLargestChange = 0.15;  // natural logarithm
    Estimate other = estimate;
    start_exposures(all_, kFineWidth, other);
    double change = 0.0;
    for (size_t i = 0; i < other.log_exposure.size(); i++)
        for (size_t c = 0; c < 3; c++)
            change = std::max(change, std::abs(other.log_exposure[i][c] - estimate.log_exposure[i][c]));
    if (change < kLargestChange) return;
    Control brief = control_;
    brief.rounds = 1;
    brief.flat = 0.05;
    Loss fixed = used;
    double cost = solve(problem, prior_, gauge_, fixed, false, brief, estimate).cost;
    if (solve(problem, prior_, gauge_, fixed, false, brief, other).cost < cost) estimate = other;
}

// The smallest number of modes whose held-out loss is within one standard error (of the paired difference) of the best.
// More modes are tried until two in a row have not helped, fewer until one is worse.
Candidate OverlapFit::choose_modes(const Estimate &start) {
    std::vector<Candidate> tried;  // in order of falling number of modes, once complete
    tried.push_back(candidate(start, start_modes()));
    double lowest = tried[0].mean;
    int failures = 0;
    for (int modes : {7, 9, 12, 16}) {
        if (modes <= start_modes()) continue;
        tried.insert(tried.begin(), candidate(tried.front().estimate, modes));
        failures = tried.front().mean < lowest ? 0 : failures + 1;
        lowest = std::min(lowest, tried.front().mean);
        if (failures == 2) break;
    }
    auto is_good = [&](const Candidate &candidate) { return is_as_good(candidate, best_of(tried)); };
    for (int modes : {3, 2, 1}) {
        if (!is_good(tried.back()) || (stored_ && modes < stored_->modes())) break;
        tried.push_back(candidate(tried.back().estimate, modes));
    }
    for (size_t i = tried.size(); i-- > 1;)
        if (is_good(tried[i])) return tried[i];
    return tried[0];
}

// Chooses start, modes and falloff curves.
Candidate OverlapFit::choose(Loss &used) {
    bool any_modes = is_free_ && options_.modes == LENSPROF_MODES_AUTO && has_heldout_;
    bool any_curves = may_choose_vignettings(has_heldout_);
    int modes = options_.modes == LENSPROF_MODES_AUTO ? start_modes() : static_cast<int>(options_.modes);
    if (any_curves && stored_ && stored_->vignettings() == 3) any_curves = false;

    set_vignettings(first_vignettings());
    Candidate best;
    best.estimate = best_start(is_free_ ? std::min(std::max(modes, 1), start_modes()) : 0);
    done_ = 0.2;
    set_modes(best.estimate, modes);
    Control first = control_;
    if (any_modes || any_curves) first.flat = 0.05, first.rounds = 3;
    solve(train_, prior_, gauge_, used, true, first, best.estimate);
    reconsider(train_, used, best.estimate);
    common_ = used;
    if (options_.loss != LENSPROF_LOSS_ROBUST) common_.noise = estimate_noise(train_, best.estimate, used.noise);
    if (any_modes)
        best = choose_modes(best.estimate);
    else if (any_curves)
        best = candidate(best.estimate, modes);
    if (any_curves)
        choose_vignettings(
            best, [this](int count) { set_vignettings(count); },
            [&] { return candidate(best.estimate, best.estimate.modes); });
    done_ = 0.8;
    return best;
}

void OverlapFit::take_all() {
    if (step_ == 1) return;
    step_ = 1;
    const int vignettings = all_.vignettings;
    all_ = problem_(options_, split_.all);
    train_ = problem_(options_, split_.train);
    heldout_ = problem_(options_, split_.heldout);
    set_vignettings(vignettings);
}

// Whether modes can follow to the requested gamma: the estimate is then that of a fit which holds it.
bool OverlapFit::follows(const Loss &used, Estimate &estimate, Outcome &outcome) {
    Estimate trial = estimate;
    Loss trial_loss = used;
    Outcome result = solve(all_, prior_, gauge_, trial_loss, true, control_, trial);
    HeldoutLoss before = heldout_loss(heldout_, estimate, common_), after = heldout_loss(heldout_, trial, common_);
    double error, difference = loss_difference(after, before, error);
    if (difference > error || std::abs(gauge_.distance(all_, trial)) > kFollows) return false;
    estimate = trial, outcome = result;
    return true;
}

// Refines again where the table's samples of irradiance are too far apart for the dark end: below the first of them f
// is linear. If gamma is known by the prior alone, a smaller one, by its standard error, spreads the dark end over more
// samples. Kept if held-out pairs are clearly better predicted.
void OverlapFit::resolve_dark_end(Loss &used, Candidate &best, Estimate &estimate) {
    constexpr double kResolved = 1.0 / 255.0, kGain = 0.02;  // of the loss: 1 % of the residual
    if (best.estimate.curve.table[1] <= kResolved) return;
    const double step = gauge_.is_open() && gauge_.from() == LENSPROF_GAMMA_PRIOR ? -gauge_.target_sigma() : 0.0;
    Candidate resolved;
    resolved.estimate = with_exponent(train_, best.estimate, step);
    Loss of_train = used;
    refine(train_, of_train, resolved.estimate);
    static_cast<HeldoutLoss &>(resolved) = heldout_loss(heldout_, resolved.estimate, common_);
    const HeldoutLoss before = heldout_loss(heldout_, best.estimate, common_);
    if (!is_clearly_better(resolved, before) || before.mean - resolved.mean < kGain * before.mean) return;
    best = resolved;
    estimate = with_exponent(all_, estimate, step);
    refine(all_, used, estimate);
}

// Frees the response from its modes if that is better, or if these cannot follow to the requested gamma. The fits so
// far have the gamma of most cameras.
void OverlapFit::free_response(const Gauge &requested, Loss &used, Candidate &best, Estimate &estimate,
                               Outcome &outcome) {
    const bool was_thinned = step_ > 1;
    take_all();
    Candidate refined;
    const bool is_refined = options_.method == LENSPROF_METHOD_TRANSFER && is_as_good_refined(best, used, refined);
    if (is_refined)
        best = refined, refine(all_, used, estimate);
    else if (was_thinned)
        outcome = solve(all_, prior_, gauge_, used, true, control_, estimate);
    gauge_ = requested;
    if (!is_refined && follows(used, estimate, outcome)) return;
    for (Estimate *target : {&estimate, &best.estimate}) {
        if (!target->is_refined) set_table(*target, target->curve.table.data());
        gauge_.apply_gamma(all_, *target);
    }
    if (is_refined) resolve_dark_end(used, best, estimate);
}

// From the present estimates, with the present knowledge.
void OverlapFit::solve_again() {
    set_vignettings(all_.vignettings);
    Loss used = found_.used;
    solve(train_, prior_, gauge_, used, true, control_, found_.best.estimate);
    found_.outcome = solve(all_, prior_, gauge_, found_.used, true, control_, found_.estimate);
}

void OverlapFit::restore(const State &state) {
    found_ = state.found, gauge_ = state.gauge, lenses_ = state.lenses, control_.falls = state.falls;
    set_vignettings(all_.vignettings);
}

// Weighs the knowledge of lenses against what the pictures show, of which errors common to neighbouring pairs leave
// less than their number suggests, and fits again.
void OverlapFit::weigh_lens_knowledge() {
    constexpr int kRounds = 2;
    for (int round = 0; round < kRounds; round++) {
        inflation_ = error_inflation(all_, prior_, gauge_, found_.used, found_.estimate);
        const Covariance found = covariance(all_, prior_, gauge_, found_.used, found_.estimate);
        if (!found.is_determined) break;
        if (stored_ && all_.settings == 1) return;  // the profile replaces the knowledge of all lenses
        lenses_ = weigh_lenses(all_, prior_, options_.prior_weight, found_.estimate, found, inflation_);
        solve_again();
    }
    hold_equal_exposures();
    free_center();
    hold_falling();
}

// How many unknown exposures the reference's component has; 0 if anything is known of them.
static int undetermined_exposures(const Problem &problem) {
    std::set<int> columns;
    for (uint32_t i = 0; i < problem.image_count; i++) {
        if (problem.images[i].known_ev_sigma > 0.0) return 0;
        if (i == problem.reference || problem.component[i] != problem.component[problem.reference]) continue;
        if (problem.ev_unknown[i] < 0) return 0;
        columns.insert(problem.ev_unknown[i]);
    }
    return static_cast<int>(columns.size());
}

static double largest_step_ev(const Problem &problem, const Estimate &estimate) {
    const auto c = static_cast<size_t>(problem.measured_channel());
    double largest = 0.0;
    for (const Edge &edge : problem.edges)
        largest = std::max(
            largest,
            std::abs(estimate.log_exposure[edge.image[0]][c] - estimate.log_exposure[edge.image[1]][c]) / kLn2);
    return largest;
}

// Whether one of the exposures differs from the reference's by far more than a test of `limit` (chi squared) accepts. A
// test of all of them is larger still (Wald 1943), and a fit that holds them equal would converge slowly.
bool OverlapFit::exposures_clearly_differ(double limit) {
    constexpr double kClearly = 9.0;  // of the limit: residuals are not quadratic
    const Covariance found = covariance(all_, prior_, gauge_, found_.used, found_.estimate, &inflation_);
    if (!found.is_determined) return false;
    const auto c = static_cast<size_t>(all_.measured_channel());
    const double zero = found_.estimate.log_exposure[all_.reference][c];
    for (uint32_t i = 0; i < all_.image_count; i++) {
        if (all_.ev_unknown[i] < 0 || all_.component[i] != all_.component[all_.reference]) continue;
        const double difference = found_.estimate.log_exposure[i][c] - zero;
        if (difference * difference > kClearly * limit * found.images[all_.ev_unknown[i]]) return true;
    }
    return false;
}

// Exposures that drift along a row look much like a centre that is off the middle. Many cameras hold their exposure
// along a row, and others almost never give equal exposures by accident: they are taken as equal unless a likelihood
// ratio test (Wilks 1938) rejects it. Small steps that all links share come from a falloff that is not quite radial.
void OverlapFit::hold_equal_exposures() {
    constexpr int kFewest = 2;        // a single one may be equal by accident
    constexpr double kUnseen = 0.02;  // EV from image to image
    constexpr double kMargin = 2.0;   // of the limit: the inflation is an estimate
    const int unknown = undetermined_exposures(all_);
    if (unknown < kFewest) return;
    const double limit = kMargin * chi_squared_limit(unknown);
    const bool any_seen = largest_step_ev(all_, found_.estimate) >= kUnseen;
    if (any_seen && exposures_clearly_differ(limit)) return;
    State different = state();
    const Estimate &found = different.found.estimate;
    Prior prior = prior_of(prior_, found.modes);
    different.gauge.renew(all_, found, prior);
    const auto objective = make_objective(all_, prior, different.found.used, found);
    gauge_.expect_equal_exposures();
    solve_again();
    const double ratio = objective->value_at(found_.estimate) - objective->value_at(found);
    if (any_seen && !(2.0 * ratio / inflation_.exposures < limit)) restore(different);
}

// A crop has its optical axis far from its middle, as no lens has. The pictures must predict held-out pairs
// clearly better for it: a drift of exposures along a row looks much like it.
void OverlapFit::free_center() {
    constexpr double kFar = 3.0, kFreedom = 2.0, kGain = 0.04;  // of the loss: 2 % of the residual
    bool is_far = false;
    const State held = state();
    for (WeighedLens &lens : lenses_) {
        const double distance2 = lens.center_distance * lens.center_distance;
        if (lens.center_distance < kFar) continue;
        lens.knowledge.center_weight *= (kFreedom + 2.0) / (kFreedom + distance2);
        is_far = true;
    }
    if (!is_far) return;
    const HeldoutLoss before = loss_of(*this);
    solve_again();
    double error;
    const double gain = -loss_difference_by_place(tested(), loss_of(*this), before, error);
    if (!(gain > 3.0 * error && gain > kGain * before.mean)) restore(held);
}

// Falloffs that rise outward, as almost no lens does, must predict held-out pairs clearly better than the best ones
// that do not.
void OverlapFit::hold_falling() {
    bool any_rises = false;
    for (const Falloffs &curves : found_.estimate.vignetting)
        for (const lensprof_vignetting &v : curves) any_rises = any_rises || course_of(v).rise.m > kSmallRise;
    if (!any_rises || (options_.free & LENSPROF_FREE_FALLOFF) != LENSPROF_FREE_FALLOFF) return;
    const State rising = state();
    const HeldoutLoss rising_loss = loss_of(*this);
    for (Estimate *estimate : {&found_.estimate, &found_.best.estimate})
        for (Falloffs &curves : estimate->vignetting)
            for (lensprof_vignetting &v : curves) {
                const double corner = lensprof_vignetting_eval(&v, 1.0, nullptr) - 1.0;
                v.k[0] = std::clamp(corner, -0.9, 0.0), v.k[1] = v.k[2] = 0.0;
            }
    control_.falls = true;
    solve_again();
    double error;
    if (!(loss_difference_by_place(tested(), loss_of(*this), rising_loss, error) <= 3.0 * error)) restore(rising);
}

const Problem &OverlapFit::tested() const { return has_heldout_ ? heldout_ : all_; }

HeldoutLoss OverlapFit::loss_of(const OverlapFit &other) const {
    return heldout_loss(tested(), has_heldout_ ? other.found_.best.estimate : other.found_.estimate, common_);
}

bool OverlapFit::predicts_better(const HeldoutLoss &simpler) const {
    double error;
    const double difference = loss_difference_by_place(tested(), loss_of(*this), simpler, error);
    // Few pairs, all of which were fitted: the gain must also pay for the unknowns (Akaike 1974).
    const auto unknowns = static_cast<double>(free_columns(all_, found_.estimate.modes).size());
    const double cost = has_heldout_ ? 0.0 : unknowns / static_cast<double>(simpler.losses.size());
    return difference + cost < -2.0 * error;
}

bool OverlapFit::predicts_better_than(const OverlapFit &simpler) const { return predicts_better(loss_of(simpler)); }

// Nothing: the pictures as they are.
bool OverlapFit::predicts_better_than_nothing() const {
    Estimate nothing = found_.estimate;
    lensprof_response linear;
    lensprof_response_set_linear(&linear);
    set_fixed(nothing, linear);
    for (Falloffs &curves : nothing.vignetting) curves = Falloffs{};
    for (auto &log_exposure : nothing.log_exposure) log_exposure = {0.0, 0.0, 0.0};
    return predicts_better(heldout_loss(tested(), nothing, common_));
}

void OverlapFit::run() {
    bool frees = options_.refine && is_free_ && has_heldout_ && image_count_ <= kMaxRefinedImages;
    Gauge requested = gauge_;
    if (frees) gauge_ = gauge_.by_prior();
    found_.used = loss();
    found_.used.distrusts = true;
    found_.best = choose(found_.used);
    found_.estimate = found_.best.estimate;
    if (has_heldout_) reconsider(all_, found_.used, found_.estimate);
    found_.outcome = solve(all_, prior_, gauge_, found_.used, true, control_, found_.estimate);
    inflation_ = Inflation(all_.settings);
    if (options_.prior_weight > 0.0 && frees_lens() && !is_static(all_)) weigh_lens_knowledge();
    if (gauge_.expects_equal_exposures()) requested.expect_equal_exposures();
    if (frees)
        free_response(requested, found_.used, found_.best, found_.estimate, found_.outcome);
    else
        take_all();
}

double OverlapFit::worse_than(const OverlapFit &other) const {
    if (!has_heldout_) return 0.0;
    HeldoutLoss own_loss = heldout_loss(other.heldout_, found_.best.estimate, other.common_),
                other_loss = heldout_loss(other.heldout_, other.found_.best.estimate, other.common_);
    double error, difference = loss_difference(own_loss, other_loss, error);
    return error > 0.0 ? difference / error : 0.0;
}

void OverlapFit::describe(lensprof_exposure *exposures, FitResult &result) {
    Loss last = found_.used;
    last.noise = estimate_noise(all_, found_.estimate, found_.used.noise);
    const Covariance found = covariance(all_, prior_, gauge_, last, found_.estimate, &inflation_);
    finish({all_, gauge_, found_.estimate, tested(), found_.best.estimate, has_heldout_, last.noise, found,
            static_cast<uint32_t>(found_.outcome.iterations), found_.outcome.converged},
           nullptr, exposures, result);
    result.equal_exposures = gauge_.expects_equal_exposures();
    result.falloff_prior_distance = result.center_prior_distance = 0.0;
    for (const WeighedLens &lens : lenses_) {
        result.falloff_prior_distance = std::max(result.falloff_prior_distance, lens.falloff_distance);
        result.center_prior_distance = std::max(result.center_prior_distance, lens.center_distance);
    }
    result.error_inflation = *std::max_element(inflation_.lens.begin(), inflation_.lens.end());
}

}  // namespace lensprof
