#include "photo/clip/clip_exposures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "fit/base/joined_sets.hpp"
#include "fit/base/quantile.hpp"

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

std::vector<Light> lights_of(const ClipFrame &frame, const ClipModel &model, const VideoInfo &info) {
    std::vector<Light> lights;
    for (const ClipObservation &observation : frame.observations) {
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

struct Ratio {
    uint32_t frames[2];
    double ev = 0.0, variance = 0.0;
};

struct Difference {
    double ev, weight;
};

// Tukey's mean: differences beyond 4.7 standard deviations have no weight.
bool robust_mean(std::vector<Difference> &differences, double &mean, double &variance) {
    if (differences.size() < least_shared) return false;
    std::vector<double> values;
    for (const Difference &difference : differences) values.push_back(difference.ev);
    mean = upper_median(values);
    double scale = 0.0, sum = 0.0, squares = 0.0;
    for (int round = 0; round < 8; round++) {
        if (round < 2) {
            values.clear();
            for (const Difference &difference : differences) values.push_back(std::abs(difference.ev - mean));
            scale = std::max(1.4826 * upper_median(values), 0.004);
        }
        double total = 0.0;
        sum = squares = 0.0;
        for (const Difference &difference : differences) {
            const double u = (difference.ev - mean) / (4.685 * scale);
            if (std::abs(u) >= 1.0) continue;
            const double weight = difference.weight * (1.0 - u * u) * (1.0 - u * u);
            sum += weight, squares += weight * weight, total += weight * difference.ev;
        }
        if (!(sum > 0.0)) return false;
        mean = total / sum;
    }
    variance = scale * scale * squares / (sum * sum) + least_ratio_sigma_ev * least_ratio_sigma_ev;
    return true;
}

// Ratios of all pairs of frames in one channel.
std::vector<Ratio> ratios_of(const ClipTracks &clip, const std::vector<std::vector<Light>> &lights, size_t channel) {
    std::vector<Ratio> ratios;
    std::vector<Difference> differences;
    for (uint32_t i = 1; i < clip.frames.size(); i++)
        for (uint32_t lag = 1; lag <= std::min(longest_lag, i); lag *= 2) {
            const ClipFrame &first = clip.frames[i - lag], &second = clip.frames[i];
            differences.clear();
            for_shared_tracks(first, second, [&](const ClipObservation &a, const ClipObservation &b) {
                const Light &from = lights[i - lag][size_t(&a - first.observations.data())],
                            &to = lights[i][size_t(&b - second.observations.data())];
                const double ev = to.ev[channel] - from.ev[channel];
                if (std::isfinite(ev))
                    differences.push_back({ev, 1.0 / (from.variance[channel] + to.variance[channel])});
            });
            Ratio ratio{{i - lag, i}};
            if (robust_mean(differences, ratio.ev, ratio.variance)) ratios.push_back(ratio);
        }
    return ratios;
}

// Exposures of the frames, of which each segment's first is 0. Ratios that contradict the others lose weight.
std::vector<double> solved(const std::vector<Ratio> &ratios, const std::vector<uint32_t> &set_of) {
    const auto count = static_cast<Eigen::Index>(set_of.size());
    Eigen::VectorXd ev = Eigen::VectorXd::Zero(count);
    for (int round = 0; round < 4; round++) {
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
        for (Eigen::Index i = 0; i < count; i++)
            entries.emplace_back(i, i, set_of[size_t(i)] == uint32_t(i) ? 1e12 : 1e-9);
        for (const Ratio &ratio : ratios) {
            const auto a = Eigen::Index(ratio.frames[0]), b = Eigen::Index(ratio.frames[1]);
            const double error = (ev[b] - ev[a] - ratio.ev) / std::sqrt(ratio.variance);
            const double weight = (round ? 1.0 / (1.0 + error * error / 9.0) : 1.0) / ratio.variance;
            entries.emplace_back(a, a, weight), entries.emplace_back(b, b, weight);
            entries.emplace_back(a, b, -weight), entries.emplace_back(b, a, -weight);
            right[a] -= weight * ratio.ev, right[b] += weight * ratio.ev;
        }
        Eigen::SparseMatrix<double> matrix(count, count);
        matrix.setFromTriplets(entries.begin(), entries.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
        ev = solver.solve(right);
    }
    return {ev.data(), ev.data() + count};
}

// Sets states and segments of the frames that ratios connect. Returns the first frame of each one's segment.
std::vector<uint32_t> find_segments(const std::vector<Ratio> &ratios, ClipTracks &clip) {
    const auto count = static_cast<uint32_t>(clip.frames.size());
    JoinedSets sets(count);
    for (const Ratio &ratio : ratios) sets.join(ratio.frames[0], ratio.frames[1]);
    std::vector<uint32_t> first(count, UINT32_MAX), set_of(count), size(count, 0);
    for (uint32_t i = 0; i < count; i++) size[sets.of(i)]++;
    uint32_t segments = 0;
    std::vector<uint32_t> number(count, 0);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t &of_set = first[sets.of(i)];
        const bool is_alone = size[sets.of(i)] < 2;
        if (of_set == UINT32_MAX) of_set = i, number[i] = is_alone ? segments : segments++;
        set_of[i] = of_set;
        clip.frames[i].segment = number[of_set];
        if (clip.frames[i].state != ClipState::blank)
            clip.frames[i].state = is_alone ? ClipState::unlinked : ClipState::measured;
    }
    return set_of;
}

}  // namespace

void find_exposures(const ClipModel &model, ClipTracks &clip) {
    std::vector<std::vector<Light>> lights;
    for (const ClipFrame &frame : clip.frames) lights.push_back(lights_of(frame, model, clip.info));
    const std::vector<Ratio> green = ratios_of(clip, lights, 1);
    const std::vector<uint32_t> set_of = find_segments(green, clip);
    std::array<std::vector<double>, 3> ev;
    for (size_t c = 0; c < 3; c++) {
        if (c != 1 && clip.channels == 1) continue;
        ev[c] = solved(c == 1 ? green : ratios_of(clip, lights, c), set_of);
    }
    if (clip.channels == 1) ev[0] = ev[2] = ev[1];
    struct Sum {
        std::array<double, 3> ev{};
        double frames = 0.0;
    };
    std::map<uint32_t, Sum> sums;
    for (uint32_t i = 0; i < set_of.size(); i++) {
        for (size_t c = 0; c < 3; c++) sums[set_of[i]].ev[c] += ev[c][i];
        sums[set_of[i]].frames++;
    }
    for (uint32_t i = 0; i < set_of.size(); i++) {
        ClipFrame &frame = clip.frames[i];
        const Sum &sum = sums[set_of[i]];
        const auto relative = [&](size_t c) { return ev[c][i] - sum.ev[c] / sum.frames; };
        lensprof_exposure_init(&frame.exposure);
        frame.exposure.ev = frame.state == ClipState::measured ? relative(1) : NAN;
        if (frame.state != ClipState::measured) continue;
        for (const size_t c : {size_t(0), size_t(2)})
            frame.exposure.white_balance[c] = std::exp2(relative(c) - relative(1));
    }
    for (const Ratio &ratio : green)
        if (ratio.frames[1] == ratio.frames[0] + 1) clip.frames[ratio.frames[1]].ev_sigma = std::sqrt(ratio.variance);
}

}  // namespace lensprof
