// What the pairs of a fit leave, by radius, grey value and place in the frame: the figures of a report.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "cli/fitting/fitting.hpp"
#include "cli/fitting/project.hpp"

namespace lensprof {

// Medians of the relative illuminance that pairs show at the end farther from the centre, given the fitted falloff at
// the nearer one: [{r, m, sigma, count}]; of the images of the reference's setting and camera.
nlohmann::ordered_json falloff_points(const FitInput &input, const Fitted &best, const Project &project);

// Joint histograms of green (or grey) before and after, and residuals by radius, by grey value and over the frame.
nlohmann::ordered_json residual_figures(const FitInput &input, const Fitted &best, const Project &project);

}  // namespace lensprof
