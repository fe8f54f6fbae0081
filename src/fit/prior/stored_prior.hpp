// A profile of the same lens, from earlier pictures, as the prior of a fit: in place of what is known of all cameras.
#pragma once

#include "fit/prior/prior.hpp"
#include "fit/problem/problem.hpp"

namespace lensprof {

// Whether a valid profile says how sure it is of anything: by its covariance, or by the gamma_sigma of a refined
// response, which is a table.
bool says_how_sure(const lensprof_profile &profile);

// Whether the covariance of a valid profile is one: no combination of parameters has a variance below 0.
bool is_covariance(const lensprof_profile &profile);

class StoredPrior {
public:
    // `profile` is valid and says how sure it is; at most `most_modes` of its response's modes are of use. `problem`
    // tells what is free.
    StoredPrior(const lensprof_profile &profile, const Problem &problem, int most_modes);

    int modes() const { return modes_; }  // EMoR modes whose coefficients are known; 0: no response is
    int vignettings() const { return vignettings_; }

    // Replaces what the profile knows in a prior for so many falloff curves. Where gamma is settled apart (gauge.hpp),
    // what the profile knows of it is not there.
    void put_into(Prior &prior, int vignettings, double weight, bool settles_gamma) const;

    // Largest difference of its falloff (green's) from that of a result without it, in standard errors of both
    // together.
    double falloff_distance(const lensprof_fit_result &alone) const;

    // That of its response's shape, which has no gamma (gamma_prior.hpp).
    double response_distance(const lensprof_fit_result &alone) const;

    // What it says of gamma: by the position of its response within its family (gamma_prior.hpp), and by its falloff,
    // as M^gamma is as deep as it.
    bool has_response() const { return response_sigma_ > 0.0; }
    bool has_falloff() const { return falloff_sigma_ > 0.0; }

    // ln gamma by which an estimate is away from what it says, and the standard error of that. Response and falloff are
    // told apart: `by_falloff` receives whether the falloff says more.
    double gamma_offset(const Estimate &estimate, double &sigma, bool &by_falloff) const;

    // Its falloff was found together with a response whose gamma was as uncertain: by a prior that may be the same.
    bool shares_gamma() const { return shares_gamma_; }

private:
    // Entries of the full shared vector here, and those of a prior that they are for.
    struct Places {
        std::vector<int> from, to;
    };
    Places places(int vignettings) const;
    Eigen::MatrixXd precision_of(const std::vector<int> &from, bool settles_gamma) const;
    double falloff_ratio(const lensprof_vignetting &v) const;
    void take_curve_error(const Problem &problem, const lensprof_profile &profile);
    Estimate estimate_of(const Problem &problem, const lensprof_profile &profile) const;
    void settle_gamma(const Problem &problem, const lensprof_profile &profile);

    int modes_ = 0, vignettings_ = 1;
    Eigen::VectorXd mean_ = Eigen::VectorXd::Zero(kOneSetting), gamma_direction_ = Eigen::VectorXd::Zero(kOneSetting);
    Eigen::MatrixXd covariance_ = Eigen::MatrixXd::Zero(kOneSetting, kOneSetting);  // zero where nothing is known
    double response_position_ = 0.0;
    double response_sigma_ = 0.0, falloff_sigma_ = 0.0;  // standard errors of ln gamma; 0 where it says nothing
    double gamma_covariance_ = 0.0;                      // of the two
    bool shares_gamma_ = false;
};

}  // namespace lensprof
