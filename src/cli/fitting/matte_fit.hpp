// Fits of scenes that no camera model explains well: glossy surfaces seen from many sides.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/fitting.hpp"

namespace lensprof {

// Fits exposures and white balances of the input's pairs with the typical response of the kind of camera and no
// falloff: the baseline without knowledge of the camera.
Fitted fit_exposures_only(FitInput input, uint32_t reference, const std::string &item, Progress &progress,
                          std::vector<lensprof_fit_image_quality> *quality);

// Whether pairs held out of both fits differ less with the joint result, by the median residual, which glossy objects
// affect less than the mean.
bool is_joint_better(const Fitted &joint, const Fitted &exposures_only);

// Half the squared difference of each pair's ends, levels of 255 squared, mean over the channels: for the pictures as
// they are, or, if `fitted` is not NULL, corrected by it to the mean exposure. NaN if an exposure is unknown.
std::vector<double> colour_differences(const FitInput &input, const Fitted *fitted);

// The mean of the smallest 90 % of these values; the others may show different objects. NaN is skipped.
double colour_variance_of(const std::vector<double> &differences);

// Refits without the points whose colours differ most between views until the exposures are stable: highlights at a
// fixed position in the frame look like falloff and like drifting exposures, and each is too small for a robust loss.
// `points`: the scene point per pair; the input and `points` are reduced to the fitted pairs.
Fitted fit_matte_points(FitInput &input, std::vector<uint32_t> &points, const Fitted &first, uint32_t reference,
                        const std::string &item, Progress &progress, std::vector<lensprof_fit_image_quality> *quality);

// Increases the standard errors of exposures and white balances by the difference between fits of two halves of the
// points: pairs of a point are not independent, and residuals of selected points are smaller than those of all.
// `points`: per pair of the input. Takes two more fits, with the modes and curves of `result`.
void add_errors_by_halves(FitInput input, const std::vector<uint32_t> &points, const Fitted &result,
                          const std::string &item, Progress &progress,
                          std::vector<lensprof_fit_image_quality> &quality);

}  // namespace lensprof
