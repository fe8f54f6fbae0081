// Equation 14 as a robust weighted least squares problem: Levenberg-Marquardt, noise, covariance.
#pragma once

#include "fit/flat/model.hpp"

namespace lensprof {

// A cell of a shot that is used in the fit.
struct FlatCell {
    int shot, cell;
    double x, y;                            // px of the frame
    std::array<double, 3> value, variance;  // E and the variance of its noise
};

// Gaussian prior on the unknowns: (u - mean)' precision (u - mean) / 2.
struct FlatPrior {
    Eigen::VectorXd mean;
    Eigen::MatrixXd precision;
};
FlatPrior make_flat_prior(const lensprof_flat_options &options, const FlatModel &model);

struct FlatProblem {
    FlatModel model;
    FlatPrior prior;
    std::vector<int> free;  // unknowns that are estimated
    std::vector<FlatCell> cells;
};

struct FlatEstimate {
    Eigen::VectorXd u;
    double unevenness = 0.0;  // relative standard deviation of a cell beyond its noise
    double inflation = 1.0;   // variance of the residuals' sums over blocks of cells, relative to independent cells
    double scale = 1.0;       // ratio of the residuals to what noise and unevenness predict
    uint32_t iterations = 0;
    bool converged = false;
};

// Steps that the solutions of one fit may still take. Pictures that one lens and one light describe need few; those
// that contradict each other creep for hundreds, form by form, to a fit that is refused.
struct FlatSteps {
    int left = 1200;  // good cards of tests/bench take up to 345, of falloffs of 5 stops that are off centre 829

    bool are_over() const { return left <= 0; }
};

// Indices of the unknowns that are estimated: those of the lens that `free` (LENSPROF_FREE_...) includes, and all
// others.
std::vector<int> free_unknowns(const FlatModel &model, uint32_t free);

// Start values: k = 0 (or the held values; a logarithm fitted to the cells), even light and the levels of the cells.
Eigen::VectorXd flat_start(const FlatProblem &problem, const lensprof_vignetting &given);

// Sum of squared residuals of each cell, in units of scale^2: chi-squared, one degree of freedom per channel.
std::vector<double> flat_chi2(const FlatProblem &problem, const FlatEstimate &estimate);

// The objective of all cells and the prior, for the noise that the estimate states: half of chi-squared.
double flat_cost(const FlatProblem &problem, const FlatEstimate &estimate);

// Neighbouring cells whose residuals are correlated count as fewer cells. The weight of the cells against the prior and
// in the covariance is divided by the inflation: how much more their sums over blocks of 4 to 32 cells per side vary
// than those of independent cells.
void solve_flat(const FlatProblem &problem, FlatEstimate &estimate, FlatSteps &steps);

// The same from values that are near the solution, with the centre free.
void refine_flat(const FlatProblem &problem, FlatEstimate &estimate, FlatSteps &steps);

// Covariance of all unknowns, zero for held ones. Empty if the cells do not determine every free unknown.
Eigen::MatrixXd flat_covariance(const FlatProblem &problem, const FlatEstimate &estimate);

}  // namespace lensprof
