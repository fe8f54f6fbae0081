// The flat field fit from pictures to verdict.
#pragma once

#include "fit/flat/solver.hpp"

namespace lensprof {

// All that a call holds.
struct FlatFit {
    const lensprof_flat_options &options;
    const lensprof_flat_image *images;
    uint32_t count;
    CellGrid grid;
    std::vector<CellPicture> pictures;
    std::vector<Shot> shots;
    std::vector<std::vector<bool>> left_out;  // of every shot: cells of dust
    FlatProblem problem;
    FlatEstimate estimate;
    Eigen::MatrixXd covariance;  // empty when not determined
};

// Throws Cancelled. False when no cell lies between black and white.
bool fit_flat(const lensprof_flat_options &options, const lensprof_flat_image *images, uint32_t count,
              lensprof_flat_result &result);

// Relative residual E / P - 1 of every cell of a shot and channel, less that of the gain grid (may be NULL); NaN where
// there is none. With `dust`, also of the cells left out.
std::vector<double> residual_map(const FlatFit &fit, int shot, int channel, const lensprof_gain_grid *gain, bool dust);

// Looks for small dark places and fills left_out with them and the cells around them, and the result's spots.
void find_spots(FlatFit &fit, lensprof_flat_result &result);

// What the falloff leaves at the same place of all shots, on nodes; false when the cells do not cover the frame.
bool fit_gain_grid(const FlatFit &fit, lensprof_gain_grid &gain);

// Makes it 1 at the centre of M, which is 1 there too.
void normalise_gain_grid(const FlatFit &fit, lensprof_gain_grid &gain);

// Fills everything but the verdict.
void describe_flat(const FlatFit &fit, lensprof_flat_result &result);

// Fills `usable` and `reason`.
void judge_flat(const FlatFit &fit, lensprof_flat_result &result);

}  // namespace lensprof
