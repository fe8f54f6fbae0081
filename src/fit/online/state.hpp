// What is kept from frame to frame, in the caller's memory: plain values without addresses.
//
// The exponent common to response, falloff and exposures (fit/prior/gauge.hpp) cancels out in the grey values of
// tracks. Everything here but `Exponent` is in units where the response keeps the position q (core/response.h) it
// starts from: light is L M e with its logarithm divided by gamma. Tracks then determine all of it.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include <lensprof/online.h>

#include "fit/base/constants.hpp"

namespace lensprof {
namespace online {

// What all frames have in common: coefficients of EMoR modes, which are added to the first response, then k1..k3.
constexpr int kModes = LENSPROF_ONLINE_MODES;
constexpr int kGlobals = kModes + 3;
using Globals = Eigen::Matrix<double, kGlobals, 1, Eigen::DontAlign>;
using GlobalMatrix = Eigen::Matrix<double, kGlobals, kGlobals, Eigen::DontAlign>;
using Slope = Eigen::Matrix<float, kGlobals, 1, Eigen::DontAlign>;

// EMoR modes after those of the fit: the errors state what they would change.
constexpr int kOmitted = 8;
using Omitted = Eigen::Matrix<double, kGlobals, kOmitted, Eigen::DontAlign>;
using OmittedSlope = Eigen::Matrix<double, kOmitted, 1>;

constexpr int kMostKeyframes = LENSPROF_ONLINE_KEYFRAMES;
constexpr int32_t kNone = -1;

// A quadratic cost of the globals: (s - mean)' precision (s - mean) / 2, with `weighted` = precision mean.
struct Knowledge {
    GlobalMatrix precision;
    Globals weighted;
};

// Response and falloff, with tables to evaluate them.
struct Camera {
    Globals globals;
    double center[2];
    double table[LENSPROF_RESPONSE_SAMPLES];            // f
    double first[LENSPROF_RESPONSE_SAMPLES];            // f without its modes
    float mode[LENSPROF_RESPONSE_SAMPLES + 1][kModes];  // h of the modes in use, else 0; the last row twice
    float bend[LENSPROF_RESPONSE_SAMPLES];              // second derivative of f by ln x
    int32_t modes;
    int32_t reserved;
};

// A track that the last frames contain.
struct Track {
    uint64_t id;
    uint64_t seen;     // frames added when it was last seen
    float key_xy[2];   // position in the last keyframe that saw it, px
    uint64_t key;      // keyframes kept up to then; 0: none saw it
    int32_t window;    // its number in the window, or kNone
    uint32_t strikes;  // frames in a row that contradict it
    uint64_t checked;  // the last check that found it
};

// ln L of a track in one channel.
struct Light {
    double log_radiance;
    double information;  // inverse variance given the exposures; 0: not known
    Slope slope;         // of ln L by the globals
};

// The exposure of a frame in one channel.
struct Exposed {
    double log_exposure;  // relative to the first frame of the chain
    double chain;         // variance of all that came before
    double own;           // variance by the noise of this frame,
    double tracks;        // and by that of its tracks' radiances
    double step;          // variance of the difference to the frame before
    Globals slope, step_slope;
    double log_step;
};

struct Frame {
    uint64_t number, since, before;
    uint32_t state, used, outliers, unusable, keyframe, reserved;
};

struct Keyframe {
    uint64_t added;  // its ordinal among all frames, from 1
    uint64_t chain;  // and that of its chain
    double known_ev, known_sigma;
    double log_exposure[3];
    double found[3];         // as add() found it, which follows the globals,
    Globals found_slope[3];  // with its slope
    uint32_t first, count;   // its observations in the window
};

// An observation of a keyframe.
struct Sighting {
    int32_t track;  // its number in the window
    int32_t next;   // the sighting of the same track before, or kNone
    uint32_t keyframe;
    float r2, weight;
    float value[3];
};

struct WindowTrack {
    int32_t last;  // its last sighting
    uint32_t count;
    double log_radiance[3];
};

// Sums over known exposures of products of (1, known, a, slope of a): exact to second order when the globals change.
constexpr int kMoments = 3 + kGlobals;
using Moments = Eigen::Matrix<double, kMoments, kMoments, Eigen::DontAlign>;
struct Exponent {
    double log_gamma_sigma;  // before any known exposure; 0: gamma is fixed
    double position;         // q of the response at gamma 1 here
    Moments chain, earlier;  // of this chain; of earlier ones, about the mean of each
    double known;            // number of known exposures
    double chains;           // earlier chains, or stretches of them, that have known exposures
    double noise;            // weighted sum of the variances of a
    double begun;            // variance of the chain at its first known exposure
    uint32_t chain_count;    // known exposures of this one
    uint32_t reserved;
};

struct Layout {
    uint32_t live, table, window_tracks, sightings;  // capacities
    size_t track, light, slot, exposed, frame, sighting, window_track, window_light, keyframe, seen, values,
        bytes;  // offsets
};

struct State {
    uint32_t magic, width, height, channels;
    uint32_t tracks, keyframes, history, reserved;
    double black, white;
    Layout layout;
    Camera camera;
    Knowledge prior;       // of what was dropped, and of what was known to begin with
    GlobalMatrix scatter;  // of the scores of its tracks, plus the first precision
    Omitted omitted;       // what the modes that the fit omits pull on the globals, per standard error of each,
    Omitted moved;         // and how much that moves them: part of the covariance
    double omitted_sigma[kOmitted];
    GlobalMatrix covariance;
    Exponent exponent;
    uint64_t added, lost, chains, kept_keyframes, kept_observations, windows;
    uint64_t checks;
    uint64_t used, outliers;  // observations of tracks that are known
    double noise;             // of a grey value
    double chain[3];          // variance that the chain has collected, per channel
    uint32_t live;            // tracks
    int32_t last, before;     // frames of the history: the last one, and the last with an exposure; kNone
    uint32_t key_count, window_count, sighting_count;
    uint32_t since_key;  // frames
    uint32_t steps;      // of the fit since the window changed
    uint32_t is_still;   // whether another step would change nothing
    uint32_t has_moved;  // whether the globals did since the first window was replayed
    uint32_t unused;
};

// What add() needs of one observation.
struct Seen {
    int32_t slot;  // of the track, or kNone: unknown
    float r2;
    double log_falloff;
    uint32_t place;  // in slots(), of one that is unknown
    uint32_t usable, outlier;
    float value[3], weight;
    uint32_t reserved;
};

// The arrays of a state.
class Memory {
public:
    explicit Memory(State &state) : state_(state) {}
    State &state() const { return state_; }
    const Layout &layout() const { return state_.layout; }
    Track *tracks() const { return at<Track>(layout().track); }
    Light *lights(uint32_t channel) const { return at<Light>(layout().light) + size_t{channel} * layout().live; }
    int32_t *slots() const { return at<int32_t>(layout().slot); }
    Exposed &exposed(int32_t frame, uint32_t channel) const {
        return at<Exposed>(layout().exposed)[static_cast<uint32_t>(frame) * state_.channels + channel];
    }
    Frame &frame(int32_t frame) const { return at<Frame>(layout().frame)[frame]; }
    Sighting *sightings() const { return at<Sighting>(layout().sighting); }
    WindowTrack *window_tracks() const { return at<WindowTrack>(layout().window_track); }
    Light *window_lights(uint32_t channel) const {  // while the window is replayed
        return at<Light>(layout().window_light) + size_t{channel} * layout().window_tracks;
    }
    Keyframe *keyframes() const { return at<Keyframe>(layout().keyframe); }
    Seen *seen() const { return at<Seen>(layout().seen); }
    double *values() const {
        return at<double>(layout().values);
    }  // work space of the size of a frame, and of a window

private:
    template <class T>
    T *at(size_t offset) const {
        return reinterpret_cast<T *>(reinterpret_cast<unsigned char *>(&state_) + offset);
    }
    State &state_;
};

constexpr uint32_t kMagic = 0x314e4f4cu;

// Sizes for valid options.
Layout layout_of(const lensprof_online_options &options);

// Fills memory of that layout.
void begin(const lensprof_online_options &options, State &state);

}  // namespace online
}  // namespace lensprof
