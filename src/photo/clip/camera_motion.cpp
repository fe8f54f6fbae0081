#include "photo/clip/camera_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fit/base/quantile.hpp"

namespace lensprof {

void CameraMotion::add(const Picture &frame, double seconds) {
    constexpr double looked_at_s = 3.0;
    constexpr size_t most_frames = 90, most_looks = 1500;
    if (is_known_ || !CornerTracker::can_follow(frame.width, frame.height)) return;
    const TrackedFrame tracked = tracker_.add(frame);
    is_known_ = ++looks_ >= most_looks;
    if (tracked.found_again == 0) return;  // the first frame, a blank or plain one, or after a cut
    if (first_s_ < 0.0) first_s_ = seconds;
    const double half_diagonals = 0.5 * std::hypot(frame.width, frame.height) / std::max(frame.width, frame.height);
    motions_.push_back(tracked.motion * half_diagonals);
    travel_ = std::max(travel_, tracked.travel * half_diagonals);
    is_known_ = is_known_ || seconds >= first_s_ + looked_at_s || motions_.size() >= most_frames;
}

StillStart find_still_start(const FrameSource &source) {
    constexpr std::array<uint64_t, 5> steps{5, 7, 4, 8, 6};  // uneven, so that a shake of any period is seen
    constexpr uint64_t least_frames = 120, most_empty = 240;
    constexpr double least_s = 3.0, least_kept = 0.3;
    StillStart start;
    CornerTracker tracker;
    uint64_t wanted = 0, last = 0, empty = 0;
    double last_s = 0.0, shown_s = 0.0;
    size_t looks = 0;
    const auto frames = source.again();
    for (VideoFrame frame; empty <= most_empty && frames->next(frame);) {
        stop_if_cancelled();
        if (frame.number < wanted) continue;
        wanted += steps[looks++ % steps.size()];
        frames->read(frame.picture);
        const TrackedFrame tracked = tracker.add(frame.picture);
        if (tracked.travel >= still_travel || tracked.kept < least_kept) return {};
        const bool is_shown = tracked.found_again > 0;
        (is_shown ? start.shown : empty) += frame.number - last;
        if (is_shown) shown_s += frame.seconds - last_s;
        last = start.frames = frame.number, last_s = frame.seconds;
        if (start.shown >= least_frames && shown_s >= least_s) return start;
    }
    return {};
}

double CameraMotion::per_frame() const { return upper_median(motions_); }

}  // namespace lensprof
