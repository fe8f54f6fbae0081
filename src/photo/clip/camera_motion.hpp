// Whether the camera of a clip stands still, from its first seconds.
#pragma once

#include <vector>

#include "photo/video/tracker.hpp"

namespace lensprof {

class CameraMotion {
public:
    // The next frame; those after the first three seconds, or 90 frames, are not looked at.
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
    double first_s_ = -1.0, travel_ = 0.0;
    bool is_known_ = false;
};

}  // namespace lensprof
