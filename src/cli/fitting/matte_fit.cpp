#include "cli/fitting/matte_fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "cli/fitting/project.hpp"

namespace lensprof {
namespace {

constexpr double kCountedShare = 0.9;      // of the pairs: the others may show different things
constexpr double kMatteShare = 0.75;       // of the points
constexpr double kMostDifference = 400.0;  // levels squared that count of one pair
constexpr double kSameExposure = 0.002;    // EV
constexpr int kMostRounds = 6;
constexpr size_t kGreyBins = 8;

// Corrects grey values of the pictures to the mean exposure by a result.
class Corrector {
public:
    Corrector(const FitInput &input, const Fitted &fitted)
        : input_(input), fitted_(fitted), mean_(mean_exposure(fitted.exposures)) {}

    double level(const lensprof_pair &pair, int side, int channel) const {
        const uint32_t image = pair.image[side];
        const lensprof_exposure &own = fitted_.exposures[image];
        const lensprof_response &response = fitted_.response_of(image);
        const lensprof_vignetting &falloff =
            fitted_.falloff_of(image)[fitted_.falloff_curves_of(image) == 3 ? channel : 0];
        const double r2 = lensprof_vignetting_r2(&falloff, input_.images[image].width, input_.images[image].height,
                                                 pair.xy[side][0], pair.xy[side][1], nullptr);
        const double gain = std::exp2(mean_.ev - own.ev) * mean_.white_balance[channel] / own.white_balance[channel]
                            / lensprof_vignetting_eval(&falloff, r2, nullptr);
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
    const double own = joint.result.heldout_median, other = exposures_only.result.heldout_median;
    return own == LENSPROF_UNKNOWN || other == LENSPROF_UNKNOWN || own < other;
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
            const double difference = level(0) - level(1);  // NaN where an exposure is
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

// Of each pair whether its point is among the share of the points whose colours differ least, of those of about its
// grey value: where the response is flat, as near white, all differences are small.
std::vector<bool> are_matte(const std::vector<lensprof_pair> &pairs, const std::vector<double> &differences,
                            const std::vector<uint32_t> &points) {
    struct Point {
        double difference = 0.0, grey = 0.0, count = 0.0;
        size_t bin() const { return std::min(kGreyBins - 1, static_cast<size_t>(grey / count * kGreyBins)); }
    };
    std::vector<Point> all(1 + *std::max_element(points.begin(), points.end()));
    for (size_t p = 0; p < points.size(); p++) {
        Point &own = all[points[p]];
        own.difference += std::isnan(differences[p]) ? kMostDifference : std::min(differences[p], kMostDifference);
        own.grey += 0.5 * (pairs[p].value[0][1] + pairs[p].value[1][1]);
        own.count++;
    }
    std::vector<double> of_bin[kGreyBins];
    for (const Point &own : all)
        if (own.count > 0.0) of_bin[own.bin()].push_back(own.difference / own.count);
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

// The largest difference of two results' exposures, EV; images that one of them lacks count as much.
double largest_change(const Fitted &a, const Fitted &b) {
    double largest = 0.0;
    for (size_t i = 0; i < a.exposures.size(); i++) {
        const double x = a.exposures[i].ev, y = b.exposures[i].ev;
        if (std::isnan(x) && std::isnan(y)) continue;
        largest = std::max(largest, std::isnan(x - y) ? HUGE_VAL : std::fabs(x - y));
    }
    return largest;
}

}  // namespace

Fitted fit_matte_points(FitInput &input, const std::vector<uint32_t> &points, const Fitted &first, uint32_t reference,
                        const std::string &item, Progress &progress, std::vector<lensprof_fit_image_quality> *quality) {
    const std::vector<lensprof_pair> all = input.pairs;
    std::vector<lensprof_pair> fitted = all;
    Fitted best = first;
    bool stays = false;
    const uint32_t modes = input.options.modes, vignettings = input.options.vignettings;
    const bool is_of_one = std::all_of(input.images.begin(), input.images.end(), [&](const lensprof_fit_image &image) {
        return image.camera == input.images[0].camera;
    });
    if (is_of_one) {  // held-out pairs have chosen these already
        if (modes == LENSPROF_MODES_AUTO) input.options.modes = first.result.response.modes;
        if (vignettings == 0) input.options.vignettings = first.result.vignettings;
    }
    for (int round = 0; round < kMostRounds && !stays; round++) {
        input.pairs = all;
        const std::vector<bool> matte = are_matte(all, colour_differences(input, &best), points);
        input.pairs.clear();
        for (size_t p = 0; p < all.size(); p++)
            if (matte[p]) input.pairs.push_back(all[p]);
        std::vector<lensprof_fit_image_quality> own;
        std::optional<Fitted> next;
        try {
            next = fit(input, reference, item, progress, &own);
        } catch (const Failure &failure) {
            if (failure.code != ExitCode::not_usable) throw;
        }
        if (!next || joined_images(*next) < joined_images(best)) break;  // some images have too few matte points
        stays = largest_change(*next, best) < kSameExposure;
        best = *next, fitted = input.pairs;
        if (quality) *quality = own;
    }
    input.pairs = fitted;
    input.options.modes = modes, input.options.vignettings = vignettings;
    return best;
}

}  // namespace lensprof
