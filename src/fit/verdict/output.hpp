// The output of a fit with its own storage, for trying several fits before one is copied to the caller's.
#pragma once

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

#include <lensprof/fit.h>

#include "fit/verdict/result.hpp"

namespace lensprof {

// Copies the verdict of a result, or of one of its lens settings.
template <class From, class To>
void copy_verdict(const From &from, To &to) {
    to.usable = from.usable;
    to.verdict = from.verdict;
}

// Copies the fields that a result and each of its lens settings share: the verdict, and the numbers of one setting.
template <class From, class To>
void copy_setting(const From &from, To &to) {
    copy_verdict(from, to);
    std::copy(std::begin(from.vignetting), std::end(from.vignetting), to.vignetting);
    std::copy(std::begin(from.radius_ends), std::end(from.radius_ends), to.radius_ends);
    std::copy(std::begin(from.covariance), std::end(from.covariance), to.covariance);
    std::copy(std::begin(from.gamma_direction), std::end(from.gamma_direction), to.gamma_direction);
}

// Copies the fields that a result and each of its cameras share.
template <class From, class To>
void copy_camera(const From &from, To &to) {
    to.response = from.response;
    to.vignettings = from.vignettings, to.pairs = from.pairs, to.equalizes = from.equalizes,
    to.gamma_from = from.gamma_from;
    to.response_from = from.response_from, to.profile_prior = from.profile_prior;
    to.covariance_size = from.covariance_size, to.converged = from.converged;
    to.gamma_sigma = from.gamma_sigma;
    to.before_rms = from.before_rms, to.heldout_rms = from.heldout_rms, to.heldout_median = from.heldout_median;
    to.noise_levels = from.noise_levels, to.inlier_share = from.inlier_share;
    to.frame_share = from.frame_share, to.image_share = from.image_share,
    to.irradiance_spread_ev = from.irradiance_spread_ev;
    std::copy(std::begin(from.grey_ends), std::end(from.grey_ends), to.grey_ends);
    to.reference = from.reference;
    to.iterations = from.iterations, to.model = from.model, to.equal_exposures = from.equal_exposures;
    to.falloff_prior_distance = from.falloff_prior_distance, to.center_prior_distance = from.center_prior_distance;
    to.error_inflation = from.error_inflation;
}

struct Output {
    std::unique_ptr<FitResult> result;
    std::vector<lensprof_exposure> exposures;
    std::vector<lensprof_fit_image_quality> quality;
    std::vector<SettingResult> settings;

    // Starts with the contents of the caller's result.
    Output(const FitResult &given, const lensprof_exposure *given_exposures, uint32_t image_count)
        : result(std::make_unique<FitResult>(given)),
          exposures(given_exposures, given_exposures + image_count),
          quality(image_count),
          settings(given.settings, given.settings + given.setting_count) {
        if (given.image_quality) std::copy_n(given.image_quality, image_count, quality.begin());
        result->image_quality = quality.data();
        result->settings = settings.empty() ? nullptr : settings.data();
    }

    void write(FitResult &to, lensprof_exposure *to_exposures) const {
        lensprof_fit_image_quality *to_quality = to.image_quality;
        SettingResult *to_settings = to.settings;
        to = *result;
        to.image_quality = to_quality;
        to.settings = to_settings;
        if (to_quality) std::copy(quality.begin(), quality.end(), to_quality);
        std::copy(settings.begin(), settings.end(), to_settings);
        std::copy(exposures.begin(), exposures.end(), to_exposures);
    }
};

}  // namespace lensprof
