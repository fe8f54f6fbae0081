#include "fit/methods/simpler.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "core/covariance.h"
#include "falloff/rise.hpp"
#include "fit/methods/unconstrained.hpp"
#include "fit/verdict/judge.hpp"
#include "fit/verdict/output.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kLensFlags = LENSPROF_FREE_FALLOFF | LENSPROF_FREE_CENTER;

// Whether a simpler description is possible, and may explain the verdict. Verdicts about single images are about the
// data: the group of images changes first (group.hpp). Few grey values show a falloff, but no response
// (unconstrained.hpp).
bool may_be_simpler(const lensprof_fit_options &options, const FitResult &r) {
    if (!(options.prior_weight > 0.0) || !(options.free & (LENSPROF_FREE_RESPONSE | kLensFlags))) return false;
    switch (first_code(r.verdict)) {
    case LENSPROF_REASON_FEW_INLIERS:
    case LENSPROF_REASON_IMAGE_DISAGREES:
    case LENSPROF_REASON_EXPOSURE_UNCERTAIN:
    case LENSPROF_REASON_FEW_GREYS:
    case LENSPROF_REASON_FEW_PAIRS: return r.usable != 0;
    default: return true;
    }
}

// Whether M of all falloffs that were free is that of a lens, or of a camera that corrects it.
bool is_possible(const lensprof_fit_options &options, FitResult &r) {
    if (!(options.free & LENSPROF_FREE_FALLOFF)) return true;
    bool all = true;
    for_each_verdict(r, [&](const auto &found) {
        for (const lensprof_vignetting &v : found.vignetting) {
            const Course course = course_of(v);
            all = all && course.lowest.m >= kSmallestM && course.highest.m <= kLargestRise;
        }
    });
    return all;
}

// A fit of exposures and white balances with the typical response of the kind, and a given falloff.
class SimplerFit {
public:
    SimplerFit(const FitData &data, const lensprof_vignetting &falloff) : options_(data.options) {
        if (options_.free & LENSPROF_FREE_RESPONSE) {
            if (lensprof_response_set_typical(&response_, options_.camera_kind, nullptr, &gamma_sigma_) != LENSPROF_OK)
                throw std::invalid_argument("unknown kind of camera");
            options_.response = &response_;
        }
        if (options_.free & kLensFlags) options_.vignetting = falloff;
        options_.free = 0;
        options_.refine = 0;
        options_.profile = nullptr;
        fit_ = std::make_unique<OverlapFit>(options_, data.image_count, data.make, data.count, nullptr, 1.0, 1.0);
        fit_->run();
    }
    SimplerFit(const SimplerFit &) = delete;
    SimplerFit &operator=(const SimplerFit &) = delete;

    const OverlapFit &fit() const { return *fit_; }

    void describe(uint32_t image_count, lensprof_fit_model model, lensprof_exposure *exposures, FitResult &r) {
        fit_->describe(exposures, r);
        r.model = model;
        if (gamma_sigma_ > 0.0) state_typical(gamma_sigma_, image_count, exposures, r);
    }

private:
    lensprof_fit_options options_;
    lensprof_response response_;
    double gamma_sigma_ = 0.0;
    std::unique_ptr<OverlapFit> fit_;
};

// Whether the profile holds a falloff that can be used for all pictures.
bool has_falloff(const FitData &data, const FitResult &r) {
    const lensprof_profile *profile = data.options.profile;
    if (!profile || r.setting_count > 1 || profile->vignettings != 1) return false;
    const uint32_t first = lp_covariance_index(lp_covariance_modes(profile->response, profile->responses), 0);
    return first < profile->covariance_size && profile->covariance[first * profile->covariance_size + first] > 0.0;
}

}  // namespace

void prefer_simpler(const FitData &data, const OverlapFit &full, lensprof_exposure *exposures, FitResult &r) {
    r.model = LENSPROF_FIT_MODEL_FULL;
    if (full.is_still() || !may_be_simpler(data.options, r)) return;
    SimplerFit only(data, lensprof_vignetting{});
    const bool is_better = full.predicts_better_than(only.fit()) && full.predicts_better_than_nothing();
    if (is_better && (r.usable || r.equalizes) && is_possible(data.options, r)) return;
    Output simpler(r, exposures, data.image_count);
    FitResult &found = *simpler.result;
    std::unique_ptr<SimplerFit> of_lens;
    if (has_falloff(data, r)) of_lens = std::make_unique<SimplerFit>(data, data.options.profile->vignetting[0]);
    if (of_lens && of_lens->fit().predicts_better_than(only.fit()) && of_lens->fit().predicts_better_than_nothing())
        of_lens->describe(data.image_count, LENSPROF_FIT_MODEL_LENS, simpler.exposures.data(), found);
    else if (only.fit().predicts_better_than_nothing()) {
        only.describe(data.image_count, LENSPROF_FIT_MODEL_EXPOSURES, simpler.exposures.data(), found);
        if (!is_better && r.equalizes) found.equalizes = 1;  // predicts as well as a result that does
    } else
        found.equalizes = 0;
    const Output refused(r, exposures, data.image_count);
    if (found.equalizes) simpler.write(r, exposures);
    r.equalizes = found.equalizes;
    if (!found.equalizes) r.model = LENSPROF_FIT_MODEL_NOTHING;
    const auto keep_verdict = [&](auto &verdict, const auto &before) {
        if (!before.usable) {
            copy_verdict(before, verdict);
            remove_findings(verdict.verdict, [](const auto &finding) {  // of a falloff that is not returned
                return finding.code == LENSPROF_REASON_FEW_IMAGES;
            });
            return;
        }
        // the findings on the result that is returned, except that it has no lens
        remove_findings(verdict.verdict,
                        [](const auto &finding) { return finding.severity == LENSPROF_SEVERITY_REFUSAL; });
        report_first(
            verdict,
            found_by_method(found.equalizes ? LENSPROF_REASON_EXPOSURES_ONLY : LENSPROF_REASON_NOTHING_BETTER, {}));
    };
    for (uint32_t n = 0; n < r.setting_count; n++)
        if (r.settings[n].images) keep_verdict(r.settings[n], refused.settings[n]);
    keep_verdict(r, *refused.result);
}

}  // namespace lensprof
