// Fits of scenes that no camera model explains well: surfaces that shine, seen from many sides.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/fitting.hpp"

namespace lensprof {

// Fits exposures and white balances of the input's pairs, with the typical response of its kind of camera and no
// falloff: what those correct that know nothing of the camera.
Fitted fit_exposures_only(FitInput input, uint32_t reference, const std::string &item, Progress &progress,
                          std::vector<lensprof_fit_image_quality> *quality);

// Whether pairs that were held out of both fits differ less by the joint result: by the median of what is left, which
// things that shine move less than the mean.
bool is_joint_better(const Fitted &joint, const Fitted &exposures_only);

// Of each pair half the squared difference of its ends, levels of 255 squared, mean over the channels: of the pictures
// as they are, or where `fitted` is not NULL corrected by it to the mean exposure. NaN where an exposure is not known.
std::vector<double> colour_differences(const FitInput &input, const Fitted *fitted);

// The mean of the smallest 90 % of such values: the others may show different things. NaN is passed over.
double colour_variance_of(const std::vector<double> &differences);

// Fits again without the points whose colours differ most between views, until the exposures stay: highlights that lie
// at one place of the frame are taken for falloff and for exposures that drift, and a robust loss does not see them,
// for each is small. `points`: of each pair the scene point; the input and `points` are left
// with the pairs that were fitted.
Fitted fit_matte_points(FitInput &input, std::vector<uint32_t> &points, const Fitted &first, uint32_t reference,
                        const std::string &item, Progress &progress, std::vector<lensprof_fit_image_quality> *quality);

// Adds to the standard errors of exposures and white balances what two halves of the points say: pairs of a point are
// not independent, and residuals of chosen points are smaller than those of all. `points`: of each pair of the input.
// Two fits more, with the modes and curves of `result`.
void add_errors_by_halves(FitInput input, const std::vector<uint32_t> &points, const Fitted &result,
                          const std::string &item, Progress &progress,
                          std::vector<lensprof_fit_image_quality> &quality);

}  // namespace lensprof
