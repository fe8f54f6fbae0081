// Fits of simulations with several lens settings or cameras, with the results of each.
#pragma once

#include "simulated_tracks.hpp"

struct Run : FitRun {
    Run() = default;
    explicit Run(const Simulation &) {}
    lensprof_status fit(const Simulation &s, const lensprof_fit_options &options, lensprof_error *error = nullptr) {
        return fit_into(*this, options, s.fit_images, s.pairs, error);
    }
    lensprof_status fit(const TrackSimulation &s, const lensprof_fit_options &options) {
        return fit_into(*this, options, s.fit_images, s.observations, nullptr);
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
