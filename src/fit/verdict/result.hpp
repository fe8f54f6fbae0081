// The result of a fit while it is made, with its parts by image, lens setting and camera.
#pragma once

#include <lensprof/fit.h>

#include "fit/verdict/finding.hpp"

namespace lensprof {

// The part of one lens setting. Members are those of lensprof_fit_result, where `pairs` is `setting_pairs`.
struct SettingResult {
    uint32_t images = 0, pairs = 0, usable = 0;
    Findings verdict;
    lensprof_vignetting vignetting[3] = {};
    uint32_t radius_ends[LENSPROF_COVERAGE_BINS] = {};
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX] = {};
    double gamma_direction[LENSPROF_COVARIANCE_MAX] = {};
};

// The part of one camera: how it joins the others, and the members of lensprof_fit_result that belong to its own fit.
struct CameraResult {
    lensprof_fit_camera joint = {};
    lensprof_response response = {};
    uint32_t vignettings = 0, pairs = 0, equalizes = 0, gamma_from = 0;
    uint32_t response_from = 0, profile_prior = 0, covariance_size = 0, converged = 0;
    double gamma_sigma = 0, before_rms = 0, heldout_rms = 0, heldout_median = 0, noise_levels = 0, inlier_share = 0,
           frame_share = 0, image_share = 0, irradiance_spread_ev = 0;
    uint32_t grey_ends[LENSPROF_COVERAGE_BINS] = {};
    uint32_t reference = 0, iterations = 0, model = 0, equal_exposures = 0;
    double falloff_prior_distance = 0, center_prior_distance = 0, error_inflation = 0;
};

// Of the reference's setting and camera, with arrays of the others that belong to the caller of a method.
struct FitResult : lensprof_fit_result {
    lensprof_fit_image_quality *image_quality = nullptr;  // per image
    SettingResult *settings = nullptr;                    // setting_count; NULL: all images have setting 0
    CameraResult *cameras = nullptr;                      // camera_count; NULL: all images have camera 0
    Findings verdict;
};

// Adds a finding to a verdict, that of a result or of one of its lens settings: before (or after) those of its
// severity.
template <class Verdict>
void report_first(Verdict &verdict, const lensprof_finding &finding) {
    add_first(verdict.verdict, finding);
    verdict.usable = is_usable(verdict.verdict);
}

template <class Verdict>
void report_last(Verdict &verdict, const lensprof_finding &finding) {
    add_last(verdict.verdict, finding);
    verdict.usable = is_usable(verdict.verdict);
}

// Calls change(verdict) for the result's verdict and those of its lens settings.
template <class Change>
void for_each_verdict(FitResult &r, Change change) {
    change(r);
    for (uint32_t n = 0; n < r.setting_count; n++)
        if (r.settings[n].images) change(r.settings[n]);
}

inline FitResult empty_result() {
    FitResult result;
    lensprof_fit_result_init(&result);
    lensprof_response_set_linear(&result.response);
    return result;
}

}  // namespace lensprof
