// The flat field fit, from pictures to verdict.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "falloff/circle.hpp"
#include "fit/flat/solver.hpp"
#include "fit/verdict/finding.hpp"

namespace lensprof {

// The result while it is made.
struct FlatResult : lensprof_flat_result {
    lensprof_flat_image_quality *image_quality = nullptr;  // per picture
    uint32_t odd_shot = 0;                                 // the number of the one that differs most from the others
    Findings verdict;
    double sigma_without_black = 0.0;  // corner_sigma without the error of the black level
};

// The end of the image circle in the frame, or what covers its corners.
struct FlatEdge {
    double radius = 0.0;        // of its circle, or of the nearest dark place; half diagonals, 0: none
    double inner = 0.0;         // up to which there are cells
    double share = 0.0;         // of the frame's cells, left out
    std::vector<bool> outside;  // per cell
    std::optional<lensprof_image_circle> circle;  // the outline, where half of the light is left
    double soft = 0.0;                            // width of the outline beyond that of a sharp one, half diagonals
};

// What the stated black level leaves, per channel: share of white less black.
struct FlatOffset {
    std::array<double, 3> value{}, sigma{};
    bool is_shown = false;  // the pictures determine it better than the options do
};

// One light and falloff, fitted.
struct FlatSolution {
    FlatProblem problem;
    FlatEstimate estimate;
    Eigen::MatrixXd covariance;  // empty if not determined
};

// What a profile holds of the falloff: k1..k3 of the curves and the centre, and their covariance (empty if not
// determined). Where the form of the model is another, they are those nearest to it.
struct HeldFalloff {
    std::array<lensprof_vignetting, 3> curve;
    Eigen::MatrixXd covariance;
    bool is_whole = true;  // else a grid has to carry the rest
    double left = 0.0;     // largest |k1..k3 / M - 1| within the data
};

// r^2 of the outermost corner of a solution's cells, from the centre of its falloff.
double data_reach(const CellGrid &grid, const FlatSolution &solution);

// All data of one call; the solution is the last one.
struct FlatFit : FlatSolution {
    const lensprof_flat_options &options;
    std::vector<lensprof_flat_image> images;  // with their limits
    uint32_t count;
    CellGrid grid;
    std::vector<CellPicture> pictures{};
    std::vector<Shot> shots{};
    std::vector<std::vector<bool>> left_out{};  // per shot: cells with dust
    FlatEdge edge{};
    FlatOffset offset{};
    uint32_t light = LENSPROF_FLAT_LIGHT_PLANE;  // the model in use
    std::optional<FlatSolution> other{};         // if the light was chosen: the fit with the one not chosen,
    double light_ev = 0.0;                       // and its largest difference in a corner
    HeldFalloff held{};
    FlatSteps steps{};
};

// Throws Cancelled. False if no cell lies between black and white.
bool fit_flat(const lensprof_flat_options &options, const lensprof_flat_image *images, uint32_t count,
              FlatResult &result);

// Relative residual E / P - 1 of every cell of a shot and channel, less that of the gain grid (may be NULL); NaN for
// cells without a residual. With `dust`, includes the cells that are left out.
std::vector<double> residual_map(const FlatFit &fit, int shot, int channel, const lensprof_gain_grid *gain, bool dust);

// Estimates the offset from pictures of one pattern of light at different levels, and subtracts it from their cells.
void subtract_offset(FlatFit &fit);

// What an offset of 1 changes of ln M between two places with these grey values, the brighter first.
inline double effect_of_offset(double bright, double dark) { return 1.0 / dark - 1.0 / bright; }

// Looks for a dark surround in a shot, such as the corners outside of an image circle.
FlatEdge find_edge(const CellGrid &grid, int channels, const Shot &shot);

// Fills `held`, and sets where the model's falloff ends.
void hold_falloff(FlatFit &fit);

// M of a channel at a place that the profile's k1..k3 give, over M of the model, continued beyond the data.
double held_ratio(const FlatFit &fit, int channel, double x, double y);

// Coarse residual of the model that all shots have in common, share of the light.
double frame_residual(const FlatFit &fit);

// The same of what the shots do not have in common.
double shot_residual(const FlatFit &fit);

// The largest r^2 of the data up to the corner, where errors are stated.
double corner_r2(const FlatModel &model);

// Looks for small dark spots. Adds their cells and the cells around them to left_out, and fills the result's spots.
void find_spots(FlatFit &fit, FlatResult &result);

// Fits a grid of nodes to what k1..k3 leave: of the model's falloff and, with `residual`, of the light common to all
// shots. False if the cells do not cover the frame within the edge.
bool fit_gain_grid(const FlatFit &fit, bool residual, lensprof_gain_grid &gain);

// Scales the grid to 1 at the centre of M, where M is 1 as well.
void normalise_gain_grid(const FlatFit &fit, lensprof_gain_grid &gain);

// Fills everything except the verdict.
void describe_flat(const FlatFit &fit, FlatResult &result);

// Fills `usable` and `verdict`.
void judge_flat(const FlatFit &fit, FlatResult &result);

}  // namespace lensprof
