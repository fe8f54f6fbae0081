#include "fit/methods/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

#include "core/covariance.h"
#include "fit/base/constants.hpp"
#include "fit/methods/method.hpp"
#include "fit/methods/refine.hpp"
#include "fit/methods/unshown.hpp"
#include "fit/problem/curve_shape.hpp"
#include "fit/solver/objective.hpp"
#include "fit/solver/start.hpp"
#include "fit/verdict/finish.hpp"
#include "fit/verdict/output.hpp"
#include "fit/verdict/reason.hpp"

namespace lensprof {
namespace {

constexpr int kStartModes = 5;               // enough to distinguish the starts
constexpr double kFollows = 0.02;            // of ln gamma, allowed distance of modes from the requested value
constexpr uint32_t kEnoughForModes = 20000;  // pairs, if there are more to refine the response

// A fit to the training data.
struct Candidate : HeldoutLoss {
    Estimate estimate;
};

class Fit : Method {
public:
    // make(keep): the problem with a subset of `count` pairs or tracks.
    using Make = std::function<Problem(const std::vector<uint32_t> &keep)>;

    // `profile`: that of the options, or NULL for a fit without it. Progress goes from `from` to `to`.
    Fit(const lensprof_fit_options &options, uint32_t image_count, Make make, uint32_t count,
        const lensprof_profile *profile, double from, double to)
        : Method(options, count, image_count),
          image_count_(image_count),
          problem_(std::move(make)),
          step_(options.refine ? 1 + count / kEnoughForModes : 1),
          stored_(stored_prior(options, profile, all_ = problem_(thinned(split_.all)))),
          gauge_(options, all_, stored_.get()) {
        if (split_.has_heldout()) heldout_ = problem_(thinned(split_.heldout));
        has_heldout_ = heldout_.pairs.size() >= kMinHeldout;
        train_ = problem_(thinned(has_heldout_ ? split_.train : split_.all));
        control_.max_iterations = static_cast<int>(options.max_iterations);
        control_.cancelled = [this, from, to] { return is_cancelled(from + (to - from) * done_); };
    }

    void run();

    // Increase of the held-out loss compared with a fit without the profile, in standard errors; 0 without held-out
    // pairs.
    double worse_than(const Fit &other) const;

    double falloff_distance(const lensprof_fit_result &alone) const { return stored_->falloff_distance(alone); }
    double response_distance(const lensprof_fit_result &alone) const { return stored_->response_distance(alone); }
    double gamma_distance() const { return gauge_.contradiction(estimate_); }

    void describe(lensprof_exposure *exposures, lensprof_fit_result &result);

private:
    static std::unique_ptr<StoredPrior> stored_prior(const lensprof_fit_options &options,
                                                     const lensprof_profile *profile, const Problem &problem) {
        if (!profile) return nullptr;
        const bool is_free = options.free & LENSPROF_FREE_RESPONSE;
        const int max_modes = !is_free ? 0 : static_cast<int>(std::min<uint32_t>(options.modes, LENSPROF_EMOR_MODES));
        return std::make_unique<StoredPrior>(*profile, problem, max_modes);
    }
    std::vector<uint32_t> thinned(const std::vector<uint32_t> &items) const {
        std::vector<uint32_t> kept;
        for (size_t i = 0; i < items.size(); i += step_) kept.push_back(items[i]);
        return kept;
    }
    void take_all();
    void set_vignettings(int count) {
        Method::set_vignettings(count);
        if (stored_) stored_->put_into(prior_, count, options_.prior_weight, gauge_.is_open());
    }
    int first_vignettings() const {
        const bool per_channel =
            options_.vignettings == 3 || (options_.vignettings == 0 && stored_ && stored_->vignettings() == 3);
        return per_channel && options_.channels == 3 ? 3 : 1;
    }
    // Fewer modes than the profile's would discard what is known of the others.
    int start_modes() const { return stored_ ? std::max(kStartModes, stored_->modes()) : kStartModes; }
    Estimate best_start(int modes);
    void reconsider(const Problem &problem, const Loss &used, Estimate &estimate);
    Candidate candidate(const Estimate &from, int modes);
    void refine(const Problem &problem, Loss &used, Estimate &estimate);
    bool is_as_good_refined(const Candidate &best, const Loss &used, Candidate &refined);
    Candidate choose_modes(const Estimate &start);
    Candidate choose(Loss &used);
    bool follows(const Loss &used, Estimate &estimate, Outcome &outcome);
    void free_response(const Gauge &requested, Loss &used, Candidate &best, Estimate &estimate, Outcome &outcome);

