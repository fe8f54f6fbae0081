#include "photo/clip/given_times.hpp"

#include <algorithm>
#include <cmath>

#include "fit/base/quantile.hpp"
#include "photo/base/format.hpp"
#include "photo/clip/keyframes.hpp"

namespace lensprof {

void refuse_times(const ClipTracks &clip, double rms_ev) {
    throw Failure(LENSPROF_ERROR_NOT_USABLE,
                  clip.path
                      + format(": the given exposure times differ from what the frames show by %.2f EV (rms); check "
                               "that each line belongs to its frame, or leave out the times",
                               rms_ev),
                  LENSPROF_REASON_KNOWN_CONTRADICT);
}

void check_times_early(const ClipTracks &clip, const std::vector<double> &known_ev) {
    constexpr size_t lag = 16, least_shared = 20, least_steps = 24;
    constexpr double least_scale = 0.4, most_scale = 3.0;  // of the exponent, 2.2
    constexpr double least_ev = 0.12;                      // right times: below 0.05 in 10 rendered clips
    constexpr double unexplained = 0.7;                    // share of the given changes
    double seen2 = 0.0, given2 = 0.0, both = 0.0, steps = 0.0;
    for (size_t i = lag; i < std::min(known_ev.size(), clip.frames.size()); i++) {
        const CommonPoints common = common_of(clip.observations_of(i - lag), clip.observations_of(i));
        const double given = known_ev[i] - known_ev[i - lag];
        if (common.shared < least_shared || !std::isfinite(given)) continue;
        seen2 += common.step_ev * common.step_ev, given2 += given * given, both += common.step_ev * given, steps++;
    }
    if (steps < least_steps || !(seen2 > 0.0)) return;
    const double scale = std::clamp(both / seen2, least_scale, most_scale);
    const double rms_ev = std::sqrt(std::max(0.0, given2 - 2.0 * scale * both + scale * scale * seen2) / steps);
    if (rms_ev > least_ev && rms_ev > unexplained * std::sqrt(given2 / steps)) refuse_times(clip, rms_ev);
}

double offset_of_times(const ClipTracks &clip, const std::vector<double> &known_ev) {
    std::vector<double> offsets;
    for (size_t i = 0; i < known_ev.size(); i++)
        if (clip.frames[i].state == ClipState::measured && std::isfinite(known_ev[i]))
            offsets.push_back(known_ev[i] - clip.frames[i].exposure.ev);
    return upper_median(offsets);
}

}  // namespace lensprof
