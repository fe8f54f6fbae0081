#include "cli/fitting/matte_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "cli/fitting/project.hpp"

namespace lensprof {
namespace {

constexpr double kCountedShare = 0.9;         // of the pairs: the others may show different objects
constexpr double kMatteShare = 0.75;          // of the points
constexpr double kMaxDifference = 400.0;      // maximum levels squared counted per pair
constexpr double kExposureTolerance = 0.002;  // EV
constexpr int kMaxRounds = 6;
constexpr size_t kGreyBins = 8;

// Corrects grey values of the pictures to the mean exposure with a result.
class Corrector {
public:
    Corrector(const FitInput &input, const Fitted &fitted)
        : input_(input), fitted_(fitted), mean_(mean_exposure(fitted.exposures)) {}

    double level(const lensprof_pair &pair, int side, int channel) const {
        const uint32_t image = pair.image[side];
        const lensprof_exposure &exposure = fitted_.exposures[image];
        const lensprof_response &response = fitted_.response_of(image);
        const lensprof_vignetting falloff =
            fitted_.falloff_of(image)[fitted_.falloff_curves_of(image) == 3 ? channel : 0];
        const double r2 = lensprof_vignetting_r2(&falloff, input_.images[image].width, input_.images[image].height,
                                                 pair.xy[side][0], pair.xy[side][1], nullptr);
        const double gain = std::exp2(mean_.ev - exposure.ev) * mean_.white_balance[channel]
                            / exposure.white_balance[channel] / lensprof_vignetting_eval(&falloff, r2, nullptr);
        const double light = lensprof_response_invert(&response, pair.value[side][channel], nullptr);
        return 255.0 * lensprof_response_eval(&fitted_.response_of(fitted_.reference), light * gain, nullptr);
    }

private:
    const FitInput &input_;
    const Fitted &fitted_;
    lensprof_exposure mean_;
};

}  // namespace

Fitted fit_exposures_only(FitInput input, uint32_t reference, const std::string &item, Progress &progress,
                          std::vector<lensprof_fit_image_quality> *quality) {
    lensprof_error error{};
    check(lensprof_response_set_typical(&input.fixed, input.options.camera_kind, nullptr, nullptr), item, &error);
    input.options.response = &input.fixed;
    input.options.vignetting = lensprof_vignetting{};
    input.options.profile = nullptr;
    input.options.free = 0;
    for (lensprof_fit_image &image : input.images) image.setting = image.camera = 0;
    return fit(input, reference, item, progress, quality);
}

bool is_joint_better(const Fitted &joint, const Fitted &exposures_only) {
    const double joint_median = joint.result.heldout_median,
                 exposures_only_median = exposures_only.result.heldout_median;
    return joint_median == LENSPROF_UNKNOWN || exposures_only_median == LENSPROF_UNKNOWN
           || joint_median < exposures_only_median;
}

std::vector<double> colour_differences(const FitInput &input, const Fitted *fitted) {
    const auto channels = static_cast<int>(input.options.channels);
    std::optional<Corrector> corrector;
    if (fitted) corrector.emplace(input, *fitted);
    std::vector<double> differences;
    for (const lensprof_pair &pair : input.pairs) {
        double sum = 0.0;
        for (int c = 0; c < channels; c++) {
            const auto level = [&](int side) {
                return corrector ? corrector->level(pair, side, c) : 255.0 * pair.value[side][c];
            };
            const double difference = level(0) - level(1);  // NaN if an exposure is NaN
            sum += 0.5 * difference * difference;
        }
        differences.push_back(sum / channels);
    }
    return differences;
}

double colour_variance_of(const std::vector<double> &differences) {
    std::vector<double> known;
    std::copy_if(differences.begin(), differences.end(), std::back_inserter(known),
                 [](double d) { return !std::isnan(d); });
    const auto count = static_cast<size_t>(kCountedShare * static_cast<double>(known.size()));
    if (!count) return 0.0;
    std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(count - 1), known.end());
    return std::accumulate(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(count), 0.0)
           / static_cast<double>(count);
}

