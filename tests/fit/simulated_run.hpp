// Fits of simulations with several lens settings or cameras, with the results of each.
#pragma once

#include "simulated_tracks.hpp"

struct Run : FitRun {
    std::vector<lensprof_fit_setting> settings;
    std::vector<lensprof_fit_camera> cameras;

    // Room for `count` settings and cameras.
    explicit Run(const Simulation &s, size_t count = 2) : settings(count), cameras(count) {
        exposures.resize(s.images);
        quality.resize(s.images);
        lensprof_fit_result_init(&result);
        result.image_quality = quality.data();
        for (auto &setting : settings) lensprof_fit_setting_init(&setting);
        for (auto &camera : cameras) lensprof_fit_camera_init(&camera);
        result.settings = settings.data(), result.cameras = cameras.data();
        result.setting_count = result.camera_count = static_cast<uint32_t>(count);
    }

    lensprof_status fit(const Simulation &s, const lensprof_fit_options &options, lensprof_error *error = nullptr) {
        return lensprof_fit_overlap(&options, s.fit_images.data(), s.images, s.pairs.data(),
                                    static_cast<uint32_t>(s.pairs.size()), exposures.data(), &result, error);
    }
    lensprof_status fit(const TrackSimulation &s, const lensprof_fit_options &options) {
        return lensprof_fit_radiance(&options, s.fit_images.data(), s.images, s.observations.data(),
                                     static_cast<uint32_t>(s.observations.size()), exposures.data(), &result, nullptr);
    }
};

// Over the frame, after removing the exponent gamma.
inline double falloff_error(const lensprof_vignetting &found, const lensprof_vignetting &truth, double gamma) {
    double worst = 0.0;
    for (int k = 0; k <= 20; k++) {
        const double r2 = k * k / 400.0, m = lensprof_vignetting_eval(&found, r2, nullptr);
        worst = std::max(worst, std::abs(std::pow(m, 1.0 / gamma) - lensprof_vignetting_eval(&truth, r2, nullptr)));
    }
    return worst;
}
