// The radiances of one track given everything else, and the residuals of its observations.
//
//   residual  B_xi - f( s_xi L_x ),    s_xi = e_i w_i M(r_xi)                  (Goldman & Chen eq. 2, 3)
//
// for every channel. L is found exactly (it minimises the sum over the track's observations), whereas the paper
// averages g(B)/s (eq. 13) and alternates. A saturated value requires a prediction of at least kWhite, a black one
// of at most kBlack; they cost nothing if this holds.
#pragma once

#include <array>
#include <vector>

#include "fit/problem/loss.hpp"
#include "fit/problem/residual.hpp"
#include "fit/problem/tracks.hpp"

namespace lensprof {

// One observation of a track in one channel, at the track's radiance.
struct Sighting {
    enum class Kind {
        measured,
        at_least,
        at_most,
        unused
    };
    Kind kind;
    double value;     // the grey value, or its bound
    double factor;    // s: irradiance per radiance
    double x;         // irradiance
    double residual;  // 0 if a bound holds
    double by_log;    // d prediction / d ln(s L); 0 if a bound holds
    double weight;    // factor of the squared residual, Huber: less than 1 beyond sigma
};

// A track at an estimate.
struct TrackFit {
    std::vector<std::array<Attenuation, 3>> lens;  // per observation and falloff curve
    std::array<std::vector<Sighting>, 3> channel;
    std::array<double, 3> radiance{};  // 0 if no observation measures it
    int freedom = 0;                   // number of observations that test the radiances
};

// Whether each observation is used: the loss can leave out those that contradict the others of their track.
using Trust = std::vector<uint8_t>;

// Evaluates tracks of a problem at one estimate.
class TrackEvaluator {
public:
    TrackEvaluator(const Problem &problem, const Estimate &estimate, const Loss &loss);

    // trust: for the problem's observations.
    void evaluate(const Range &track, const uint8_t *trust, TrackFit &fit) const;

    // The track's share of the objective, including the cost of observations that are not trusted, and the factor of
    // its squared residuals in the quadratic model.
    double cost(const Range &track, const uint8_t *trust, const TrackFit &fit, double *factor) const;

    // Removes trust from observations if that lowers the cost.
    void distrust(const Range &track, uint8_t *trust) const;

private:
    Sighting sighting(const lensprof_observation &observation, int channel, double attenuation, bool trusted) const;
    void predict(double radiance, std::vector<Sighting> &sightings) const;
    double solve(std::vector<Sighting> &sightings) const;

    const Problem &problem_;
    const Estimate &estimate_;
    const Loss &loss_;
    std::vector<std::array<double, 3>> exposure_;  // e w per image
};

// Trust in the observations of a problem: in all of them, or as found at an estimate.
Trust trust_all(const Problem &problem);
Trust find_trust(const Problem &problem, const Estimate &estimate, const Loss &loss);

// Half the sum of the costs of all tracks: what the solver minimises in addition to the prior.
double radiance_cost(const Problem &problem, const Estimate &estimate, const Loss &loss, const Trust &trust);

// The cost of every track at an estimate.
std::vector<double> track_costs(const Problem &problem, const Estimate &estimate, const Loss &loss, const Trust &trust);

// Calls work(number of a chunk of tracks) for every chunk, on the problem's threads.
void for_each_track_chunk(const Problem &problem, const std::function<void(uint32_t)> &work);

}  // namespace lensprof
