// The gauge gamma: (f, M, e, w) and (f o x^(1/gamma), M^gamma, e^gamma, w^gamma) make the same pictures.
//
// A basis of few modes represents some members of that family better than others, so that a fit left to itself settles
// gamma by accident. Here it is settled by what is known - the exponents of cameras of the kind, and known exposures
// that differ - and then held while everything else is fitted.
#pragma once

#include <algorithm>
#include <set>

#include "fit/prior/gamma_prior.hpp"
#include "fit/prior/prior.hpp"
#include "fit/prior/stored_prior.hpp"
#include "fit/problem/problem.hpp"

namespace lensprof {

// Known exposures are not taken to be better than this, EV: shutters and apertures are not.
constexpr double kKnownSigma = 0.02;

inline double known_sigma(const lensprof_fit_image &image) { return std::max(image.known_ev_sigma, kKnownSigma); }

class Gauge {
public:
    // `stored` (NULL where there is none, else it outlives this): a profile whose gamma is expected in place of that of
    // most cameras.
    Gauge(const lensprof_fit_options &options, const Problem &problem, const StoredPrior *stored = nullptr);

    // False where parameters held fixed settle gamma, or where no prior is wanted (the paper's method).
    bool is_open() const { return open_; }

    // The same knowledge, which nothing holds gamma to: for first fits, whose shape is to find its own optimum.
    Gauge unheld() const;

    // The prior alone, loosely: few modes lose shape where they are held to a gamma, and all the more to any that known
    // exposures may ask for, which would draw the pictures' exposures along. A refined response can follow exactly.
    Gauge by_prior() const;

    // Moves the estimate along its family to where gamma is settled, as well as its modes and falloff can follow.
    void settle(const Problem &problem, Estimate &estimate);

    // Writes what holds gamma, and the known exposures, into the prior, linearised at the estimate.
    void renew(const Problem &problem, const Estimate &estimate, Prior &prior);

    lensprof_gamma_from from() const { return from_; }
    double sigma() const { return sigma_; }                // standard error of ln gamma; 0 when known
    double slope() const { return slope_; }                // of the estimate's exposures on the known ones
    bool knows() const { return !known_weight_.empty(); }  // of exposures that can be compared
    bool leaves_out(uint32_t image) const { return known_left_out_.count(image) > 0; }
    double known_offset() const { return known_offset_; }  // common offset of the known exposures, natural logarithm

    // Change of the full shared vector per unit of ln gamma.
    static Eigen::VectorXd direction(const Problem &problem, const Estimate &estimate);

    // How far apart the profile and cameras of the kind want gamma, in standard errors; 0 without such a profile.
    double contradiction(const Estimate &estimate) const;

    // By how much the response is unlike those that the prior knows; beyond 1 it is unusual. 0 where the prior is not
    // what settled gamma.
    double oddness() const { return from_ == LENSPROF_GAMMA_PRIOR ? oddness_ : 0.0; }

    // ln gamma by which an estimate is away from where it is to be; 0 where nothing is open.
    double distance(const Problem &problem, const Estimate &estimate);

private:
    void compare_known(const Problem &problem, const Estimate &estimate);
    void leave_out(const Problem &problem, const std::vector<double> &off);
    void put_known(const Problem &problem, Prior &prior) const;

    double expected(const Estimate &estimate, double &sigma, lensprof_gamma_from &from) const;

    GammaPrior prior_;
    const StoredPrior *stored_;  // of a profile that says something of gamma; or NULL
    lensprof_gamma_from wanted_, from_ = LENSPROF_GAMMA_KNOWN;
    bool open_ = false, is_loose_ = false;
    double sigma_ = 0.0, expected_sigma_ = 0.0, oddness_ = 0.0, slope_ = 1.0, slope_sigma_ = 0.0, known_offset_ = 0.0;
    double scatter_ = 1.0;  // of the known exposures about the estimate's, in their stated standard errors; 1 at least
    std::vector<double> known_weight_;   // trust in each known exposure, 0..1
    std::set<uint32_t> known_left_out_;  // images whose known exposures contradict those of the others
    std::vector<double> level_offset_;   // of each image, as known_offset_: that of the level it is on
};

// Least squares k1..k3 of M^gamma over the frame, those that `free` names (LENSPROF_FREE_K1 .. _K3).
void raise_falloff(uint32_t free, double gamma, lensprof_vignetting &v);

// Change of a response's position within its family for each of its coefficients.
Eigen::VectorXd gamma_slope(const Estimate &estimate);

// The same estimate with the exponent gamma = exp(log_gamma) put in; a response without modes follows exactly.
Estimate with_exponent(const Problem &problem, const Estimate &estimate, double log_gamma);

}  // namespace lensprof
