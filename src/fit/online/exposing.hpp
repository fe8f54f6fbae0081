// The exposure of one channel of a frame, from the observations in seen() and what is known of their tracks.
#pragma once

#include "fit/online/camera.hpp"
#include "fit/online/state.hpp"

namespace lensprof {
namespace online {

constexpr uint32_t kFewest = 5;  // tracks that determine an exposure

// The exposure of one channel while it is found.
struct ChannelFit {
    double a = 0.0;
    double weight = 0.0;             // sum of q
    double own = 0.0, tracks = 0.0;  // variances
    double drift = 0.0;              // variance that the chain collects by it
    double scale2 = 1.0;             // squared, of residuals in standard errors; at least 1
    uint32_t used = 0;
    Globals slope = Globals::Zero();
};

struct Residual {
    Prediction at;
    double residual = 0.0;  // grey value
    double variance = 0.0;  // of noise and radiance
    double noise = 0.0;     // of noise alone
    bool counts = false;
};

class Exposing {
public:
    // `lights`: by the slots of seen().
    Exposing(const Memory &memory, uint32_t count, uint32_t channel, Light *lights)
        : memory_(memory), state_(memory.state()), count_(count), channel_(channel), lights_(lights) {}

    // False if too few tracks are known.
    bool find(ChannelFit &fit) const;
    // The measured light of a track, and its derivatives, go into the track.
    void teach(const ChannelFit &fit) const;
    // Marks observations that contradict the fit.
    void mark(const ChannelFit &fit) const;

private:
    double value(uint32_t i) const { return static_cast<double>(memory_.seen()[i].value[channel_]); }
    double weight(uint32_t i) const { return static_cast<double>(memory_.seen()[i].weight); }
    bool is_known(uint32_t i) const {
        const Seen &seen = memory_.seen()[i];
        return seen.usable && seen.slot >= 0 && lights_[seen.slot].information > 0.0;
    }
    bool is_between(double grey) const { return grey > state_.black && grey < state_.white; }
    Residual residual(uint32_t i, double a) const;
    Globals slope_of(uint32_t i, const Prediction &at) const;
    double median_start(uint32_t &count) const;
    double round(ChannelFit &fit) const;
    void scale(ChannelFit &fit) const;
    void measure(ChannelFit &fit) const;
    void measure_drift(ChannelFit &fit) const;

    const Memory &memory_;
    State &state_;
    uint32_t count_, channel_;
    Light *lights_;
};

}  // namespace online
}  // namespace lensprof
