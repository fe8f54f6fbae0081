// Whether the camera of a clip stands still, from its first seconds.
#pragma once

#include <vector>

#include "photo/clip/frame_source.hpp"
#include "photo/video/tracker.hpp"

namespace lensprof {

constexpr double still_travel = 0.01;  // half diagonals that scene points move at most in front of a still camera

// Frames from the beginning in which nothing moves.
struct StillStart {
    uint64_t frames = 0, shown = 0;  // shown: with scene points
};

// The first 120 frames, of 3 s or more, with scene points, if these do not move; else none. One in six is looked at, up
// to the first that shows motion, or until 240 frames show no points.
StillStart find_still_start(const FrameSource &source);

class CameraMotion {
public:
    // The next frame; those after the first three seconds with scene points, 90 such frames, or 1500 in all, are not
    // looked at.
    void add(const Picture &frame, double seconds);

    // Whether enough frames were added for a verdict.
    bool is_known() const { return is_known_; }

    // Median movement of scene points from frame to frame, and where they end since they were first seen: shares of the
    // longer side of the frame.
    double per_frame() const;
    double travel() const { return travel_; }

private:
    CornerTracker tracker_;
    std::vector<double> motions_;
    size_t looks_ = 0;
    double first_s_ = -1.0, travel_ = 0.0;
    bool is_known_ = false;
};

}  // namespace lensprof
