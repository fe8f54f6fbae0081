#include "cli/fitting/exposures_only.hpp"

#include <algorithm>
#include <cmath>

#include "cli/fitting/project.hpp"

namespace lensprof {
namespace {

constexpr double kCountedShare = 0.9;  // of the pairs: the others may show different things

// Corrects grey values of the pictures to the mean exposure by a result.
class Corrector {
public:
    Corrector(const FitInput &input, const Fitted &fitted)
        : input_(input), fitted_(fitted), mean_(mean_exposure(fitted.exposures)) {}

    bool has(uint32_t image) const { return !std::isnan(fitted_.exposures[image].ev); }

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

// The mean of the smallest share of the values; 0 of none.
double trimmed_mean(std::vector<double> values) {
    const auto count = static_cast<size_t>(kCountedShare * static_cast<double>(values.size()));
    if (!count) return 0.0;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count - 1), values.end());
    double sum = 0.0;
    for (size_t n = 0; n < count; n++) sum += values[n];
    return sum / static_cast<double>(count);
}

}  // namespace

Fitted fit_exposures_only(FitInput input, uint32_t reference, const std::string &item, Progress &progress) {
    lensprof_error error{};
    check(lensprof_response_set_typical(&input.fixed, input.options.camera_kind, nullptr, nullptr), item, &error);
    input.options.response = &input.fixed;
    input.options.vignetting = lensprof_vignetting{};
    input.options.profile = nullptr;
    input.options.free = 0;
    for (lensprof_fit_image &image : input.images) image.setting = image.camera = 0;
    return fit(input, reference, item, progress, nullptr);
}

bool is_joint_better(const Fitted &joint, const Fitted &exposures_only) {
    const double own = joint.result.heldout_median, other = exposures_only.result.heldout_median;
    return own == LENSPROF_UNKNOWN || other == LENSPROF_UNKNOWN || own < other;
}

ColourVariance colour_variance(const FitInput &input, const Fitted &result, const Fitted &exposures_only) {
    const Corrector by_result(input, result), by_exposures(input, exposures_only);
    std::vector<double> before, only, after;
    const auto half_square = [](double a, double b) { return 0.5 * (a - b) * (a - b); };
    for (const lensprof_pair &pair : input.pairs) {
        bool is_known = true;
        for (const uint32_t image : pair.image) is_known = is_known && by_result.has(image) && by_exposures.has(image);
        if (!is_known) continue;
        double sum[3] = {};
        for (int c = 0; c < static_cast<int>(input.options.channels); c++) {
            sum[0] += half_square(255.0 * pair.value[0][c], 255.0 * pair.value[1][c]);
            sum[1] += half_square(by_exposures.level(pair, 0, c), by_exposures.level(pair, 1, c));
            sum[2] += half_square(by_result.level(pair, 0, c), by_result.level(pair, 1, c));
        }
        before.push_back(sum[0] / input.options.channels);
        only.push_back(sum[1] / input.options.channels);
        after.push_back(sum[2] / input.options.channels);
    }
    return {trimmed_mean(before), trimmed_mean(only), trimmed_mean(after), before.size()};
}

}  // namespace lensprof
