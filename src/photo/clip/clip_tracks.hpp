// Scene points followed through the frames of a clip, and their grey values.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/base/memory_file.hpp"
#include "photo/clip/camera_motion.hpp"
#include "photo/clip/frame_source.hpp"

namespace lensprof {

enum class ClipState {
    measured,
    blank,    // black or white: nothing to measure
    unlinked  // shares too few scene points with other frames
};

// One view of a scene point.
struct ClipObservation {
    uint32_t track;
    float x, y;                    // px of the frame
    std::array<float, 3> value{};  // mean of a patch, 0..1; 1 = saturated, NaN = saturated in part, or uneven
};

using ClipObservations = std::vector<ClipObservation>;  // of a frame, sorted by track

struct ClipFrame {
    uint64_t number = 0;  // in the clip, from 0
    double seconds = 0.0;
    double mean_level = 0.0;  // of its samples, 0..255
    double motion = 0.0;      // since the frame before, half diagonals
    bool repeats = false, is_keyframe = false;
    uint64_t observations_at = 0;  // in ClipTracks::stored
    uint32_t observation_count = 0;

    ClipState state = ClipState::unlinked;
    uint32_t segment = 0;          // number of breaks before it
    uint32_t group = 0;            // first segment of those that known exposures connect; without, `segment`
    lensprof_exposure exposure{};  // EV relative to the mean of its group, white balance to that of its segment; NaN
                                   // unless measured
    double ev_sigma = 0.0;         // standard error of exposure.ev; until the clip is fitted that of the last step
};

struct ClipTracks {
    std::string path;
    VideoInfo info;
    uint32_t channels = 3;
    std::vector<ClipFrame> frames;
    uint64_t frames_in_clip = 0, shown_frames = 0;  // shown: with scene points
    double travel = 0.0;  // largest median distance of scene points from where they were first seen, half diagonals
    std::shared_ptr<ScratchFile> stored = std::make_shared<ScratchFile>();  // the observations of all frames
    bool is_static() const { return travel < still_travel; }
    ClipObservations observations_of(size_t frame) const;
};

// Looks at the beginning (find_still_start): a clip with a still start is not followed (`is_static`). Then decodes the
// clip once, and holds one frame at a time; the observations, about 9 kB per frame, wait on disk. Follows scene points
// through all frames, and measures them in `taken_per_s` frames per second, 0 = all. `look` is called once, after 300
// measured frames, and may throw.
ClipTracks track_clip(const std::string &path, FrameSource &source, double taken_per_s, Events &events,
                      const std::function<void(const ClipTracks &)> &look);

// The observations of the same tracks in two frames: call(a, b).
template <class Call>
void for_shared_tracks(const ClipObservations &first, const ClipObservations &second, const Call &call) {
    auto b = second.begin();
    for (const ClipObservation &a : first) {
        while (b != second.end() && b->track < a.track) ++b;
        if (b == second.end()) return;
        if (b->track == a.track) call(a, *b);
    }
}

}  // namespace lensprof
