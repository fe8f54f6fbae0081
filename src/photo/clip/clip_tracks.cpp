#include "photo/clip/clip_tracks.hpp"

#include <algorithm>
#include <cmath>

#include "photo/base/format.hpp"
#include "photo/video/tracker.hpp"

namespace lensprof {
namespace {

constexpr size_t first_look = 300;  // frames
constexpr int patch_side = 7;       // px of the reduced frame
constexpr double white_value = 250.5 / 255.0, largest_spread = 24.0 / 255.0;

// Sums of a channel over the samples of a patch.
struct ChannelSums {
    double sum = 0.0, squares = 0.0, highest = 0.0;

    void add(double value) { sum += value, squares += value * value; }

    float mean(double count) const {
        const double mean = sum / count, spread = std::sqrt(std::max(0.0, squares / count - mean * mean));
        if (mean >= white_value) return 1.0f;
        return highest >= white_value || spread > largest_spread ? NAN : static_cast<float>(mean);
    }
};

// The mean of each channel over the surface that was a square of `side` pixels where the place was first seen, sampled
// once per pixel.
std::array<float, 3> patch_mean(const Picture &frame, const TrackedPlace &place, int side) {
    const uint32_t channels = lensprof_layout_samples(frame.layout);
    ChannelSums sums[3];
    for (int row = 0; row < side; row++)
        for (int column = 0; column < side; column++) {
            const double dx = column - 0.5 * (side - 1), dy = row - 0.5 * (side - 1);
            const auto &shape = place.shape;
            const double x = std::clamp(double(place.x) + double(shape[0]) * dx + double(shape[1]) * dy, 0.0,
                                        frame.width - 1.001),
                         y = std::clamp(double(place.y) + double(shape[2]) * dx + double(shape[3]) * dy, 0.0,
                                        frame.height - 1.001);
            const auto left = static_cast<size_t>(x), top = static_cast<size_t>(y);
            const double right = x - double(left), below = y - double(top);
            const uint8_t *upper = &frame.pixels[top * frame.row_bytes], *lower = upper + frame.row_bytes;
            for (uint32_t c = 0; c < channels; c++) {
                const auto value = [&](const uint8_t *of_row, size_t at) {
                    return sample_value(frame.sample, of_row, at * channels + c);
                };
                const double a = value(upper, left), b = value(upper, left + 1), d = value(lower, left),
                             e = value(lower, left + 1);
                sums[c].add((1.0 - below) * (a + right * (b - a)) + below * (d + right * (e - d)));
                sums[c].highest = std::max({sums[c].highest, a, b, d, e});
            }
        }
    std::array<float, 3> values{};
    for (uint32_t c = 0; c < channels; c++) values[c] = sums[c].mean(side * side);
    if (channels == 1) values[1] = values[2] = values[0];
    return values;
}

}  // namespace

ClipObservations ClipTracks::observations_of(size_t frame) const {
    ClipObservations found(frames[frame].observation_count);
    stored->read(frames[frame].observations_at, found.data(), found.size() * sizeof(ClipObservation));
    return found;
}

ClipTracks track_clip(const std::string &path, FrameSource &source, double taken_per_s, Events &events,
                      const std::function<void(const ClipTracks &)> &look) {
    ClipTracks clip;
    clip.path = path, clip.info = source.info();
    if (!CornerTracker::can_follow(clip.info.width, clip.info.height))
        throw Failure(
            LENSPROF_ERROR_NOT_USABLE,
            path
                + format(": its frames of %u x %u pixels are too small to follow scene points; give a clip of "
                         "64 pixels and more, of usual proportions",
                         clip.info.width, clip.info.height),
            LENSPROF_REASON_FEW_PAIRS);
    const StillStart still = find_still_start(source);
    clip.frames_in_clip = still.frames, clip.shown_frames = still.shown;
    if (still.frames > 0) return clip;
    CornerTracker tracker;
    bool is_grey = true;
    double next_s = 0.0;
    for (VideoFrame frame; source.next(frame);) {
        clip.frames_in_clip++;
        stop_if_cancelled();
        source.read(frame.picture);
        const TrackedFrame tracked = tracker.add(frame.picture);
        clip.travel = std::max(clip.travel, tracked.travel);
        const auto total = clip.info.frames;
        events.update("tracking", total ? double(clip.frames_in_clip) / double(total) : 0.0,
                      counted(clip.frames_in_clip, "frame"));
        clip.shown_frames += !tracked.places.empty();
        if (taken_per_s > 0.0) {
            if (frame.seconds < next_s - 0.5 / std::max(taken_per_s, clip.info.frames_per_s)) continue;
            next_s = (std::floor(frame.seconds * taken_per_s + 0.5) + 1.0) / taken_per_s;
        }
        ClipFrame found;
        found.number = frame.number, found.seconds = frame.seconds;
        found.mean_level = tracked.mean_level, found.motion = tracked.motion, found.repeats = tracked.repeats;
        if (tracked.is_blank) found.state = ClipState::blank;
        ClipObservations observations;
        for (const TrackedPlace &place : tracked.places) {
            const auto value = patch_mean(frame.picture, place, patch_side * static_cast<int>(tracked.side));
            observations.push_back({place.track, place.x, place.y, value});
            is_grey &= !(std::abs(value[0] - value[1]) > 0.0f) && !(std::abs(value[2] - value[1]) > 0.0f);
        }
        found.observation_count = static_cast<uint32_t>(observations.size());
        found.observations_at = clip.stored->append(observations.data(), observations.size() * sizeof(ClipObservation));
        clip.frames.push_back(found);
        if (clip.frames.size() == first_look) look(clip);
    }
    events.clear();
    clip.channels = is_grey ? 1 : 3;
    return clip;
}

}  // namespace lensprof
