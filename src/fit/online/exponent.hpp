// The exponent common to response, falloff and exposures, from known exposures and what was known before.
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

struct Gamma {
    double log_gamma;  // relative to the first response
    double variance;   // of it at given globals
    Globals slope;     // of it by the globals
    double scatter;    // of known exposures, in their standard errors; 0: too few
};

// Adds a known exposure, EV, of a frame in the present chain.
void add_known(double ev, double sigma, const Exposed &exposed, Exponent &exponent);

// Ends the chain: the offset of known exposures to later ones is another.
void end_chain(Exponent &exponent);

// Follows a step of the globals.
void follow(const Globals &step, Exponent &exponent);

Gamma gamma_of(const Exponent &exponent);

// Variance of gamma a, if `own` is that of a at given globals and `slope` its derivative by them.
double raised_variance(const Gamma &gamma, const GlobalMatrix &covariance, double a, double own, const Globals &slope);

}  // namespace online
}  // namespace lensprof
