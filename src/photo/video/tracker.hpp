// Follows corners from frame to frame of a moving camera (pyramidal Lucas-Kanade, Bouguet 2000), and finds the place of
// each by comparison with its surroundings when it was first seen, so that errors do not add up.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// Where a scene point is seen, px of the frame. It lies at an even place near a corner: what is measured there does not
// depend on errors of the corner's position.
struct TrackedPlace {
    uint32_t track;
    float x, y;
    std::array<float, 4> shape;  // by rows: maps offsets in the frame where it was first seen to those in this one
};

// What the tracker finds in a frame.
struct TrackedFrame {
    std::vector<TrackedPlace> places;
    double mean_level = 0.0;  // of the frame, 0..255
    double kept = 1.0;        // share of the places of the frame before that are found again
    size_t found_again = 0;   // their number; 0 after a cut
    double motion = 0.0;      // median movement of places since the frame before, half diagonals
    double travel = 0.0;      // the same since they were first seen
    bool repeats = false;     // the same picture as the frame before
    bool is_blank = false;    // too dark or too bright for corners
    uint32_t side = 1;        // frame pixels per pixel of the reduced frame that is tracked
};

// Holds the last two frames, reduced. Deterministic.
class CornerTracker {
public:
    CornerTracker();
    ~CornerTracker();
    CornerTracker(const CornerTracker &) = delete;
    CornerTracker &operator=(const CornerTracker &) = delete;

    // Whether frames of this size are large enough, 31 pixels of the reduced frame.
    static bool can_follow(uint32_t width, uint32_t height);

    // The next frame, which is large enough: 8 or 16 bit RGB or grey, all of one size. A frame of which few places are
    // found again is a cut: its tracks are all new.
    TrackedFrame add(const Picture &frame);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace lensprof
