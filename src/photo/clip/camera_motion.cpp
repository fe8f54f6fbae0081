#include "photo/clip/camera_motion.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"

namespace lensprof {

void CameraMotion::add(const Picture &frame, double seconds) {
    constexpr double looked_at_s = 3.0;
    constexpr size_t most_frames = 90;
    if (is_known_ || !CornerTracker::can_follow(frame.width, frame.height)) return;
    const TrackedFrame tracked = tracker_.add(frame);
    if (tracked.is_blank) return;
    if (first_s_ < 0.0) first_s_ = seconds;
    const double half_diagonals = 0.5 * std::hypot(frame.width, frame.height) / std::max(frame.width, frame.height);
    motions_.push_back(tracked.motion * half_diagonals);
    travel_ = std::max(travel_, tracked.travel * half_diagonals);
    is_known_ = seconds >= first_s_ + looked_at_s || motions_.size() >= most_frames;
}

double CameraMotion::per_frame() const { return upper_median(motions_); }

}  // namespace lensprof
