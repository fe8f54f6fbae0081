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
struct ExposurePair {
    double seen, given;
    uint32_t frame = 0;
    size_t in_segment = 0;  // number of pairs of its segment
};

// The factor that makes the seen ones most like the given ones.
double scale_of(const std::vector<ExposurePair> &all) {
    constexpr double least = 0.4, most = 3.0;  // of the exponent, 2.2
    double squares = 0.0, both = 0.0;
    for (const ExposurePair &one : all) squares += one.seen * one.seen, both += one.seen * one.given;
    return squares > 0.0 ? std::clamp(both / squares, least, most) : 1.0;
}

double error_ev(const ExposurePair &pair, double scale) { return pair.given - scale * pair.seen; }

double rms_error(const std::vector<ExposurePair> &all, double scale) {
    double squares = 0.0;
    for (const ExposurePair &one : all) squares += error_ev(one, scale) * error_ev(one, scale);
    return all.empty() ? NAN : std::sqrt(squares / double(all.size()));
}

// Exposures of frames, and those known `shift` frames later, so that their differences have the median 0 in each
// segment.
std::vector<ExposurePair> pairs_of_frames(const std::vector<double> &known_ev, int shift, const ClipTracks &clip) {
    std::map<uint32_t, std::vector<ExposurePair>> segments;
    for (uint32_t i = 0; i < std::min(known_ev.size(), clip.frames.size()); i++) {
        const size_t line = i + static_cast<size_t>(shift);  // beyond the end also for negative numbers
        if (clip.frames[i].state != ClipState::measured || line >= known_ev.size() || std::isnan(known_ev[line]))
            continue;
        segments[clip.frames[i].segment].push_back({clip.frames[i].exposure.ev, known_ev[line], i});
    }
    std::vector<ExposurePair> all;
    for (const auto &[segment, pairs] : segments) {
        if (pairs.size() < 2) continue;
        std::vector<double> seen, differences;
        for (const ExposurePair &pair : pairs) seen.push_back(pair.seen), differences.push_back(pair.given - pair.seen);
        const double middle = upper_median(seen), offset = upper_median(differences);
        for (const ExposurePair &pair : pairs)
            all.push_back({pair.seen - middle, pair.given - middle - offset, pair.frame, pairs.size()});
    }
    return all;
}

// Frames whose known exposures differ by far more than the others. Few known ones do not show which is wrong.
void find_wrong(const std::vector<ExposurePair> &pairs, double scale, KnownAgreement &agreement) {
    constexpr double least_ev = 0.15, least_spreads = 8.0;
    constexpr size_t fewest = 10, fewest_in_segment = 3;
    std::vector<double> sizes;
    for (const ExposurePair &pair : pairs) sizes.push_back(std::abs(error_ev(pair, scale)));
    if (sizes.size() < fewest) return;
    const double limit = std::max(least_ev, least_spreads * spread_of_mad * upper_median(sizes));
    for (size_t n = 0; n < pairs.size(); n++)
        if (sizes[n] > limit && pairs[n].in_segment >= fewest_in_segment)
            agreement.wrong_frames.push_back(pairs[n].frame);
    std::sort(agreement.wrong_frames.begin(), agreement.wrong_frames.end());
    if (agreement.wrong_frames.size() > most_wrong(sizes.size())) agreement.wrong_frames.clear();
}

// The shift by which known exposures agree much better, whatever the exponent: wrong ones change that of the fit. By
// more than two frames, only clearly wrong ones. What a shift pushes over the end does not count as an agreement.
int find_shift(const std::vector<double> &known_ev, const KnownAgreement &as_given, size_t compared,
               const ClipTracks &clip) {
    constexpr double shifted_ev = 0.02, far_shifted_ev = 0.05, much_better = 0.5, far_better = 0.25;
    constexpr double least_compared = 0.9;
    constexpr size_t fewest = 10;
    constexpr int nearby = 2;
    int best_shift = 0;
    double best_ev = INFINITY;
    for (int shift = -farthest_shift; shift <= farthest_shift; shift++) {
        const bool is_nearby = std::abs(shift) <= nearby;
        if (shift == 0 || !(as_given.rms_ev > (is_nearby ? shifted_ev : far_shifted_ev))) continue;
        const auto moved = pairs_of_frames(known_ev, shift, clip);
        if (moved.size() < fewest || double(moved.size()) < least_compared * double(compared)) continue;
        const double moved_ev = rms_error(moved, scale_of(moved));
        if (moved_ev < (is_nearby ? much_better : far_better) * as_given.scaled_rms_ev && moved_ev < best_ev)
            best_ev = moved_ev, best_shift = shift;
    }
    return best_shift;
}

