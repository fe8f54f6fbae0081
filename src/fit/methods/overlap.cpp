#include "fit/methods/overlap.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

#include "core/covariance.h"
#include "fit/methods/overlap_fit.hpp"
#include "fit/methods/simpler.hpp"
#include "fit/methods/unconstrained.hpp"
#include "fit/verdict/judge.hpp"
#include "fit/verdict/output.hpp"
#include "fit/verdict/quality.hpp"

namespace lensprof {
namespace {

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
    auto restricted = std::make_unique<lensprof_profile>();
    lensprof_profile_init(restricted.get());
    if (lensprof_profile_copy(restricted.get(), &profile) != LENSPROF_OK)
        return nullptr;  // the caller's may be shorter
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
    bool is_significant() const { return worse > kClearlyWorse || distance() > kFarFromPrior; }
};

// Fits, and if a profile is the prior, also fits without it. If the pictures contradict the profile, tries its falloff
// and its response separately and takes the result that the pictures and the kind of camera contradict less, provided
// that they do not contradict it; otherwise the result without the profile.
class InformedFit {
public:
    InformedFit(const lensprof_fit_options &options, uint32_t image_count, const OverlapFit::Make &make, uint32_t count)
        : options_(options),
          image_count_(image_count),
          make_(make),
          count_(count),
          alone_(options, image_count, make, count, nullptr, 0.0, options.profile ? 0.5 : 1.0) {}

    void run(lensprof_exposure *exposures, FitResult &r) {
        run_with_profile(exposures, r);
        prefer_simpler({options_, image_count_, make_, count_}, informed_ ? *informed_ : alone_, exposures, r);
    }

private:
    void run_with_profile(lensprof_exposure *exposures, FitResult &r) {
        alone_.run();
        alone_.describe(exposures, r);
        if (!options_.profile) return;
        const Contradiction all = attempt(kParts[0], exposures, r, r, informed_);
        if (!all.is_significant()) return;
        const bool has_both = part_of(*options_.profile, kParts[1]) && part_of(*options_.profile, kParts[2]);
        std::unique_ptr<Output> best;
        Contradiction least{HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
        for (const Part &part : {kParts[1], kParts[2]}) {
            if (!has_both) break;
            auto output = std::make_unique<Output>(r, exposures, image_count_);
            std::unique_ptr<OverlapFit> informed;
            const Contradiction contradiction = attempt(part, output->exposures.data(), r, *output->result, informed);
            if (contradiction.is_significant() || contradiction.in_all() >= least.in_all()) continue;
            least = contradiction;
            best = std::move(output);
            informed_ = std::move(informed);
        }
        r.profile_prior = LENSPROF_PROFILE_PRIOR_OVERRULED;
        if (best) best->write(r, exposures);
        for_each_verdict(r, [&](auto &verdict) { report_first(verdict, rejection_of(r.profile_prior, all)); });
    }

    // Stores the fit in `r` and `informed` if the pictures do not contradict this part of the profile.
    Contradiction attempt(const Part &part, lensprof_exposure *exposures, const FitResult &alone, FitResult &r,
                          std::unique_ptr<OverlapFit> &informed) {
        const auto profile = part_of(*options_.profile, part);
        if (!profile) return {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL};
        auto fit = std::make_unique<OverlapFit>(options_, image_count_, make_, count_, profile.get(),
                                                part.verdict == kParts[0].verdict ? 0.5 : 1.0, 1.0);
        fit->run();
        const Contradiction found{fit->falloff_distance(alone), fit->response_distance(alone), fit->worse_than(alone_),
                                  fit->gamma_distance()};
        if (found.is_significant()) return found;
        fit->describe(exposures, r);
        informed = std::move(fit);
        r.profile_prior = part.verdict;
        return found;
    }

    static lensprof_finding rejection_of(uint32_t prior, const Contradiction &all) {
        const auto found = [&](lensprof_reason code, double distance) {
            return found_by_method(code, of_values(all.in_all(), distance, all.worse));
        };
        if (prior == LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED)
            return found(LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED, all.response);
        if (prior == LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED)
            return found(LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED, all.falloff);
        return found(LENSPROF_REASON_PRIOR_OVERRULED, all.distance());
    }

    const lensprof_fit_options &options_;
    uint32_t image_count_;
    const OverlapFit::Make &make_;
    uint32_t count_;
    OverlapFit alone_;
    std::unique_ptr<OverlapFit> informed_;  // with the part of the profile that is used
};

void run_fits(const lensprof_fit_options &options, uint32_t image_count, const OverlapFit::Make &make, uint32_t count,
              lensprof_exposure *exposures, FitResult &result) {
    Output output(result, exposures, image_count);  // the caller's stay unchanged until all is done
    output.result->profile_prior = LENSPROF_PROFILE_PRIOR_NONE;
    InformedFit(options, image_count, make, count).run(output.exposures.data(), *output.result);
    output.write(result, exposures);
}

}  // namespace

void fit_overlap(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures, FitResult &result) {
    auto make = [&](const lensprof_fit_options &of_fit, const std::vector<uint32_t> &keep) {
        return make_problem(of_fit, images, image_count, pairs, keep);
    };
    run_fits(options, image_count, make, pair_count, exposures, result);
    resolve_unobserved_response(
        options, image_count,
        [&](const lensprof_fit_options &held, lensprof_exposure *held_exposures, FitResult &r) {
            fit_overlap(held, images, image_count, pairs, pair_count, held_exposures, r);
        },
        exposures, result);
}

void fit_radiance(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                  const Tracks &tracks, lensprof_exposure *exposures, FitResult &result) {
    auto make = [&](const lensprof_fit_options &of_fit, const std::vector<uint32_t> &keep) {
        return make_problem(of_fit, images, image_count, tracks, keep);
    };
    run_fits(options, image_count, make, static_cast<uint32_t>(tracks.tracks.size()), exposures, result);
    resolve_unobserved_response(
        options, image_count,
        [&](const lensprof_fit_options &held, lensprof_exposure *held_exposures, FitResult &r) {
            fit_radiance(held, images, image_count, tracks, held_exposures, r);
        },
        exposures, result);
}

std::vector<double> transfer_levels(const lensprof_response &response, const std::vector<Falloffs> &falloffs,
                                    const std::vector<lensprof_fit_image> &images, const lensprof_exposure *exposures,
                                    const std::vector<lensprof_pair> &pairs, int channels) {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    options.channels = static_cast<uint32_t>(channels);
    std::vector<uint32_t> keep(pairs.size());
    std::iota(keep.begin(), keep.end(), 0u);
    const auto image_count = static_cast<uint32_t>(images.size());
    Problem problem = make_problem(options, images.data(), image_count, pairs.data(), keep);
    problem.vignettings = channels;
    std::vector<Falloffs> curves;
    for (const uint32_t setting : problem.setting_number) curves.push_back(falloffs[setting]);
    return residual_levels(problem, estimate_of(response, curves, exposures, image_count, channels));
}

}  // namespace lensprof
