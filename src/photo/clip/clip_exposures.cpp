#include "photo/clip/clip_exposures.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "fit/base/joined_sets.hpp"
#include "fit/base/location.hpp"

namespace lensprof {
namespace {

constexpr uint32_t longest_lag = 256;
constexpr size_t least_shared = 10;  // scene points of a ratio
constexpr double darkest = 8.0 / 255.0, brightest = 250.0 / 255.0;
constexpr double value_sigma = 0.7 / 255.0;     // of the mean of a patch
constexpr double point_sigma_ev = 0.02;         // of a scene point seen from elsewhere
constexpr double least_ratio_sigma_ev = 0.002;  // what all points of a ratio have in common

// Light of an observation, EV, and its variance; NaN where the value does not show it.
struct Light {
    std::array<double, 3> ev, variance;
};

// What a frame shows.
struct Seen {
    ClipObservations observations;
    std::vector<Light> lights;
};

std::vector<Light> lights_of(const ClipObservations &observations, const ClipModel &model, const VideoInfo &info) {
    std::vector<Light> lights;
    for (const ClipObservation &observation : observations) {
        Light light{{NAN, NAN, NAN}, {}};
        for (size_t c = 0; c < 3; c++) {
            const double value = observation.value[c];
            if (!(value >= darkest && value <= brightest)) continue;
            double slope = 0.0;
            const double irradiance = lensprof_response_invert(&model.response, value, &slope);
            const double r2 = lensprof_vignetting_r2(&model.falloff[c], info.width, info.height, observation.x,
                                                     observation.y, nullptr);
            const double falloff = lensprof_vignetting_eval(&model.falloff[c], r2, nullptr);
            if (!(irradiance > 0.0 && falloff > 0.0)) continue;
            const double sigma = slope * value_sigma / irradiance / std::log(2.0);
            light.ev[c] = std::log2(irradiance / falloff);
            light.variance[c] = sigma * sigma + 0.5 * point_sigma_ev * point_sigma_ev;
        }
        lights.push_back(light);
    }
    return lights;
}

// Changes of light of the points that two frames show.
struct Differences {
    std::vector<float> ev, weight;
};

// The ratio of two frames: in green over all scene points that both show; the other channels relative to it.
bool find_ratio(const Differences (&differences)[3], ChainRatio &ratio) {
    constexpr double narrowest_ev = 0.004;
    const auto &[red, green, blue] = differences;
    if (green.ev.size() < least_shared) return false;
    const Location level = locate(green.ev, green.weight, narrowest_ev);
    const double sigma = level.spread / std::sqrt(static_cast<double>(std::max<size_t>(level.inside, 1)));
    ratio.ev.fill(level.middle);
    ratio.sigma = std::hypot(sigma, least_ratio_sigma_ev);
    for (const size_t c : {size_t(0), size_t(2)})
        if (differences[c].ev.size() >= least_shared)
            ratio.ev[c] += locate(differences[c].ev, differences[c].weight, narrowest_ev).middle;
    return true;
}

// Of the points that both frames show: the change in green, and those of red and blue relative to it.
void find_differences(const Seen &first, const Seen &second, Differences (&differences)[3]) {
    for (Differences &of_channel : differences) of_channel.ev.clear(), of_channel.weight.clear();
    for_shared_tracks(first.observations, second.observations, [&](const ClipObservation &a, const ClipObservation &b) {
        const Light &from = first.lights[size_t(&a - first.observations.data())],
                    &to = second.lights[size_t(&b - second.observations.data())];
        const double green = to.ev[1] - from.ev[1];
        if (!std::isfinite(green)) return;
        for (size_t c = 0; c < 3; c++) {
            const double ev = to.ev[c] - from.ev[c] - (c == 1 ? 0.0 : green);
            if (!std::isfinite(ev)) continue;
            differences[c].ev.push_back(static_cast<float>(ev));
            differences[c].weight.push_back(static_cast<float>(1.0 / (from.variance[c] + to.variance[c])));
        }
    });
}

// Ratios over 1, 2, 4, ... frames. What biases a ratio of neighbours, such as an encoder that follows changes late,
// biases the next ones alike: ratios over longer distances count more.
std::vector<ChainRatio> ratios_of(const ClipTracks &clip, const ClipModel &model) {
    std::vector<ChainRatio> ratios;
    std::vector<Seen> seen(longest_lag + 1);  // the last frames
    const auto seen_in = [&](uint32_t i) -> Seen & { return seen[i % seen.size()]; };
    Differences differences[3];
    for (uint32_t i = 0; i < clip.frames.size(); i++) {
        seen_in(i).observations = clip.observations_of(i);
        seen_in(i).lights = lights_of(seen_in(i).observations, model, clip.info);
        for (uint32_t lag = 1; lag <= std::min(longest_lag, i); lag *= 2) {
            find_differences(seen_in(i - lag), seen_in(i), differences);
            ChainRatio ratio{i - lag, i, {}, 0.0, static_cast<double>(lag) / longest_lag};
            if (find_ratio(differences, ratio)) ratios.push_back(ratio);
        }
    }
    return ratios;
}

// Sets states and segments of the frames that ratios connect. Returns the first frame of each one's segment.
std::vector<uint32_t> find_segments(const std::vector<ChainRatio> &ratios, ClipTracks &clip) {
    const auto count = static_cast<uint32_t>(clip.frames.size());
    JoinedSets sets(count);
    for (const ChainRatio &ratio : ratios) sets.join(ratio.from, ratio.to);
    std::vector<uint32_t> first(count, UINT32_MAX), set_of(count), size(count, 0);
    for (uint32_t i = 0; i < count; i++) size[sets.of(i)]++;
    uint32_t segments = 0;
    std::vector<uint32_t> number(count, 0);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t &of_set = first[sets.of(i)];
        const bool is_alone = size[sets.of(i)] < 2;
        if (of_set == UINT32_MAX) of_set = i, number[i] = is_alone ? segments : segments++;
        set_of[i] = of_set;
        clip.frames[i].segment = clip.frames[i].group = number[of_set];
        if (clip.frames[i].state != ClipState::blank)
            clip.frames[i].state = is_alone ? ClipState::unlinked : ClipState::measured;
    }
    return set_of;
}

using Levels = std::vector<std::array<double, 3>>;

// The levels less the means of measured frames with the same number in `group_of`.
Levels relative(Levels levels, const std::vector<uint32_t> &group_of, const ClipTracks &clip) {
    struct Sum {
        std::array<double, 3> ev{};
        double frames = 0.0;
    };
    std::map<uint32_t, Sum> sums;
    for (uint32_t i = 0; i < levels.size(); i++) {
        if (clip.frames[i].state != ClipState::measured) continue;
        Sum &sum = sums[group_of[i]];
        for (size_t c = 0; c < 3; c++) sum.ev[c] += levels[i][c];
        sum.frames++;
    }
    for (uint32_t i = 0; i < levels.size(); i++)
        for (size_t c = 0; c < 3; c++) levels[i][c] -= sums[group_of[i]].ev[c] / sums[group_of[i]].frames;
    return levels;
}

void set_exposures(const Levels &levels, ClipTracks &clip) {
    for (uint32_t i = 0; i < levels.size(); i++) {
        lensprof_exposure &exposure = clip.frames[i].exposure;
        lensprof_exposure_init(&exposure);
        exposure.ev = NAN;
        if (clip.frames[i].state != ClipState::measured) continue;
        exposure.ev = levels[i][1];
        for (const size_t c : {size_t(0), size_t(2)})
            exposure.white_balance[c] = std::exp2(levels[i][c] - levels[i][1]);
    }
}

}  // namespace

