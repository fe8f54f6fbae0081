// A profile of the same lens, from earlier pictures, as the prior of a fit. It replaces the knowledge about all
// cameras.
#pragma once

#include "fit/prior/prior.hpp"
#include "fit/problem/problem.hpp"

namespace lensprof {

// Whether a valid profile states the uncertainty of anything: by its covariance or, for a refined response (a table),
// by its gamma_sigma.
bool has_uncertainty(const lensprof_profile &profile);

// Whether the covariance of a valid profile is positive semi-definite: no combination of parameters has a variance
// below 0.
bool is_covariance(const lensprof_profile &profile);

class StoredPrior {
public:
    // `profile` is valid and states its uncertainty; at most `most_modes` of its response's modes are used. `problem`
    // defines what is free.
    StoredPrior(const lensprof_profile &profile, const Problem &problem, int most_modes);

    int modes() const {
        return modes_;
    }  // Number of EMoR modes whose coefficients are known; 0 if no response is known.
    int vignettings() const { return vignettings_; }

    // Replaces the part of a prior for `vignettings` falloff curves that the profile knows. If gamma is determined
    // separately (gauge.hpp), the profile's knowledge of gamma is left out.
    void put_into(Prior &prior, int vignettings, double weight, bool is_gamma_open) const;

    // Largest difference between its falloff (green's) and that of a result without it, in combined standard errors.
    double falloff_distance(const lensprof_fit_result &alone) const;

    // The same for the shape of its response, which does not include gamma (gamma_prior.hpp).
    double response_distance(const lensprof_fit_result &alone) const;

    // The profile's knowledge of gamma: from the position of its response within its family (gamma_prior.hpp), and from
    // its falloff, by the gamma for which M^gamma has the same depth.
    bool has_response() const { return response_sigma_ > 0.0; }
    bool has_falloff() const { return falloff_sigma_ > 0.0; }

    // Difference in ln gamma between an estimate and the profile, and its standard error. `by_falloff` receives whether
    // the falloff contributes more than the response.
    double gamma_offset(const Estimate &estimate, double &sigma, bool &by_falloff) const;

    // Its falloff was found together with a response whose gamma was equally uncertain, possibly because of the same
    // prior.
    bool shares_gamma() const { return shares_gamma_; }

private:
    // Indices into the full shared vector here, and the matching entries of a prior.
    struct Places {
        std::vector<int> from, to;
    };
    Places places(int vignettings) const;
    Eigen::MatrixXd precision_of(const std::vector<int> &from, bool is_gamma_open) const;
    double falloff_ratio(const lensprof_vignetting &v) const;
    void take_curve_error(const Problem &problem, const lensprof_profile &profile);
    Estimate estimate_of(const Problem &problem, const lensprof_profile &profile) const;
    void find_gamma_errors(const Problem &problem, const lensprof_profile &profile);

    int modes_ = 0, vignettings_ = 1;
    Eigen::VectorXd mean_ = Eigen::VectorXd::Zero(kOneSetting), gamma_direction_ = Eigen::VectorXd::Zero(kOneSetting);
    Eigen::MatrixXd covariance_ = Eigen::MatrixXd::Zero(kOneSetting, kOneSetting);  // zero if nothing is known
    double response_position_ = 0.0;
    double response_sigma_ = 0.0, falloff_sigma_ = 0.0;  // standard errors of ln gamma; 0 if unknown
    double gamma_covariance_ = 0.0;                      // covariance of the two
    bool shares_gamma_ = false;
};

}  // namespace lensprof
