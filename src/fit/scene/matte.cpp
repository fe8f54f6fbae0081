#include "fit/scene/matte.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lensprof {
namespace {

constexpr double kMatteShare = 0.75;          // of the points
constexpr double kMaxDifference = 400.0;      // levels of 255 squared counted per pair, at most
constexpr double kExposureTolerance = 0.002;  // EV
constexpr int kMaxRounds = 6;
constexpr size_t kGreyBins = 8;

// Whether the point of each pair is in the share of points whose colours differ least, among those of similar grey
// value: where the response is flat, as near white, all differences are small.
std::vector<bool> are_matte(const SceneData &data, int channels, const std::vector<double> &differences) {
    struct Point {
        double difference = 0.0, grey = 0.0, count = 0.0;
        size_t bin() const { return static_cast<size_t>(std::clamp(grey / count * kGreyBins, 0.0, kGreyBins - 1.0)); }
    };
    const int channel = channels == 1 ? 0 : 1;
    std::vector<uint32_t> numbers = data.points;
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    std::vector<Point> all(numbers.size());
    const auto point_of = [&](size_t p) -> Point & {
        return all[size_t(std::lower_bound(numbers.begin(), numbers.end(), data.points[p]) - numbers.begin())];
    };
    for (size_t p = 0; p < data.points.size(); p++) {
        Point &point = point_of(p);
        point.difference += std::isnan(differences[p]) ? kMaxDifference : std::min(differences[p], kMaxDifference);
        point.grey += 0.5 * (data.pairs[p].value[0][channel] + data.pairs[p].value[1][channel]);
        point.count++;
    }
    std::vector<double> of_bin[kGreyBins];
    for (const Point &point : all)
        if (point.count > 0.0) of_bin[point.bin()].push_back(point.difference / point.count);
    double limit[kGreyBins] = {};
    for (size_t bin = 0; bin < kGreyBins; bin++) {
        auto &means = of_bin[bin];
        if (means.empty()) continue;
        const auto last = means.begin() + static_cast<std::ptrdiff_t>(kMatteShare * double(means.size() - 1));
        std::nth_element(means.begin(), last, means.end());
        limit[bin] = *last;
    }
    std::vector<bool> matte;
    for (size_t p = 0; p < data.points.size(); p++) {
        const Point &point = point_of(p);
        matte.push_back(point.difference / point.count <= limit[point.bin()]);
    }
    return matte;
}

template <class Filter>
SceneData data_where(const SceneData &data, const Filter &is_selected) {
    SceneData selected;
    for (size_t p = 0; p < data.pairs.size(); p++)
        if (is_selected(p)) selected.pairs.push_back(data.pairs[p]), selected.points.push_back(data.points[p]);
    return selected;
}

// The largest difference of exposures between two fits, EV; images missing from one of them count as much.
double largest_change(const SceneFit &a, const SceneFit &b) {
    double largest = 0.0;
    for (size_t i = 0; i < a.exposures.size(); i++) {
        const double x = a.exposures[i].ev, y = b.exposures[i].ev;
        if (std::isnan(x) && std::isnan(y)) continue;
        largest = std::max(largest, std::isnan(x - y) ? HUGE_VAL : std::fabs(x - y));
    }
    return largest;
}

// A fit like another, with the modes and curves that held-out pairs chose there, for one camera.
SceneFit fit_like(const SceneFit &chosen) {
    SceneFit next(*chosen.call, chosen.exposures.data());
    lensprof_fit_options &options = next.call->options;
    const auto &images = next.call->images;
    const auto is_of_first = [&](const auto &image) { return image.camera == images[0].camera; };
    if (!std::all_of(images.begin(), images.end(), is_of_first)) return next;
    if (options.modes == LENSPROF_MODES_AUTO) options.modes = chosen.call->result.response.modes;
    if (options.vignettings == 0) options.vignettings = chosen.call->result.vignettings;
    return next;
}

bool run(const FitPairs &fit, const SceneData &data, SceneFit &next) {
    return fit(*next.call, data.pairs, next.exposures.data());
}

// The root mean square difference of exposures and white balances between two fits, each without its mean and without
// the part explained by an exponent: EV, and logarithms of red and blue.
std::array<double, 3> differences_of(const SceneFit &a, const SceneFit &b) {
    std::array<double, 3> rms{};
    for (size_t component = 0; component < 3; component++) {
        std::vector<std::array<double, 2>> values;
        std::array<double, 2> mean{};
        for (size_t i = 0; i < a.exposures.size(); i++) {
            const lensprof_exposure &x = a.exposures[i], &y = b.exposures[i];
            if (std::isnan(x.ev) || std::isnan(y.ev)) continue;
            const size_t c = 2 * (component - 1);
            values.push_back(component
                                 ? std::array<double, 2>{std::log(x.white_balance[c]), std::log(y.white_balance[c])}
                                 : std::array<double, 2>{x.ev, y.ev});
            for (size_t k = 0; k < 2; k++) mean[k] += values.back()[k];
        }
        double across = 0.0, along = 1e-30, sum = 0.0;
        for (auto &value : values) {
            for (size_t k = 0; k < 2; k++) value[k] -= mean[k] / double(values.size());
            across += value[0] * value[1], along += value[0] * value[0];
        }
        for (const auto &value : values) sum += std::pow(value[1] - value[0] * across / along, 2.0);
        rms[component] = values.size() > 2 ? std::sqrt(sum / double(values.size() - 2)) : 0.0;
    }
    return rms;
}

}  // namespace

void leave_out_glossy_points(const FitPairs &fit, SceneData &data, SceneFit &best) {
    const SceneData all = data;
    const SceneFit first = fit_like(best);
    bool is_converged = false;
    for (int round = 0; round < kMaxRounds && !is_converged; round++) {
        const std::vector<bool> matte = are_matte(all, best.call->channels(), best.differences(all));
        SceneData selected = data_where(all, [&](size_t p) { return matte[p]; });
        SceneFit next(*first.call, first.exposures.data());
        if (!run(fit, selected, next) || next.joined() < best.joined()) break;  // some images have too few matte points
        is_converged = largest_change(next, best) < kExposureTolerance;
        best = std::move(next), data = std::move(selected);
    }
}

void add_errors_by_halves(const SceneData &data, const FitPairs &fit, SceneFit &best) {
    SceneFit halves[2] = {fit_like(best), fit_like(best)};
    for (const uint32_t half : {0u, 1u}) {
        const auto is_selected = [&](size_t p) { return (data.points[p] * 2654435761u >> 31) == half; };  // by a hash
        if (!run(fit, data_where(data, is_selected), halves[half])) return;
    }
    const std::array<double, 3> rms = differences_of(halves[0], halves[1]);  // twice the error of the whole
    for (lensprof_fit_image_quality &entry : best.call->quality) {
        if (entry.ev_sigma > 0.0) entry.ev_sigma = std::hypot(entry.ev_sigma, 0.5 * rms[0]);
        for (const size_t c : {0u, 2u})
            if (entry.white_balance_sigma[c] > 0.0)
                entry.white_balance_sigma[c] = std::hypot(entry.white_balance_sigma[c], 0.5 * rms[c ? 2 : 1]);
    }
}

}  // namespace lensprof