KnownAgreement find_exposures(const ClipModel &model, const KnownLevels &known, ClipTracks &clip) {
    const std::vector<ChainRatio> ratios = ratios_of(clip, model);
    std::vector<uint32_t> group_of = find_segments(ratios, clip);
    std::vector<uint8_t> is_anchor(clip.frames.size());
    for (uint32_t i = 0; i < is_anchor.size(); i++) is_anchor[i] = group_of[i] == i;
    set_exposures(relative(chained_levels(ratios, is_anchor, 1), group_of, clip), clip);
    for (const ChainRatio &ratio : ratios)
        if (ratio.to == ratio.from + 1) clip.frames[ratio.to].ev_sigma = ratio.sigma;
    const KnownAgreement agreement = agreement_with(known.ev, model.is_exponent_open, clip);
    if (known.ev.empty() || !agreement.is_good()) return agreement;
    // The known exposures hold what the ratios add up to, and connect the segments.
    std::vector<uint8_t> is_known(clip.frames.size(), 0);
    for (uint32_t i = 0; i < is_known.size(); i++) is_known[group_of[i]] |= std::isfinite(known.ev[i]);
    uint32_t joined = UINT32_MAX;
    for (uint32_t i = 0; i < is_known.size(); i++) {
        const uint32_t first = group_of[i];
        if (!is_known[first]) continue;
        is_anchor[first] = 0;
        joined = std::min(joined, first);
    }
    for (uint32_t i = 0; i < group_of.size(); i++) {
        if (!is_known[group_of[i]]) continue;
        group_of[i] = joined;
        clip.frames[i].group = clip.frames[joined].segment;
    }
    const Levels held = relative(chained_levels(ratios, is_anchor, 1, known), group_of, clip);
    for (uint32_t i = 0; i < held.size(); i++)
        if (clip.frames[i].state == ClipState::measured) clip.frames[i].exposure.ev = held[i][1];
    return agreement;
}

}  // namespace lensprof
