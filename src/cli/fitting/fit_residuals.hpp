// What the pairs of a fit leave, by radius, grey value and place in the frame: the figures of a report.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/fitting/fitting.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// What one end of a pair received, in green or grey.
struct PairEnd {
    double value, r, light;  // light: relative to the scene's at the reference's exposure and the centre
    double attenuation;      // M times the exposure factor
    double across, down;     // place in the frame, 0..1
    uint32_t image;
};
struct PairEnds {
    PairEnd end[2];
};

// Of the pairs between images that joined, within the grey range.
std::vector<PairEnds> ends_of_pairs(const FitInput &input, const Fitted &best, const Scene &scene);

// Medians of the relative illuminance that pairs show at the end farther from the centre, given the fitted falloff at
// the nearer one: [{r, m, sigma, count}]; of the images of the reference's setting and camera.
nlohmann::ordered_json falloff_points(const std::vector<PairEnds> &all, const Fitted &best);

// Joint histograms of green (or grey) before and after, and residuals by radius, by grey value and over the frame.
nlohmann::ordered_json residual_figures(const std::vector<PairEnds> &all, const Fitted &best, const Scene &scene);

}  // namespace lensprof
