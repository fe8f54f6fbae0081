#include "photo/clip/clip_tracks.hpp"

#include <algorithm>
#include <cmath>

#include "photo/base/format.hpp"
#include "photo/video/tracker.hpp"

namespace lensprof {
namespace {

constexpr double patch_side = 7.0;  // px of the reduced frame
constexpr double white_value = 250.5 / 255.0, largest_spread = 24.0 / 255.0;
constexpr size_t most_static_frames = 300;

// The mean of each channel over a square, whose pixels at the rim count with their share.
std::array<float, 3> patch_mean(const Picture &frame, const TrackedPlace &place, double side) {
    const uint32_t channels = lensprof_layout_samples(frame.layout);
    const double left = place.x - side / 2.0, top = place.y - side / 2.0;
    const auto first_x = static_cast<uint32_t>(std::max(0.0, std::ceil(left - 0.5))),
               first_y = static_cast<uint32_t>(std::max(0.0, std::ceil(top - 0.5)));
    const auto last_x = static_cast<uint32_t>(std::min(frame.width - 1.0, std::floor(left + side + 0.5))),
               last_y = static_cast<uint32_t>(std::min(frame.height - 1.0, std::floor(top + side + 0.5)));
    double sum[3] = {}, squares[3] = {}, highest[3] = {}, weights = 0.0;
    for (uint32_t y = first_y; y <= last_y; y++) {
        const double wy = std::clamp(std::min(y + 0.5 - top, top + side - y + 0.5), 0.0, 1.0);
        for (uint32_t x = first_x; x <= last_x; x++) {
            const double weight = wy * std::clamp(std::min(x + 0.5 - left, left + side - x + 0.5), 0.0, 1.0);
            weights += weight;
            for (uint32_t c = 0; c < channels; c++) {
                const double value =
                    sample_value(frame.sample, &frame.pixels[y * frame.row_bytes], size_t(x) * channels + c);
                sum[c] += weight * value, squares[c] += weight * value * value;
                highest[c] = std::max(highest[c], value);
            }
        }
    }
    std::array<float, 3> values{};
    for (uint32_t c = 0; c < channels; c++) {
        const double mean = sum[c] / weights, spread = std::sqrt(std::max(0.0, squares[c] / weights - mean * mean));
        const bool is_white = mean >= white_value;
        const bool is_partly_white = !is_white && highest[c] >= white_value;
        values[c] = is_white ? 1.0f : is_partly_white || spread > largest_spread ? NAN : static_cast<float>(mean);
    }
    if (channels == 1) values[1] = values[2] = values[0];
    return values;
}

}  // namespace

ClipTracks track_clip(const std::string &path, FrameSource &source, double taken_per_s, Events &events) {
    ClipTracks clip;
    clip.path = path, clip.info = source.info();
    CornerTracker tracker;
    bool is_grey = true;
    double next_s = 0.0;
    for (VideoFrame frame; source.next(frame);) {
        clip.frames_in_clip++;
        if (taken_per_s > 0.0) {
            if (frame.seconds < next_s - 0.5 / std::max(taken_per_s, clip.info.frames_per_s)) continue;
            next_s = (std::floor(frame.seconds * taken_per_s + 0.5) + 1.0) / taken_per_s;
        }
        stop_if_cancelled();
        source.read(frame.picture);
        const TrackedFrame tracked = tracker.add(frame.picture);
        ClipFrame found;
        found.number = frame.number, found.seconds = frame.seconds;
        found.mean_level = tracked.mean_level, found.motion = tracked.motion, found.repeats = tracked.repeats;
        if (tracked.is_blank) found.state = ClipState::blank;
        for (const TrackedPlace &place : tracked.places) {
            const auto value = patch_mean(frame.picture, place, patch_side * tracked.side);
            found.observations.push_back({place.track, place.x, place.y, value});
            is_grey &= !(std::abs(value[0] - value[1]) > 0.0f) && !(std::abs(value[2] - value[1]) > 0.0f);
        }
        clip.travel = std::max(clip.travel, tracked.travel);
        clip.frames.push_back(std::move(found));
        const auto total = clip.info.frames;
        events.update("tracking", total ? double(clip.frames_in_clip) / double(total) : 0.0,
                      counted(clip.frames_in_clip, "frame"));
        if (clip.frames.size() == most_static_frames && clip.is_static()) break;
    }
    events.clear();
    clip.channels = is_grey ? 1 : 3;
    return clip;
}

}  // namespace lensprof
