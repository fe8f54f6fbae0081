// The flat field fit, from pictures to verdict.
#pragma once

#include "fit/flat/solver.hpp"
#include "fit/verdict/finding.hpp"

namespace lensprof {

// The result while it is made.
struct FlatResult : lensprof_flat_result {
    lensprof_flat_image_quality *image_quality = nullptr;  // per picture
    Findings verdict;
};

// All data of one call.
struct FlatFit {
    const lensprof_flat_options &options;
    const lensprof_flat_image *images;
    uint32_t count;
    CellGrid grid;
    std::vector<CellPicture> pictures;
    std::vector<Shot> shots;
    std::vector<std::vector<bool>> left_out;  // per shot: cells with dust
    FlatProblem problem;
    FlatEstimate estimate;
    Eigen::MatrixXd covariance;  // empty if not determined
};

// Throws Cancelled. False if no cell lies between black and white.
bool fit_flat(const lensprof_flat_options &options, const lensprof_flat_image *images, uint32_t count,
              FlatResult &result);

// Relative residual E / P - 1 of every cell of a shot and channel, less that of the gain grid (may be NULL); NaN for
// cells without a residual. With `dust`, includes the cells that are left out.
std::vector<double> residual_map(const FlatFit &fit, int shot, int channel, const lensprof_gain_grid *gain, bool dust);

// Looks for small dark spots. Adds their cells and the cells around them to left_out, and fills the result's spots.
void find_spots(FlatFit &fit, FlatResult &result);

// Fits a grid of nodes to the residual of the falloff common to all shots; false if the cells do not cover the frame.
bool fit_gain_grid(const FlatFit &fit, lensprof_gain_grid &gain);

// Scales the grid to 1 at the centre of M, where M is 1 as well.
void normalise_gain_grid(const FlatFit &fit, lensprof_gain_grid &gain);

// Fills everything except the verdict.
void describe_flat(const FlatFit &fit, FlatResult &result);

// Fills `usable` and `verdict`.
void judge_flat(const FlatFit &fit, FlatResult &result);

}  // namespace lensprof
