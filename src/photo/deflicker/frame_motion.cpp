#include "photo/deflicker/frame_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fit/base/quantile.hpp"
#include "photo/base/format.hpp"
#include "photo/base/library.hpp"

namespace lensprof {
namespace {

// Shares of the longer side: movement from frame to frame, its change, and how far the camera comes per frame.
struct FrameMotion {
    double speed = 0.0, jerk = 0.0, progress = 0.0;
};

FrameMotion motion_of(const lensprof_deflicker &deflicker, uint32_t count) {
    std::vector<double> speeds, jerks;
    std::array<double, 2> last_place{}, last_step{};
    double farthest = 0.0;
    uint32_t segment = 0, in_segment = 0;
    for (uint32_t i = 0; i < count; i++) {
        lensprof_deflicker_frame frame;
        lensprof_deflicker_frame_init(&frame);
        check(lensprof_deflicker_frame_at(&deflicker, i, &frame, nullptr), "deflicker");
        if (frame.state != LENSPROF_FRAME_LEVELLED) continue;
        if (frame.segment != segment) segment = frame.segment, in_segment = 0;
        const std::array<double, 2> place{frame.shift[0], frame.shift[1]},
            step{place[0] - last_place[0], place[1] - last_place[1]};
        if (in_segment > 0) speeds.push_back(std::hypot(step[0], step[1]));
        if (in_segment > 1) jerks.push_back(std::hypot(step[0] - last_step[0], step[1] - last_step[1]));
        farthest = std::max(farthest, std::hypot(place[0], place[1]));
        last_place = place, last_step = step, in_segment++;
    }
    return {upper_median(speeds), upper_median(jerks), farthest / std::max(count - 1.0, 1.0)};
}

bool are_apart(const std::vector<const Frame *> &frames, size_t count) {
    constexpr double slow_s = 0.5;
    return frames[count - 1]->seconds - frames[0]->seconds >= slow_s * double(count - 1);  // false for NaN
}

}  // namespace

void refuse_moving(const Frame &first, const lensprof_deflicker_result &r) {
    const std::string how =
        r.motion > 0.0 && r.unlinked < 0.5
            ? format("it turns or moves by %.1f %% of the frame from one frame to the next", 100.0 * r.motion)
            : format("%.0f %% of the frames do not agree with the one before them", 100.0 * r.unlinked);
    throw Failure(LENSPROF_ERROR_NOT_USABLE,
                  first.file + ": the camera is not stationary: " + how + advice("moving_camera"),
                  LENSPROF_REASON_FEW_AGREE);
}

void warn_of_motion(const lensprof_deflicker &deflicker, const std::vector<const Frame *> &frames, Events &events) {
    constexpr double fast = 0.0042, slow = 0.001, slow_progress = 0.00065, irregular = 0.13;
    constexpr size_t fewest = 8;
    const size_t count = std::min(frames.size(), warning_frames);
    if (count < fewest || are_apart(frames, count)) return;
    const FrameMotion motion = motion_of(deflicker, static_cast<uint32_t>(count));
    const bool is_in_a_hand = motion.progress > slow_progress && motion.jerk > irregular * motion.speed;
    if (motion.speed > slow && (motion.progress > fast || is_in_a_hand))  // slower after a bump
        events.warn(frames[0]->file, format("the camera moves by %.1f %% of the frame from one frame to the next; its "
                                            "falloff stays in the frames, and their exposures are less exact than ",
                                            100.0 * motion.speed)
                                         + advice("moving_frames"));
}

}  // namespace lensprof