    uint32_t image_count_;
    const Make problem_;
    size_t step_;  // only every so manieth pair is used until the response is refined
    bool has_heldout_ = false;
    const bool is_free_ = (options_.free & LENSPROF_FREE_RESPONSE) && options_.modes != 0;  // the response
    std::unique_ptr<StoredPrior> stored_;
    Gauge gauge_;
    Loss used_;
    Candidate best_;     // of the training pairs
    Estimate estimate_;  // of all
    Outcome outcome_;
    Control control_;
};

// The best of short fits from every start, with its gamma determined.
Estimate Fit::best_start(int modes) {
    Problem brief = problem_(brief_subset());
    brief.vignettings = all_.vignettings;
    Gauge unconstrained = gauge_.unconstrained();
    Estimate best = best_brief_fit(brief, unconstrained, control_.cancelled, start_estimates(brief, options_, modes));
    start_exposures(all_, kRoughWidth, best);  // sets the exposures of images that had few pairs here
    gauge_.apply_gamma(train_, best);
    return best;
}

void set_modes(Estimate &estimate, int modes) {
    if (estimate.modes >= 0 && modes < estimate.modes)
        set_response(estimate, project_curve(estimate.curve.table.data(), modes).data(), modes);
    else if (estimate.modes >= 0)
        set_response(estimate, estimate.emor.data(), modes);
}

// A fit to the training pairs at the common noise level.
Candidate Fit::candidate(const Estimate &from, int modes) {
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
void Fit::refine(const Problem &problem, Loss &used, Estimate &estimate) {
    const Estimate of_modes = estimate;
    refine_response(problem, used, estimate);
    used.noise = estimate_noise(problem, estimate, used.noise);
    estimate = of_modes;
    refine_response(problem, used, estimate);
}

// Whether a response free of its modes is not worse on held-out pairs by more than a standard error.
bool Fit::is_as_good_refined(const Candidate &best, const Loss &used, Candidate &refined) {
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
void Fit::reconsider(const Problem &problem, const Loss &used, Estimate &estimate) {
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
Candidate Fit::choose_modes(const Estimate &start) {
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
Candidate Fit::choose(Loss &used) {
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

void Fit::take_all() {
    if (step_ == 1) return;
    step_ = 1;
    const int vignettings = all_.vignettings;
    all_ = problem_(split_.all);
    train_ = problem_(split_.train);
    heldout_ = problem_(split_.heldout);
    set_vignettings(vignettings);
}

// Whether modes can follow to the requested gamma: the estimate is then that of a fit which holds it.
bool Fit::follows(const Loss &used, Estimate &estimate, Outcome &outcome) {
    Estimate trial = estimate;
    Loss trial_loss = used;
    Outcome result = solve(all_, prior_, gauge_, trial_loss, true, control_, trial);
    HeldoutLoss before = heldout_loss(heldout_, estimate, common_), after = heldout_loss(heldout_, trial, common_);
    double error, difference = loss_difference(after, before, error);
    if (difference > error || std::abs(gauge_.distance(all_, trial)) > kFollows) return false;
    estimate = trial, outcome = result;
    return true;
}

// Frees the response from its modes if that is better, or if these cannot follow to the requested gamma. The fits so
// far have the gamma of most cameras.
void Fit::free_response(const Gauge &requested, Loss &used, Candidate &best, Estimate &estimate, Outcome &outcome) {
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
}

void Fit::run() {
    bool frees = options_.refine && is_free_ && has_heldout_ && image_count_ <= kMaxRefinedImages;
    const Gauge requested = gauge_;
    if (frees) gauge_ = gauge_.by_prior();
    used_ = loss();
    used_.distrusts = true;
    best_ = choose(used_);
    estimate_ = best_.estimate;
    if (has_heldout_) reconsider(all_, used_, estimate_);
    outcome_ = solve(all_, prior_, gauge_, used_, true, control_, estimate_);
    if (frees)
        free_response(requested, used_, best_, estimate_, outcome_);
    else
        take_all();
}

double Fit::worse_than(const Fit &other) const {
    if (!has_heldout_) return 0.0;
    HeldoutLoss own_loss = heldout_loss(other.heldout_, best_.estimate, other.common_),
                other_loss = heldout_loss(other.heldout_, other.best_.estimate, other.common_);
    double error, difference = loss_difference(own_loss, other_loss, error);
    return error > 0.0 ? difference / error : 0.0;
}

void Fit::describe(lensprof_exposure *exposures, lensprof_fit_result &result) {
    Loss last = used_;
    last.noise = estimate_noise(all_, estimate_, used_.noise);
    const Covariance found = covariance(all_, prior_, gauge_, last, estimate_);
    finish({all_, gauge_, estimate_, has_heldout_ ? heldout_ : all_, best_.estimate, has_heldout_, last.noise, found,
            static_cast<uint32_t>(outcome_.iterations), outcome_.converged},
           nullptr, exposures, result);
}

// The part of a profile used as the prior, and the reason reported if the pictures contradict the rest.
struct Part {
    bool response, falloff;
    lensprof_profile_prior verdict;
};
constexpr Part kParts[] = {{true, true, LENSPROF_PROFILE_PRIOR_USED},
                           {false, true, LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED},
                           {true, false, LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED}};

// The profile with a covariance restricted to this part of it; NULL if that contains no information.
std::unique_ptr<lensprof_profile> part_of(const lensprof_profile &profile, const Part &part) {
    auto restricted = std::make_unique<lensprof_profile>(profile);
    const uint32_t n = restricted->covariance_size,
                   modes = lp_covariance_modes(restricted->response, restricted->responses);
    for (uint32_t i = 0; i < n; i++) {
        const bool is_kept = i < modes ? part.response : part.falloff;
        for (uint32_t j = 0; j < n && !is_kept; j++)
            restricted->covariance[i * n + j] = restricted->covariance[j * n + i] = 0.0;
    }
    if (!part.response && !modes) lensprof_response_set_linear(&restricted->response[0]);
    return has_uncertainty(*restricted) ? std::move(restricted) : nullptr;
}

// Distance of the pictures from a profile used as the prior, standard errors.
struct Contradiction {
    double falloff, response, worse, gamma;  // the response's shape, held-out pairs, gamma of the kind of camera

    double distance() const { return std::max(falloff, response); }
    double in_all() const { return std::max(worse, gamma); }
    bool is_significant() const {
        constexpr double kClearly = 3.0, kFarApart = 5.0;
        return worse > kClearly || distance() > kFarApart;
    }
};

// Fits, and if a profile is the prior, also fits without it. If the pictures contradict the profile, tries its falloff
// and its response separately and takes the result that the pictures and the kind of camera contradict less, provided
// that they do not contradict it; otherwise the result without the profile.
class InformedFit {
public:
    InformedFit(const lensprof_fit_options &options, uint32_t image_count, const Fit::Make &make, uint32_t count)
        : options_(options),
          image_count_(image_count),
          make_(make),
          count_(count),
          alone_(options, image_count, make, count, nullptr, 0.0, options.profile ? 0.5 : 1.0) {}

    void run(lensprof_exposure *exposures, lensprof_fit_result &r) {
        alone_.run();
        alone_.describe(exposures, r);
        if (!options_.profile) return;
        const Contradiction all = attempt(kParts[0], exposures, r, r);
        if (!all.is_significant()) return;
        const bool has_both = part_of(*options_.profile, kParts[1]) && part_of(*options_.profile, kParts[2]);
        std::unique_ptr<Output> best;
        Contradiction least{HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
        for (const Part &part : {kParts[1], kParts[2]}) {
            if (!has_both) break;
            auto output = std::make_unique<Output>(r, exposures, image_count_);
            const Contradiction contradiction = attempt(part, output->exposures.data(), r, *output->result);
            if (contradiction.is_significant() || contradiction.in_all() >= least.in_all()) continue;
            least = contradiction;
            best = std::move(output);
        }
        r.profile_prior = LENSPROF_PROFILE_PRIOR_OVERRULED;
        if (best) best->write(r, exposures);
        for_each_verdict(r, [&](auto &verdict) {
            if (verdict.usable) warn(verdict, reason_of(r.profile_prior, all));
        });
    }

private:
    // Stores the fit in `r` if the pictures do not contradict this part of the profile.
    Contradiction attempt(const Part &part, lensprof_exposure *exposures, const lensprof_fit_result &alone,
                          lensprof_fit_result &r) {
        const auto profile = part_of(*options_.profile, part);
        if (!profile) return {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
        Fit informed(options_, image_count_, make_, count_, profile.get(),
                     part.verdict == kParts[0].verdict ? 0.5 : 1.0, 1.0);
        informed.run();
        const Contradiction found{informed.falloff_distance(alone), informed.response_distance(alone),
                                  informed.worse_than(alone_), informed.gamma_distance()};
        if (found.is_significant()) return found;
        informed.describe(exposures, r);
        r.profile_prior = part.verdict;
        return found;
    }

    static Reason reason_of(uint32_t verdict, const Contradiction &all) {
        if (verdict == LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED)
            return {LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED, {all.response, all.worse}};
        if (verdict == LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED)
            return {LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED, {all.falloff, all.worse}};
        return {LENSPROF_REASON_PRIOR_OVERRULED, {all.distance(), all.worse}};
    }

    const lensprof_fit_options &options_;
    uint32_t image_count_;
    const Fit::Make &make_;
    uint32_t count_;
    Fit alone_;
};

void run_fits(const lensprof_fit_options &options, uint32_t image_count, const Fit::Make &make, uint32_t count,
              lensprof_exposure *exposures, lensprof_fit_result &result) {
    Output output(result, exposures, image_count);  // the caller's stay unchanged until all is done
    output.result->profile_prior = LENSPROF_PROFILE_PRIOR_NONE;
    InformedFit(options, image_count, make, count).run(output.exposures.data(), *output.result);
    output.write(result, exposures);
}

}  // namespace

void fit_overlap(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures,
                 lensprof_fit_result &result) {
    auto make = [&](const std::vector<uint32_t> &keep) {
        return make_problem(options, images, image_count, pairs, keep);
    };
    run_fits(options, image_count, make, pair_count, exposures, result);
    resolve_unobserved_response(
        options, image_count,
        [&](const lensprof_fit_options &held, lensprof_exposure *held_exposures, lensprof_fit_result &r) {
            fit_overlap(held, images, image_count, pairs, pair_count, held_exposures, r);
        },
        exposures, result);
}

void fit_radiance(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                  const Tracks &tracks, lensprof_exposure *exposures, lensprof_fit_result &result) {
    auto make = [&](const std::vector<uint32_t> &keep) {
        return make_problem(options, images, image_count, tracks, keep);
    };
    run_fits(options, image_count, make, static_cast<uint32_t>(tracks.tracks.size()), exposures, result);
    resolve_unobserved_response(
        options, image_count,
        [&](const lensprof_fit_options &held, lensprof_exposure *held_exposures, lensprof_fit_result &r) {
            fit_radiance(held, images, image_count, tracks, held_exposures, r);
        },
        exposures, result);
}

Summary transfer_summary(const lensprof_response &response, const lensprof_vignetting vignetting[3],
                         const lensprof_fit_image *images, const lensprof_exposure *exposures, uint32_t image_count,
                         const lensprof_pair *pairs, uint32_t pair_count, int channels) {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    options.channels = static_cast<uint32_t>(channels);
    std::vector<uint32_t> keep(pair_count);
    std::iota(keep.begin(), keep.end(), 0u);
    Problem problem = make_problem(options, images, image_count, pairs, keep);
    problem.vignettings = channels;
    const std::vector<Falloffs> curves(static_cast<size_t>(problem.settings),
                                       {vignetting[0], vignetting[1], vignetting[2]});
    return summarise(residual_levels(problem, estimate_of(response, curves, exposures, image_count, channels)));
}

}  // namespace lensprof
