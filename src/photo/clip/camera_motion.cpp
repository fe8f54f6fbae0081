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

StillStart find_still_start(const FrameSource &source) {
    constexpr uint64_t every = 6;  // moving cameras are found within two or three of these
    constexpr uint64_t most_frames = 120;
    constexpr double most_s = 3.0, least_kept = 0.3;
    StillStart start;
    CornerTracker tracker;
    double first_s = -1.0;
    const auto frames = source.again();
    for (VideoFrame frame; frames->next(frame);) {
        stop_if_cancelled();
        if (frame.number % every != 0) continue;
        frames->read(frame.picture);
        const TrackedFrame tracked = tracker.add(frame.picture);
        if (tracked.is_blank) continue;
        if (tracked.travel >= still_travel || tracked.kept < least_kept) return {};
        if (first_s < 0.0) first_s = frame.seconds;
        start.shown += start.shown ? every : 1, start.frames = frame.number + 1;
        if (start.shown >= most_frames && frame.seconds >= first_s + most_s) return start;
    }
    return {};
}

double CameraMotion::per_frame() const { return upper_median(motions_); }

}  // namespace lensprof
