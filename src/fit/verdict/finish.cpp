#include "fit/verdict/finish.hpp"

#include "fit/verdict/evenness.hpp"
#include "fit/verdict/quality.hpp"
#include "fit/verdict/reason.hpp"

namespace lensprof {

void finish(const Found &found, const std::function<void(lensprof_fit_result &)> &judge_own,
            lensprof_exposure *exposures, lensprof_fit_result &result) {
    lensprof_fit_result r = result;
    r.iterations = found.iterations;
    r.converged = found.converged;
    std::vector<lensprof_fit_image_quality> own(found.problem.image_count);  // the verdict needs it anyway
    if (!r.image_quality) r.image_quality = own.data();
    describe_model(found.problem, found.estimate, r);
    describe_heldout(found.tested, found.train, found.has_heldout, r);
    describe_quality(found.problem, found.gauge, found.noise, found.covariance, found.estimate, r);
    judge(found.problem, found.estimate, r);
    if (r.usable && r.reason_code == LENSPROF_REASON_NONE && found.gauge.oddness() > 1.0)
        warn(r, {LENSPROF_REASON_UNUSUAL_RESPONSE, {found.gauge.oddness(), r.gamma_sigma}});
    if (judge_own) judge_own(r);
    judge_evenness(found, r);
    r.image_quality = result.image_quality;
    write_exposures(found.problem, found.estimate, exposures);
    result = r;
}

}  // namespace lensprof
