// The gauge gamma: (f, M, e, w) and (f o x^(1/gamma), M^gamma, e^gamma, w^gamma) produce the same pictures. A basis of
// few modes represents some members of that family better than others, so that an unconstrained fit determines gamma by
// accident. Here gamma follows from what is known, the exponents of cameras of the kind and known exposures that
// differ; it is then held while everything else is fitted.
#pragma once

#include <algorithm>
#include <cmath>
#include <set>

#include "fit/prior/gamma_prior.hpp"
#include "fit/prior/prior.hpp"
#include "fit/prior/stored_prior.hpp"
#include "fit/problem/problem.hpp"

namespace lensprof {

// Known exposures are never taken as more accurate than this, EV, because shutters and apertures are not.
constexpr double kKnownSigma = 0.02;

// Known exposures farther off than this, in standard errors, have less weight.
constexpr double kDoubtful = 3.0;

inline double known_sigma(const lensprof_fit_image &image) { return std::max(image.known_ev_sigma, kKnownSigma); }

class Gauge {
public:
    // `stored`: a profile whose gamma is expected instead of that of most cameras; NULL for none. It must outlive this
    // object.
    Gauge(const lensprof_fit_options &options, const Problem &problem, const StoredPrior *stored = nullptr);

    // False if parameters held fixed determine gamma, or if no prior is wanted (the paper's method).
    bool is_open() const { return open_; }

    // The same knowledge without holding gamma to it: for first fits, whose shape must find its own optimum.
    Gauge unconstrained() const;

    // The prior alone, held loosely. Few modes lose shape if they are held to a gamma, above all to one that known
    // exposures ask for, which would also bias the pictures' exposures. A refined response can follow exactly.
    Gauge by_prior() const;

    // Expects the exposures of the reference's component to be equal. For problems without known exposures.
    void expect_equal_exposures() { expects_equal_ = true; }
    bool expects_equal_exposures() const { return expects_equal_; }

    // Moves the estimate along its family to the determined gamma, as well as its modes and falloff can follow.
    void apply_gamma(const Problem &problem, Estimate &estimate);

    // Writes the hold on gamma, and the known exposures, into the prior, linearised at the estimate.
    void renew(const Problem &problem, const Estimate &estimate, Prior &prior);

    lensprof_gamma_from from() const { return from_; }
    // Standard error of ln gamma as it is known; 0 if fixed.
    double target_sigma() const { return sigma_; }
    // The same for the last estimate, with the distance that its modes could not follow.
    double sigma() const { return std::hypot(sigma_, missed_); }
    double slope() const { return slope_; }                // of the estimate's exposures against the known ones
    bool knows() const { return !known_weight_.empty(); }  // whether there are known exposures that can be compared
    bool leaves_out(uint32_t image) const { return known_left_out_.count(image) > 0; }
    double known_offset() const { return known_offset_; }  // common offset of the known exposures, natural logarithm

    // Change of the full shared vector per unit of ln gamma.
    static Eigen::VectorXd direction(const Problem &problem, const Estimate &estimate);

    // Difference between the gammas that the profile and cameras of the kind suggest, in standard errors; 0 without
    // such a profile.
    double contradiction(const Estimate &estimate) const;

    // How unlike the response is to those known to the prior; above 1 it is unusual. 0 if gamma does not come from the
    // prior.
    double oddness() const { return from_ == LENSPROF_GAMMA_PRIOR ? oddness_ : 0.0; }

    // Difference in ln gamma from an estimate to its target; 0 if gamma is not open.
    double distance(const Problem &problem, const Estimate &estimate);

private:
    void compare_known(const Problem &problem, const Estimate &estimate);
    void leave_out(const Problem &problem, const std::vector<double> &off);
    void put_known(const Problem &problem, Prior &prior) const;
    void put_equal(const Problem &problem, const Estimate &estimate, Prior &prior) const;

    double expected(const Problem &problem, const Estimate &estimate, double &sigma, lensprof_gamma_from &from) const;
    double expected_of_kind(const Problem &problem, const Estimate &estimate, double &sigma) const;

    GammaPrior prior_;
    const StoredPrior *stored_;               // a profile that knows gamma; or NULL
    double depth_ = 0.0, depth_sigma_ = 0.0;  // -ln M(1) of most lenses, standard deviation of its logarithm; 0: unused
    lensprof_gamma_from wanted_, from_ = LENSPROF_GAMMA_KNOWN;
    bool open_ = false, is_loose_ = false, expects_equal_ = false;
    double missed_ = 0.0;  // distance of the last estimate from its target
    double sigma_ = 0.0, expected_sigma_ = 0.0, oddness_ = 0.0, slope_ = 1.0, slope_sigma_ = 0.0, known_offset_ = 0.0;
    double scatter_ = 1.0;  // of the known exposures about the estimate's, in their stated standard errors; at least 1
    std::vector<double> known_weight_;   // trust in each known exposure, 0..1
    std::set<uint32_t> known_left_out_;  // images whose known exposures contradict the others
    std::vector<double> level_offset_;   // per image, as known_offset_: the offset of the image's level
};

// Least squares k1..k3 of M^gamma over the frame; changes only those in `free` (LENSPROF_FREE_K1 .. _K3).
void raise_falloff(uint32_t free, double gamma, lensprof_vignetting &v);

// Derivatives of a response's position within its family by each of its coefficients.
Eigen::VectorXd gamma_slope(const Estimate &estimate);

// The estimate with the exponent gamma = exp(log_gamma) applied; a response without modes follows exactly.
Estimate with_exponent(const Problem &problem, const Estimate &estimate, double log_gamma);

}  // namespace lensprof
