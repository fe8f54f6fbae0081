// How much the colours of scene points differ between pictures, before and after corrections.
#include "photo/base/library.hpp"
#include "photo/calibration/scene_fit.hpp"

namespace lensprof {
namespace {

std::vector<double> differences_before(const FitInput &input) {
    constexpr double white = 255.0;
    std::vector<double> differences;
    for (const lensprof_pair &pair : input.pairs) {
        double sum = 0.0;
        for (uint32_t c = 0; c < input.options.channels; c++) {
            const double difference = white * (double(pair.value[0][c]) - double(pair.value[1][c]));
            sum += 0.5 * difference * difference;
        }
        differences.push_back(sum / input.options.channels);
    }
    return differences;
}

std::vector<double> differences_with(const Fitted &fitted, const FitInput &input, const std::string &item) {
    std::vector<double> differences(input.pairs.size());
    lensprof_error error{};
    check(lensprof_fit_colour_differences(fitted.held.get(), input.pairs.data(),
                                          static_cast<uint32_t>(input.pairs.size()), differences.data(), &error),
          item, &error);
    return differences;
}

// The result if response and falloff were unknown, as the library compares it: the typical response of the kind of
// camera, and no falloff, where these are free.
Fitted fit_exposures_only(FitInput input, uint32_t reference, const std::string &item, Events &progress) {
    if (input.options.free & LENSPROF_FREE_RESPONSE)
        check(lensprof_response_set_typical(&input.fixed, input.options.camera_kind, nullptr, nullptr), item);
    input.options.response = &input.fixed;
    if (input.options.free & LENSPROF_FREE_FALLOFF) input.options.vignetting = lensprof_vignetting{};
    input.options.profile = nullptr;
    input.options.free = 0;
    input.points.clear(), input.view_distances.clear();
    for (lensprof_fit_image &image : input.images) image.setting = image.camera = 0;
    return fit(input, reference, item, progress, nullptr);
}

}  // namespace

std::vector<GainCurve> gain_curves(SceneFit &state) {
    std::vector<GainCurve> curves = {{"before", differences_before(state.input)}};
    if (state.best.result.colour_variance_exposures_only != LENSPROF_UNKNOWN) {
        const Fitted only = fit_exposures_only(state.input, state.report.reference, state.item, state.events);
        curves.push_back({"exposures alone", differences_with(only, state.input, state.item)});
    }
    curves.push_back({"this result", differences_with(state.best, state.input, state.item)});
    return curves;
}

}  // namespace lensprof
