#include "photo/clip/given_times.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fit/base/quantile.hpp"
#include "photo/base/format.hpp"
#include "photo/clip/keyframes.hpp"

namespace lensprof {
namespace {

constexpr double spread_of_mad = 1.4826;  // of a normal distribution
constexpr int farthest_shift = 30;        // lines

// An exposure, or a change of it, that frames show and that is given, EV.
struct Exposed {
    double seen, given;
    uint32_t frame = 0;
};

// The factor that makes the seen ones most like the given ones.
double scale_of(const std::vector<Exposed> &all) {
    constexpr double least = 0.4, most = 3.0;  // of the exponent, 2.2
    double squares = 0.0, both = 0.0;
    for (const Exposed &one : all) squares += one.seen * one.seen, both += one.seen * one.given;
    return squares > 0.0 ? std::clamp(both / squares, least, most) : 1.0;
}

double rms_error(const std::vector<Exposed> &all, double scale) {
    double squares = 0.0;
    for (const Exposed &one : all) squares += (one.given - scale * one.seen) * (one.given - scale * one.seen);
    return all.empty() ? NAN : std::sqrt(squares / double(all.size()));
}

// Exposures of frames, and those known `shift` frames later, relative to their medians in the segment.
std::vector<Exposed> exposed_frames(const std::vector<double> &known_ev, int shift, const ClipTracks &clip) {
    std::map<uint32_t, std::vector<Exposed>> segments;
    for (uint32_t i = 0; i < std::min(known_ev.size(), clip.frames.size()); i++) {
        const size_t line = i + static_cast<size_t>(shift);  // beyond the end also for negative numbers
        if (clip.frames[i].state != ClipState::measured || line >= known_ev.size() || std::isnan(known_ev[line]))
            continue;
        segments[clip.frames[i].segment].push_back({clip.frames[i].exposure.ev, known_ev[line], i});
    }
    std::vector<Exposed> all;
    for (const auto &[segment, frames] : segments) {
        std::vector<double> seen, given;
        for (const Exposed &frame : frames) seen.push_back(frame.seen), given.push_back(frame.given);
        const double middle_seen = upper_median(seen), middle_given = upper_median(given);
        for (const Exposed &frame : frames)
            all.push_back({frame.seen - middle_seen, frame.given - middle_given, frame.frame});
    }
    return all;
}

// Frames whose known exposures differ by far more than the others.
void find_wrong(const std::vector<Exposed> &frames, KnownAgreement &agreement) {
    constexpr double least_ev = 0.15, least_spreads = 8.0, most_share = 0.03;
    std::vector<double> sizes;
    for (const Exposed &frame : frames) sizes.push_back(std::abs(frame.given - frame.seen));
    if (sizes.empty()) return;
    const double limit = std::max(least_ev, least_spreads * spread_of_mad * upper_median(sizes));
    for (size_t n = 0; n < frames.size(); n++) {
        if (!(sizes[n] > limit)) continue;
        agreement.wrong.push_back(frames[n].frame);
        agreement.wrong_ev = std::max(agreement.wrong_ev, sizes[n]);
    }
    std::sort(agreement.wrong.begin(), agreement.wrong.end());
    if (double(agreement.wrong.size()) > std::max(1.0, most_share * double(sizes.size()))) agreement.wrong.clear();
}

// The shift by which known exposures agree much better, whatever the exponent: wrong ones change that of the fit. By
// more than two frames, only clearly wrong ones.
int find_shift(const std::vector<double> &known_ev, const KnownAgreement &as_given, const ClipTracks &clip) {
    constexpr double shifted_ev = 0.02, far_shifted_ev = 0.05, much_better = 0.5, far_better = 0.25;
    constexpr int near = 2;
    const auto error_at = [&](int shift) {
        const auto frames = exposed_frames(known_ev, shift, clip);
        return rms_error(frames, scale_of(frames));
    };
    const double error_ev = error_at(0);
    const int most = std::min(farthest_shift, int(clip.frames.size()) / 4);
    int best_shift = 0;
    double best_ev = INFINITY;
    for (int shift = -most; shift <= most; shift++) {
        const bool is_near = std::abs(shift) <= near;
        if (shift == 0 || !(as_given.rms_ev > (is_near ? shifted_ev : far_shifted_ev))) continue;
        const double moved_ev = error_at(shift);
        if (moved_ev < (is_near ? much_better : far_better) * error_ev && moved_ev < best_ev)
            best_ev = moved_ev, best_shift = shift;
    }
    return best_shift;
}

constexpr size_t early_lag = 16;  // frames between which changes are compared

struct EarlyErrors {
    double rms_ev = NAN, change_ev = NAN;  // NaN: too few frames
};

// How far the changes of exposures known `shift` frames later differ from those seen, after the best factor, and their
// own size, without the twentieth of the steps that differ most: a few wrong lines are named after the fit.
EarlyErrors early_errors(const std::vector<double> &seen_ev, const std::vector<double> &known_ev, int shift) {
    constexpr size_t least_steps = 24;
    constexpr double kept = 0.95;
    const auto known_at = [&](size_t frame) {
        const size_t line = frame + static_cast<size_t>(shift);  // beyond the end also for negative numbers
        return line < known_ev.size() ? known_ev[line] : NAN;
    };
    std::vector<Exposed> steps;
    for (size_t i = early_lag; i < seen_ev.size(); i++)
        if (const double given = known_at(i) - known_at(i - early_lag); std::isfinite(given + seen_ev[i]))
            steps.push_back({seen_ev[i], given});
    if (steps.size() < least_steps) return {};
    const double of_all = scale_of(steps);
    std::sort(steps.begin(), steps.end(), [&](const Exposed &a, const Exposed &b) {
        return std::abs(a.given - of_all * a.seen) < std::abs(b.given - of_all * b.seen);
    });
    steps.resize(static_cast<size_t>(kept * double(steps.size())));
    return {rms_error(steps, scale_of(steps)), rms_error(steps, 0.0)};
}

}  // namespace

KnownAgreement agreement_with(const std::vector<double> &known_ev, const ClipTracks &clip) {
    const std::vector<Exposed> frames = exposed_frames(known_ev, 0, clip);
    KnownAgreement agreement;
    agreement.rms_ev = rms_error(frames, 1.0);
    find_wrong(frames, agreement);
    if (agreement.wrong.empty()) agreement.better_shift = find_shift(known_ev, agreement, clip);
    return agreement;
}

void refuse_times(const ClipTracks &clip, double rms_ev) {
    throw Failure(LENSPROF_ERROR_NOT_USABLE,
                  clip.path
                      + format(": the given exposure times differ from what the frames show by %.2f EV (rms); check "
                               "that each line belongs to its frame, or leave out the times",
                               rms_ev),
                  LENSPROF_REASON_KNOWN_CONTRADICT);
}

void refuse_shifted_times(const ClipTracks &clip, int shift) {
    throw Failure(LENSPROF_ERROR_NOT_USABLE,
                  clip.path
                      + format(": the given exposure times fit the frames better if they are moved %s by %s; check "
                               "which line belongs to which frame",
                               shift > 0 ? "up" : "down", counted(size_t(std::abs(shift)), "line").c_str()),
                  LENSPROF_REASON_KNOWN_CONTRADICT);
}

void check_times_early(const ClipTracks &clip, const std::vector<double> &known_ev) {
    constexpr size_t least_shared = 20;
    constexpr double least_ev = 0.12;                       // right times: below 0.05 in 10 rendered clips
    constexpr double unexplained = 0.7, much_better = 0.4;  // share of the given changes, and of the errors
    std::vector<double> seen_ev(clip.frames.size(), NAN);
    for (size_t i = early_lag; i < clip.frames.size(); i++) {
        const CommonPoints common = common_of(clip.observations_of(i - early_lag), clip.observations_of(i));
        if (common.shared >= least_shared) seen_ev[i] = common.step_ev;
    }
    const EarlyErrors as_given = early_errors(seen_ev, known_ev, 0);
    if (!(as_given.rms_ev > std::max(least_ev, unexplained * as_given.change_ev))) return;
    int best_shift = 0;
    double best_ev = much_better * as_given.rms_ev;
    for (int shift = -farthest_shift; shift <= farthest_shift; shift++)
        if (const double error_ev = early_errors(seen_ev, known_ev, shift).rms_ev; error_ev < best_ev)
            best_ev = error_ev, best_shift = shift;
    if (best_shift) refuse_shifted_times(clip, best_shift);
    refuse_times(clip, as_given.rms_ev);
}

double offset_of_times(const ClipTracks &clip, const std::vector<double> &known_ev) {
    std::vector<double> offsets;
    for (size_t i = 0; i < known_ev.size(); i++)
        if (clip.frames[i].state == ClipState::measured && std::isfinite(known_ev[i]))
            offsets.push_back(known_ev[i] - clip.frames[i].exposure.ev);
    return upper_median(offsets);
}

}  // namespace lensprof
