#include "photo/clip/keyframes.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr double exposure_step_ev = 0.3, usual_gamma = 2.2;  // the response is not known yet
constexpr double every_frame = 2.0;                          // as the share of scene points
constexpr size_t least_shared = 12, least_keyframes = 50;

bool is_usable(const ClipObservation &seen) { return seen.value[1] > 0.04f && seen.value[1] < 0.98f; }

// Consecutive keyframes that share scene points.
struct Run {
    std::vector<uint32_t> frames;
    std::vector<double> change_ev;  // of each since the one before
};

std::vector<Run> runs_at(const ClipTracks &clip, double least_share) {
    std::vector<Run> runs;
    ClipObservations before, last;  // of the last usable frame, and of the last keyframe
    for (uint32_t i = 0; i < clip.frames.size(); i++) {
        const ClipFrame &frame = clip.frames[i];
        if (frame.state == ClipState::blank || frame.repeats || frame.observation_count < least_shared) continue;
        const ClipObservations seen = clip.observations_of(i);
        const bool is_new = runs.empty() || common_of(before, seen).shared < least_shared;
        before = seen;
        if (is_new) {
            runs.push_back({{i}, {0.0}});
            last = seen;
            continue;
        }
        const CommonPoints common = common_of(last, seen);
        const auto of_last = std::count_if(last.begin(), last.end(), is_usable);
        const double share = double(common.shared) / std::max(double(of_last), 1.0);
        if (share >= least_share && std::abs(common.step_ev) < exposure_step_ev) continue;
        runs.back().frames.push_back(i);
        runs.back().change_ev.push_back(std::abs(common.step_ev));
        last = seen;
    }
    return runs;
}

// Where the camera moves so little that all frames see the same points, frames at even distances are enough.
void thin(std::vector<Run> &runs, size_t most) {
    for (Run &run : runs) {
        Run kept;
        const size_t step = (run.frames.size() + most - 1) / most;
        for (size_t i = 0; i < run.frames.size(); i += std::max<size_t>(step, 1)) {
            kept.frames.push_back(run.frames[i]);
            kept.change_ev.push_back(run.change_ev[i]);
        }
        run = kept;
    }
}

double worth_of(const Run &run, size_t first, size_t end) {
    constexpr double worth_of_frame = 0.05;  // EV
    double worth = worth_of_frame * double(end - first);
    for (size_t i = first + 1; i < end; i++) worth += run.change_ev[i];
    return worth;
}

}  // namespace

CommonPoints common_of(const ClipObservations &first, const ClipObservations &second) {
    std::vector<double> steps;
    for_shared_tracks(first, second, [&](const ClipObservation &a, const ClipObservation &b) {
        if (is_usable(a) && is_usable(b)) steps.push_back(usual_gamma * std::log2(b.value[1] / a.value[1]));
    });
    return {steps.size(), upper_median(steps)};
}

std::vector<uint32_t> choose_keyframes(const ClipTracks &clip, uint32_t most) {
    std::vector<Run> runs;
    size_t longest = 0;
    for (const double share : {0.5, 0.6, 0.7, 0.8, 0.9, 0.95, every_frame}) {
        runs = runs_at(clip, share);
        longest = 0;
        for (const Run &run : runs) longest = std::max(longest, run.frames.size());
        if (share >= every_frame) thin(runs, least_keyframes);
        if (longest >= least_keyframes) break;
    }
    std::vector<uint32_t> best;
    double best_worth = -1.0;
    for (const Run &run : runs) {
        const size_t length = std::min<size_t>(most, run.frames.size());
        for (size_t first = 0; first + length <= run.frames.size(); first++) {
            const double worth = worth_of(run, first, first + length);
            if (!(worth > best_worth)) continue;
            best_worth = worth;
            const auto begin = run.frames.begin() + static_cast<std::ptrdiff_t>(first);
            best.assign(begin, begin + static_cast<std::ptrdiff_t>(length));
        }
    }
    return best;
}

}  // namespace lensprof
