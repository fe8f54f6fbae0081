// Common parts of the methods that alternate between candidates: the pairs or tracks in three parts, the prior of the
// falloff curves, the first short fits, and the choice between candidates by held-out error.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "fit/prior/prior.hpp"
#include "fit/solver/heldout.hpp"
#include "fit/solver/solver.hpp"

namespace lensprof {

class Method {
protected:
    // The problems are set later: `all_` from a method's own data, `train_` and `heldout_` from the split.
    Method(const lensprof_fit_options &options, uint32_t count, uint32_t image_count)
        : options_(options), split_(split_pairs(count, image_count)) {}

    Loss loss() const {
        Loss l;
        l.kind = options_.loss;
        l.huber = options_.huber_levels / 255.0;
        return l;
    }

    // The pairs or tracks used for short first fits.
    const std::vector<uint32_t> &brief_subset() const { return split_.brief.empty() ? split_.all : split_.brief; }

    // The best of short fits from every start, all at one fixed noise level so that their costs are comparable. Use a
    // gauge that leaves gamma open.
    Estimate best_brief_fit(const Problem &problem, Gauge &gauge, const std::function<bool()> &cancelled,
                            std::vector<Estimate> starts) const {
        Control brief;
        brief.max_iterations = std::min(static_cast<int>(options_.max_iterations), 10);
        brief.rounds = 1;
        brief.flat = 1.0;
        brief.cancelled = cancelled;
        size_t best = 0;
        double lowest = 0.0;
        for (size_t i = 0; i < starts.size(); i++) {
            Loss used = loss();
            used.noise = 3.0 / 255.0;
            const double cost = solve(problem, prior_, gauge, used, false, brief, starts[i]).cost;
            if (i > 0 && !(cost < lowest)) continue;
            best = i;
            lowest = cost;
        }
        return starts[best];
    }

    bool is_cancelled(double done) const {
        return options_.progress && options_.progress(done, options_.progress_user) != 0;
    }

    void set_vignettings(int count) {
        for (Problem *p : {&all_, &train_, &heldout_}) p->vignettings = count;
        prior_ = make_prior(options_.prior_weight, count, all_.settings, all_.by_radiance);
    }

    // Whether held-out error may decide between one falloff curve and three.
    bool may_choose_vignettings(bool has_heldout) const {
        return options_.vignettings == 0 && options_.channels == 3 && (options_.free & LENSPROF_FREE_FALLOFF)
               && has_heldout;
    }

    // Chooses one falloff curve per channel if held-out pairs are clearly better for it. set(curves) sets their number;
    // fit() fits a candidate with the current number.
    template <class Candidate, class Set, class FitAgain>
    static void choose_vignettings(Candidate &best, Set set, FitAgain fit) {
        set(3);
        Candidate chromatic = fit();
        if (is_clearly_better(chromatic, best))
            best = chromatic;
        else
            set(1);
    }

    const lensprof_fit_options &options_;
    const Split split_;
    Problem all_, train_, heldout_;
    Prior prior_;
    Loss common_;  // common to all candidates: measures held-out losses
    double done_ = 0.0;
};

}  // namespace lensprof
