// A Gauss-Newton step for the globals over the window: the cost of radiances and exposures at their best is a quadratic
// function of the globals alone (Schur complement).
#pragma once

#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

using Exposures = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostKeyframes, 1>;
using ExposureMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostKeyframes, kMostKeyframes>;
using MixedMatrix = Eigen::Matrix<double, Eigen::Dynamic, kGlobals, 0, kMostKeyframes, kGlobals>;

// Normal equations of one channel, without radiances.
struct ChannelEquations {
    ExposureMatrix exposures;  // precision, and its inverse once eliminated
    MixedMatrix mixed;
    Exposures pull;
    GlobalMatrix globals;
    Globals global_pull;
};

// Of a window at the present camera, exposures and radiances. The radiances are brought to their best.
class Window {
public:
    explicit Window(const Memory &memory);

    // What the window knows of the globals: precision, and precision times their change.
    GlobalMatrix precision() const { return precision_; }
    Globals pull() const { return pull_; }

    // Follows a step of the globals with the exposures.
    void move_exposures(const Globals &step) const;

    // What modes that the fit omits pull on the globals, per standard error of each.
    Omitted omitted() const;

    // Sum over tracks of the squares of their pulls on the globals: the scatter of the total, whatever the noise.
    GlobalMatrix scatter(const GlobalMatrix &inverse) const;

private:
    void weigh();
    void add_channel(uint32_t channel);

    const Memory &memory_;
    int keyframes_;
    double noise_;
    ChannelEquations channels_[3];
    GlobalMatrix precision_;
    Globals pull_;
};

}  // namespace online
}  // namespace lensprof