constexpr size_t early_lag = 16;  // frames between which changes are compared

struct EarlyErrors {
    double rms_ev = NAN, change_ev = NAN;  // NaN: too few frames
    size_t steps = 0;
};

// How far the changes of exposures known `shift` frames later differ from those seen, after the best factor, and their
// own size, without the tenth of the steps that differ most: a few wrong lines, of two steps each, are named after the
// fit.
EarlyErrors early_errors(const std::vector<double> &seen_ev, const std::vector<double> &known_ev, int shift) {
    constexpr size_t least_steps = 24;
    constexpr double kept = 0.9;
    const auto known_at = [&](size_t frame) {
        const size_t line = frame + static_cast<size_t>(shift);  // beyond the end also for negative numbers
        return line < known_ev.size() ? known_ev[line] : NAN;
    };
    std::vector<ExposurePair> steps;
    for (size_t i = early_lag; i < seen_ev.size(); i++)
        if (const double given = known_at(i) - known_at(i - early_lag); std::isfinite(given + seen_ev[i]))
            steps.push_back({seen_ev[i], given});
    if (steps.size() < least_steps) return {};
    const double of_all = scale_of(steps);
    std::sort(steps.begin(), steps.end(), [&](const ExposurePair &a, const ExposurePair &b) {
        return std::abs(error_ev(a, of_all)) < std::abs(error_ev(b, of_all));
    });
    const size_t all = steps.size();
    steps.resize(static_cast<size_t>(kept * double(all)));
    return {rms_error(steps, scale_of(steps)), rms_error(steps, 0.0), all};
}

}  // namespace

std::string frame_list(std::vector<uint32_t> frames) {
    constexpr size_t most_listed = 8;
    std::sort(frames.begin(), frames.end());
    std::string list = frames.size() > 1 ? "frames " : "frame ";
    for (size_t n = 0; n < std::min(frames.size(), most_listed); n++)
        list += (n ? ", " : "") + std::to_string(frames[n] + 1);
    return frames.size() > most_listed ? list + format(" and %zu more", frames.size() - most_listed) : list;
}

size_t most_wrong(size_t known) { return std::max<size_t>(1, known * 3 / 100); }

KnownAgreement agreement_with(const std::vector<double> &known_ev, bool is_exponent_open, const ClipTracks &clip) {
    const std::vector<ExposurePair> pairs = pairs_of_frames(known_ev, 0, clip);
    KnownAgreement agreement;
    agreement.scale = scale_of(pairs);
    agreement.scaled_rms_ev = rms_error(pairs, agreement.scale);
    const double scale = is_exponent_open ? agreement.scale : 1.0;
    agreement.rms_ev = rms_error(pairs, scale);
    for (const ExposurePair &pair : pairs)
        if (const double size = std::abs(error_ev(pair, scale)); size > agreement.worst_ev)
            agreement.worst_ev = size, agreement.worst_frame = pair.frame;
    find_wrong(pairs, scale, agreement);
    if (agreement.wrong_frames.empty()) agreement.better_shift = find_shift(known_ev, agreement, pairs.size(), clip);
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
    constexpr double least_compared = 0.8;
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
    for (int shift = -farthest_shift; shift <= farthest_shift; shift++) {
        const EarlyErrors moved = early_errors(seen_ev, known_ev, shift);
        if (moved.rms_ev < best_ev && double(moved.steps) >= least_compared * double(as_given.steps))
            best_ev = moved.rms_ev, best_shift = shift;
    }
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
