#include "fit/deflicker/levelling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit/base/quantile.hpp"
#include "fit/deflicker/curve.hpp"

namespace lensprof {
namespace {

constexpr double kLargestMotion = 0.01;  // share of the longer side per frame that a motion-controlled camera moves
constexpr double kMostUnlinked = 0.5;    // share of the frames
constexpr size_t kFewestSmooth = 5;      // frames of a curve; fewer get their mean
constexpr double kNotBrightened = 0.02;  // share of the frames that TO_LIGHT may brighten, for their flicker

bool is_levelled(const ChainFrame &frame) { return frame.state == LENSPROF_FRAME_LEVELLED; }

// Exposure and white balance of the frames of a segment, in EV.
struct SegmentCurve {
    std::vector<size_t> frames;
    std::vector<double> times, main, red, blue;
};

std::vector<SegmentCurve> segment_curves(const FrameChain &chain) {
    std::vector<SegmentCurve> curves;
    const auto &frames = chain.frames();
    const uint32_t main = main_channel(chain.grid());
    for (size_t i = 0; i < frames.size(); i++) {
        const ChainFrame &frame = frames[i];
        if (!is_levelled(frame)) continue;
        if (frame.segment >= curves.size()) curves.resize(frame.segment + 1);
        SegmentCurve &curve = curves[frame.segment];
        curve.frames.push_back(i);
        curve.times.push_back(std::isnan(frame.seconds) ? static_cast<double>(i) : frame.seconds);
        curve.main.push_back(frame.ev[main]);
        curve.red.push_back(frame.ev[0] - frame.ev[main]);
        curve.blue.push_back(frame.ev[2] - frame.ev[main]);
    }
    return curves;
}

void fill_mean(std::vector<double> &values) { std::fill(values.begin(), values.end(), mean_of(values)); }

void smooth_all(const FrameChain &chain, const lensprof_deflicker_target &target, double &longest,
                SegmentCurve &curve) {
    const std::vector<double> measured = curve.main;
    const bool is_light = target.to == LENSPROF_TO_LIGHT;
    for (size_t n = 0; is_light && n < curve.frames.size(); n++)
        curve.main[n] -= chain.frames()[curve.frames[n]].settings_ev;
    if (!(curve.times.back() > curve.times.front()))  // equal times
        std::iota(curve.times.begin(), curve.times.end(), 0.0);
    const double window = target.window_s > 0.0 ? target.window_s : best_window(curve.times, curve.main);
    longest = std::max(longest, std::min(window, curve.times.back() - curve.times.front()));
    for (std::vector<double> *values : {&curve.main, &curve.red, &curve.blue})
        if (curve.times.size() < kFewestSmooth)
            fill_mean(*values);
        else
            *values = smooth_curve(curve.times, *values, window);
    if (!is_light) return;
    std::vector<double> brightened;
    for (size_t n = 0; n < measured.size(); n++) brightened.push_back(measured[n] - curve.main[n]);
    const double level = quantile(brightened, kNotBrightened);
    for (double &ev : curve.main) ev += level;
}

void set_target(const FrameChain &chain, const lensprof_deflicker_target &target, double &longest,
                SegmentCurve &curve) {
    switch (target.to) {
    case LENSPROF_TO_SMOOTH:
    case LENSPROF_TO_LIGHT: smooth_all(chain, target, longest, curve); return;
    case LENSPROF_TO_CURVE:
        for (size_t n = 0; n < curve.frames.size(); n++) curve.main[n] = target.curve[curve.frames[n]];
        fill_mean(curve.red), fill_mean(curve.blue);
        return;
    case LENSPROF_TO_FRAME:
        for (size_t n = 0; n < curve.frames.size(); n++) {
            if (curve.frames[n] != target.frame) continue;
            for (std::vector<double> *values : {&curve.main, &curve.red, &curve.blue})
                std::fill(values->begin(), values->end(), double((*values)[n]));
            return;
        }
        break;  // another segment
    default: break;
    }
    fill_mean(curve.main), fill_mean(curve.red), fill_mean(curve.blue);
}

}  // namespace

lensprof_exposure exposure_of(const ChainFrame &frame, uint32_t channels) {
    lensprof_exposure exposure;
    lensprof_exposure_init(&exposure);
    if (!is_levelled(frame)) return exposure;
    const size_t main = channels == 3 ? 1 : 0;
    exposure.ev = frame.ev[main];
    for (size_t c = 0; c < channels; c++) exposure.white_balance[c] = std::exp2(frame.ev[c] - frame.ev[main]);
    return exposure;
}

lensprof_deflicker_result summarise(const FrameChain &chain) {
    lensprof_deflicker_result r;
    lensprof_deflicker_result_init(&r);
    const auto &frames = chain.frames();
    const uint32_t main = main_channel(chain.grid());
    r.frames = static_cast<uint32_t>(frames.size());
    std::vector<double> motions, flickers;
    std::vector<const ChainFrame *> levelled;
    double lowest = INFINITY, highest = -INFINITY;
    uint32_t unlinked = 0, with_information = 0;
    for (const ChainFrame &f : frames) {
        lowest = std::min(lowest, f.settings_ev), highest = std::max(highest, f.settings_ev);
        r.known_range = std::isfinite(f.settings_ev) && std::isfinite(r.known_range) ? highest - lowest : NAN;
        with_information += f.state != LENSPROF_FRAME_DARK && f.state != LENSPROF_FRAME_WHITE;
        unlinked += f.state == LENSPROF_FRAME_DISAGREES;
        if (!is_levelled(f)) continue;
        if (!levelled.empty() && levelled.back()->segment == f.segment) {
            motions.push_back(f.motion);
        } else if (!levelled.empty()) {
            unlinked++;
        }
        r.repeated += f.repeats;
        levelled.push_back(&f);
    }
    for (size_t n = 1; n + 1 < levelled.size(); n++)
        if (levelled[n - 1]->segment == levelled[n + 1]->segment)
            flickers.push_back(
                std::abs(levelled[n]->ev[main] - (levelled[n - 1]->ev[main] + levelled[n + 1]->ev[main]) / 2.0));
    r.levelled = static_cast<uint32_t>(levelled.size());
    r.segments = levelled.empty() ? 0 : levelled.back()->segment + 1;
    r.motion = upper_median(motions) / std::max(chain.grid().columns, chain.grid().rows);
    r.unlinked = with_information > 0 ? static_cast<double>(unlinked) / with_information : 0.0;
    r.moving = r.motion > kLargestMotion || (with_information > 2 && r.unlinked > kMostUnlinked);
    r.flicker = upper_median(flickers);
    r.tone_error = chain.tone_error();
    return r;
}

std::vector<lensprof_exposure> wanted_exposures(const FrameChain &chain, const lensprof_deflicker_target &target,
                                                double &window) {
    const uint32_t channels = chain.grid().channels;
    const auto &frames = chain.frames();
    std::vector<lensprof_exposure> wanted;
    for (const ChainFrame &frame : frames) wanted.push_back(exposure_of(frame, channels));
    window = 0.0;
    for (SegmentCurve &curve : segment_curves(chain)) {
        if (curve.frames.empty()) continue;
        set_target(chain, target, window, curve);
        for (size_t n = 0; n < curve.frames.size(); n++) {
            lensprof_exposure &exposure = wanted[curve.frames[n]];
            exposure.ev = curve.main[n];
            if (channels < 3) continue;
            exposure.white_balance[0] = std::exp2(curve.red[n]);
            exposure.white_balance[2] = std::exp2(curve.blue[n]);
        }
    }
    return wanted;
}

}  // namespace lensprof
