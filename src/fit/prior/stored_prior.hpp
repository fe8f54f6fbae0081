// A profile of the same lens, from earlier pictures, as the prior of a fit: in place of what is known of all cameras.
#pragma once

#include "fit/prior/prior.hpp"
#include "fit/problem/problem.hpp"

namespace lensprof {

// Whether the covariance of a valid profile is one: no combination of parameters has a variance below 0.
bool is_covariance(const lensprof_profile &profile);

class StoredPrior {
public:
    // `profile` is valid and has a covariance; at most `most_modes` of its response's modes are of use. `problem` tells
    // what is free.
    StoredPrior(const lensprof_profile &profile, const Problem &problem, int most_modes);

    int modes() const { return modes_; }  // EMoR modes whose coefficients are known; 0: no response is
    int vignettings() const { return vignettings_; }

    // Replaces what the profile knows in a prior for so many falloff curves. What it knows of gamma is not there: gamma
    // is settled apart (gauge.hpp).
    void put_into(Prior &prior, int vignettings, double weight) const;

    // Largest difference of its falloff (green's) from that of a result without it, in standard errors of both
    // together.
    double falloff_distance(const lensprof_fit_result &alone) const;

    // Position of its response within its family (gamma_prior.hpp), and the standard error; 0 where none is known.
    double gamma_position() const { return gamma_position_; }
    double gamma_sigma() const { return gamma_sigma_; }

private:
    // Entries of the full shared vector here, and those of a prior that they are for.
    struct Places {
        std::vector<int> from, to;
    };
    Places places(int vignettings) const;
    Eigen::MatrixXd precision_of(const std::vector<int> &from) const;
    void settle_gamma(const Problem &problem, const lensprof_profile &profile);

    int modes_ = 0, vignettings_ = 1;
    Eigen::VectorXd mean_ = Eigen::VectorXd::Zero(kMaxShared), gamma_direction_ = Eigen::VectorXd::Zero(kMaxShared);
    Eigen::MatrixXd covariance_ = Eigen::MatrixXd::Zero(kMaxShared, kMaxShared);  // zero where nothing is known
    double gamma_position_ = 0.0, gamma_sigma_ = 0.0;
};

}  // namespace lensprof
