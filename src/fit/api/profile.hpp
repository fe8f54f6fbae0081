// Conversion from a result to a profile, shared by overlap fits and flat field fits.
#pragma once

#include <algorithm>
#include <cstdio>
#include <memory>

#include <lensprof/profile.h>

#include "core/profile.h"
#include "fit/base/sized.hpp"

namespace lensprof {

// Copies the curves and covariance of a result, and the provenance entries common to all fits.
template <class Result>
void put_result(const Result &result, const char *method, uint32_t images, lensprof_profile &profile) {
    profile.vignettings = result.vignettings;
    std::copy_n(result.vignetting, 3, profile.vignetting);
    profile.covariance_size = result.covariance_size;
    std::fill(std::begin(profile.covariance), std::end(profile.covariance), 0.0);
    std::copy_n(result.covariance, result.covariance_size * result.covariance_size, profile.covariance);
    lensprof_provenance &p = profile.provenance;
    std::snprintf(p.method, sizeof p.method, "%s", method);
    std::snprintf(p.software, sizeof p.software, "lensprof %s", lensprof_version());
    p.images = images;
    p.heldout_rms = LENSPROF_UNKNOWN;
    p.inlier_share = result.inlier_share;
    p.not_usable = !result.usable;
}

// Calls change(profile) on the caller's profile, converted to this library's struct version.
template <class Change>
lensprof_status change_given_profile(lensprof_profile *given, Change change, lensprof_error *error) {
    if (const char *wrong = lp_sized_wrong(given, LP_FIRST_PROFILE, sizeof *given))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "profile: %s", wrong);
    try {
        auto local = std::make_unique<lensprof_profile>();
        lensprof_profile_init(local.get());
        lp_sized_copy(local.get(), given);
        change(*local);
        lp_sized_copy(given, local.get());
        return LENSPROF_OK;
    } catch (const std::bad_alloc &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "profile: out of memory");
    }
}

}  // namespace lensprof
