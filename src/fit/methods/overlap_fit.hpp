// One fit of all pairs or tracks: start, number of modes and of falloff curves by held-out error, final estimate.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "fit/methods/lens_weight.hpp"
#include "fit/methods/method.hpp"
#include "fit/prior/stored_prior.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

// A fit to the training data.
struct Candidate : HeldoutLoss {
    Estimate estimate;
};

class OverlapFit : Method {
    static constexpr int kStartModes = 5;               // enough to distinguish the starts
    static constexpr uint32_t kEnoughForModes = 20000;  // pairs, if there are more to refine the response

public:
    // make(options, keep): the problem with a subset of `count` pairs or tracks.
    using Make = std::function<Problem(const lensprof_fit_options &options, const std::vector<uint32_t> &keep)>;

    // `profile`: that of the options, or NULL for a fit without it. Progress goes from `from` to `to`.
    OverlapFit(const lensprof_fit_options &options, uint32_t image_count, Make make, uint32_t count,
               const lensprof_profile *profile, double from, double to)
        : Method(options, count, image_count),
          image_count_(image_count),
          problem_(std::move(make)),
          step_(options.refine ? 1 + count / kEnoughForModes : 1),
          stored_(stored_prior(options, profile, all_ = problem_(options, thinned(split_.all)))),
          gauge_(options, all_, stored_.get()) {
        if (split_.has_heldout()) heldout_ = problem_(options, thinned(split_.heldout));
        has_heldout_ = heldout_.pairs.size() >= kMinHeldout;
        train_ = problem_(options, thinned(has_heldout_ ? split_.train : split_.all));
        control_.max_iterations = static_cast<int>(options.max_iterations);
        control_.cancelled = [this, from, to] { return is_cancelled(from + (to - from) * done_); };
    }

    void run();

    // Increase of the held-out loss compared with a fit without the profile, in standard errors; 0 without held-out
    // pairs.
    double worse_than(const OverlapFit &other) const;

    bool is_still() const { return is_static(all_); }

    // Whether held-out pairs are better predicted, by more than two standard errors.
    bool predicts_better_than(const OverlapFit &simpler) const;
    bool predicts_better_than_nothing() const;

    double falloff_distance(const FitResult &alone) const { return stored_->falloff_distance(alone); }
    double response_distance(const FitResult &alone) const { return stored_->response_distance(alone); }
    double gamma_distance() const { return gauge_.contradiction(found_.estimate); }

    void describe(lensprof_exposure *exposures, FitResult &result);

private:
    struct Fitted {
        Candidate best;     // of the training pairs
        Estimate estimate;  // of all
        Loss used;
        Outcome outcome;
    };
    // What a fit under another assumption changes, restored if the pictures reject it.
    struct State {
        Fitted found;
        Gauge gauge;
        std::vector<WeighedLens> lenses;
        bool falls;
    };
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
        for (size_t s = 0; s < lenses_.size(); s++) set_lens(lenses_[s].knowledge, count, static_cast<int>(s), prior_);
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
    bool frees_lens() const { return options_.free & (LENSPROF_FREE_FALLOFF | LENSPROF_FREE_CENTER); }
    void weigh_lens_knowledge();
    void solve_again();
    State state() const { return {found_, gauge_, lenses_, control_.falls}; }
    void restore(const State &state);
    bool exposures_clearly_differ(double limit);
    void hold_equal_exposures();
    void free_center();
    void hold_falling();
    const Problem &tested() const;
    HeldoutLoss loss_of(const OverlapFit &other) const;
    bool predicts_better(const HeldoutLoss &simpler) const;
    void resolve_dark_end(Loss &used, Candidate &best, Estimate &estimate);
    void free_response(const Gauge &requested, Loss &used, Candidate &best, Estimate &estimate, Outcome &outcome);

    uint32_t image_count_;
    const Make problem_;
    size_t step_;  // only every so manieth pair is used until the response is refined
    bool has_heldout_ = false;
    const bool is_free_ = (options_.free & LENSPROF_FREE_RESPONSE) && options_.modes != 0;  // the response
    std::unique_ptr<StoredPrior> stored_;
    Gauge gauge_;
    Fitted found_;
    Control control_;
    Inflation inflation_{1};
    std::vector<WeighedLens> lenses_;  // per setting, once weighed
};

}  // namespace lensprof