namespace {

// Whether the point of each pair is in the share of points whose colours differ least, among those of similar grey
// value: where the response is flat, as near white, all differences are small.
std::vector<bool> are_matte(const std::vector<lensprof_pair> &pairs, const std::vector<double> &differences,
                            const std::vector<uint32_t> &points) {
    struct Point {
        double difference = 0.0, grey = 0.0, count = 0.0;
        size_t bin() const { return std::min(kGreyBins - 1, static_cast<size_t>(grey / count * kGreyBins)); }
    };
    std::vector<Point> all(1 + *std::max_element(points.begin(), points.end()));
    for (size_t p = 0; p < points.size(); p++) {
        Point &point = all[points[p]];
        point.difference += std::isnan(differences[p]) ? kMaxDifference : std::min(differences[p], kMaxDifference);
        point.grey += 0.5 * (pairs[p].value[0][1] + pairs[p].value[1][1]);
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
    for (const uint32_t point : points)
        matte.push_back(all[point].difference / all[point].count <= limit[all[point].bin()]);
    return matte;
}

// The largest difference of exposures between two results, EV; images missing from one of them count as much.
double largest_change(const Fitted &a, const Fitted &b) {
    double largest = 0.0;
    for (size_t i = 0; i < a.exposures.size(); i++) {
        const double x = a.exposures[i].ev, y = b.exposures[i].ev;
        if (std::isnan(x) && std::isnan(y)) continue;
        largest = std::max(largest, std::isnan(x - y) ? HUGE_VAL : std::fabs(x - y));
    }
    return largest;
}

// If held-out pairs need not choose modes and curves again: for one camera, whose result has chosen them.
class FixedChoices {
public:
    FixedChoices(FitInput &input, const Fitted &chosen)
        : options_(input.options), modes_(options_.modes), vignettings_(options_.vignettings) {
        const auto is_of_first = [&](const auto &image) { return image.camera == input.images[0].camera; };
        if (!std::all_of(input.images.begin(), input.images.end(), is_of_first)) return;
        if (modes_ == LENSPROF_MODES_AUTO) options_.modes = chosen.result.response.modes;
        if (vignettings_ == 0) options_.vignettings = chosen.result.vignettings;
    }
    ~FixedChoices() { options_.modes = modes_, options_.vignettings = vignettings_; }
    FixedChoices(const FixedChoices &) = delete;
    FixedChoices &operator=(const FixedChoices &) = delete;

private:
    lensprof_fit_options &options_;
    const uint32_t modes_, vignettings_;
};

// Fits the pairs for which is_selected(p) is true; empty if they are too few.
template <class Filter>
std::optional<Fitted> fit_subset(FitInput &input, const std::vector<lensprof_pair> &all, const Filter &is_selected,
                                 uint32_t reference, const std::string &item, Progress &progress,
                                 std::vector<lensprof_fit_image_quality> *quality) {
    input.pairs.clear();
    for (size_t p = 0; p < all.size(); p++)
        if (is_selected(p)) input.pairs.push_back(all[p]);
    try {
        return fit(input, reference, item, progress, quality);
    } catch (const Failure &failure) {
        if (failure.code != ExitCode::not_usable) throw;
        return {};
    }
}

// The root mean square difference of exposures and white balances between two results, each without its mean and
// without the part explained by an exponent: EV, and logarithms.
std::array<double, 3> differences_of(const Fitted &a, const Fitted &b) {
    std::array<double, 3> rms{};
    for (size_t component = 0; component < 3; component++) {  // EV, red, blue
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

Fitted fit_matte_points(FitInput &input, std::vector<uint32_t> &points, const Fitted &first, uint32_t reference,
                        const std::string &item, Progress &progress, std::vector<lensprof_fit_image_quality> *quality) {
    const std::vector<lensprof_pair> all = input.pairs;
    std::vector<lensprof_pair> fitted_pairs = all;
    std::vector<bool> is_fitted(all.size(), true);
    Fitted best = first;
    bool is_converged = false;
    const FixedChoices choices(input, first);
    for (int round = 0; round < kMaxRounds && !is_converged; round++) {
        input.pairs = all;
        const std::vector<bool> matte = are_matte(all, colour_differences(input, &best), points);
        std::vector<lensprof_fit_image_quality> round_quality;
        const auto is_selected = [&](size_t p) { return matte[p]; };
        const auto next = fit_subset(input, all, is_selected, reference, item, progress, &round_quality);
        if (!next || joined_images(*next) < joined_images(best)) break;  // some images have too few matte points
        is_converged = largest_change(*next, best) < kExposureTolerance;
        best = *next, fitted_pairs = input.pairs, is_fitted = matte;
        if (quality) *quality = round_quality;
    }
    input.pairs = fitted_pairs;
    size_t count = 0;
    for (size_t p = 0; p < points.size(); p++)
        if (is_fitted[p]) points[count++] = points[p];
    points.resize(count);
    return best;
}

void add_errors_by_halves(FitInput input, const std::vector<uint32_t> &points, const Fitted &result,
                          const std::string &item, Progress &progress,
                          std::vector<lensprof_fit_image_quality> &quality) {
    const FixedChoices choices(input, result);
    const std::vector<lensprof_pair> all = input.pairs;
    std::optional<Fitted> halves[2];
    for (const uint32_t half : {0u, 1u}) {
        const auto is_selected = [&](size_t p) { return (points[p] * 2654435761u >> 31) == half; };  // chosen by a hash
        halves[half] = fit_subset(input, all, is_selected, result.reference, item, progress, nullptr);
        if (!halves[half]) return;
    }
    const std::array<double, 3> rms = differences_of(*halves[0], *halves[1]);  // twice the error of the whole
    for (lensprof_fit_image_quality &entry : quality) {
        if (entry.ev_sigma > 0.0) entry.ev_sigma = std::hypot(entry.ev_sigma, 0.5 * rms[0]);
        for (const size_t c : {0u, 2u})
            if (entry.white_balance_sigma[c] > 0.0)
                entry.white_balance_sigma[c] = std::hypot(entry.white_balance_sigma[c], 0.5 * rms[c ? 2 : 1]);
    }
}

}  // namespace lensprof
