// Parts of the report of `build` that its JSON object and its table share.
#include "photo/report/falloff.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

bool holds_prior(const lensprof_fit_result &fit) {
    return fit.profile_prior != LENSPROF_PROFILE_PRIOR_NONE && fit.profile_prior != LENSPROF_PROFILE_PRIOR_OVERRULED;
}

bool is_left_out(const BuildReport &report, size_t image) {
    return report.fit.left_out && image < report.quality.size() && !report.quality[image].joined;
}

const lensprof_vignetting &green_falloff(const lensprof_fit_result &fit) {
    return fit.vignetting[green_curve(fit.vignettings)];
}

}  // namespace lensprof
