// The fit of the falloff that a candidate leaves, and its errors.
//
// Least squares of the grey values at both ends of a pair, whose irradiance is unknown (orthogonal regression). d has a
// prior: its slope changes little from ring to ring, by as much as the pictures show.
//
// The variance is the largest of four, per ring, each by leaving out groups of differences that may have a common
// error:
// - areas of the frame in a link;
// - links;
// - pictures. A link is in two of them: their variance less that of links (Aronow, Samii and Assenova 2015, "Cluster-
//   robust variance estimation for dyadic data");
// - grey values, for errors of the response and of values near black and white.
// Added is the variance of what the prior determines.
#pragma once

#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fit/trial/evaluator.hpp"
#include "fit/trial/offset_moments.hpp"
#include "fit/trial/response_error.hpp"
#include "fit/trial/ring_nodes.hpp"

namespace lensprof {

class RingFit {
public:
    RingFit(const TrialPairs &pairs, const TrialModel &model, const ResponseError &response);

    bool is_empty() const { return differences_.empty(); }
    void solve();

    const std::array<size_t, kRings> &ends() const { return ends_; }  // of pairs, per ring
    RingVector nodes() const { return solution_.head<kRings>(); }
    // Of linear functions of the nodes, one per row.
    RingMatrix covariance(const RingMatrix &functions) const;
    // Natural logarithms of the exposures in green, or in grey; 0 for images without pairs.
    std::vector<double> exposures() const;

private:
    using Link = std::pair<uint32_t, uint32_t>;
    using Cell = std::tuple<uint32_t, uint32_t, int, int>;

    // One channel of a pair.
    struct Difference {
        size_t offset;      // of its link and channel
        size_t cell, link;  // groups with common errors; and
        uint32_t image[2];
        uint32_t channel;
        double value[2];     // grey values, of 0..1
        double log_falloff;  // ln M1/M2
        RingVector nodes;    // weights at the first end less those at the second
        double log_light;    // mean ln of irradiance at both ends
        double y, sigma;     // ln of the ratio without the falloff; its error by one level of noise in both
    };

    void add(const TrialPairs &pairs, const lensprof_pair &pair);
    double error_at(const LevelError &shape, const Difference &d, double log_light) const;
    double log_ratio(const Difference &d) const;
    void linearise(Difference &d) const;
    Eigen::VectorXd derivatives(const Difference &d) const;
    Eigen::VectorXd bend_of(int n) const;
    Eigen::MatrixXd prior() const;
    Eigen::MatrixXd inverse() const;
    void step(const std::vector<double> &residuals, double end);
    void solve_with_prior();
    std::vector<double> residual_levels() const;
    void update_bend();
    double common_errors() const;
    size_t level_of(const Difference &d) const;
    template <class GroupsOf>
    Eigen::MatrixXd scatter(size_t groups, GroupsOf groups_of) const;
    Eigen::MatrixXd scatter_of_cells() const;

    const Evaluator evaluator_;
    const ResponseError &response_;
    const size_t pictures_;
    const uint32_t green_;
    const Eigen::Index unknowns_;
    std::vector<Difference> differences_;
    std::map<Link, size_t> link_of_;
    std::map<std::pair<size_t, uint32_t>, size_t> offset_of_;
    std::map<Cell, size_t> cell_of_;
    std::array<size_t, kRings> ends_{};
    std::vector<double> offsets_, weights_, off_;
    Eigen::MatrixXd rows_, normal_;
    Eigen::VectorXd solution_;
    double scale_ = 1.0;   // of the residuals, levels
    double common_ = 1.0;  // factor of their variance, by errors that neighbours share
    double bend_;          // standard deviation of the bends of d
    bool has_solution_ = false;
};

}  // namespace lensprof
