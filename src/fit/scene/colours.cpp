#include "fit/scene/colours.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace lensprof {
namespace {

constexpr double kCountedShare = 0.9;  // of the pairs: the others may show different objects
constexpr double kWhite = 255.0;

lensprof_exposure mean_exposure(const lensprof_exposure *exposures, uint32_t count) {
    lensprof_exposure mean{};
    double logs[3] = {}, known = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        if (std::isnan(exposures[i].ev)) continue;
        mean.ev += exposures[i].ev, known++;
        for (int c = 0; c < 3; c++) logs[c] += std::log(exposures[i].white_balance[c]);
    }
    mean.ev /= known;
    for (int c = 0; c < 3; c++) mean.white_balance[c] = std::exp(logs[c] / known);
    return mean;
}

// Corrects grey values to the mean exposure, as seen by the camera of the reference.
class Corrector {
public:
    explicit Corrector(const ColourCorrection &by)
        : by_(by), mean_(mean_exposure(by.exposures, static_cast<uint32_t>(by.responses.size()))) {}

    double level(const lensprof_pair &pair, int side, int channel) const {
        const uint32_t image = pair.image[side];
        const lensprof_exposure &exposure = by_.exposures[image];
        const lensprof_vignetting &falloff = by_.falloffs[image][channel];
        const double r2 = lensprof_vignetting_r2(&falloff, by_.images[image].width, by_.images[image].height,
                                                 pair.xy[side][0], pair.xy[side][1], nullptr);
        const double gain = std::exp2(mean_.ev - exposure.ev) * mean_.white_balance[channel]
                            / exposure.white_balance[channel] / lensprof_vignetting_eval(&falloff, r2, nullptr);
        const double irradiance = lensprof_response_invert(by_.responses[image], pair.value[side][channel], nullptr);
        return kWhite * lensprof_response_eval(by_.responses[by_.reference], irradiance * gain, nullptr);
    }

private:
    const ColourCorrection &by_;
    const lensprof_exposure mean_;
};

}  // namespace

ColourCorrection::ColourCorrection(const FitCall &call, const lensprof_exposure *found)
    : images(call.images.data()), exposures(found), reference(call.result.reference) {
    for (uint32_t i = 0; i < call.count(); i++)
        responses.push_back(&call.response_of(i)), falloffs.push_back(call.falloff_of(i));
}

std::vector<double> colour_differences(const lensprof_pair *pairs, size_t count, int channels,
                                       const ColourCorrection *correction) {
    std::optional<Corrector> corrector;
    if (correction) corrector.emplace(*correction);
    std::vector<double> differences;
    for (size_t p = 0; p < count; p++) {
        const lensprof_pair &pair = pairs[p];
        double sum = 0.0;
        for (int c = 0; c < channels; c++) {
            const auto level = [&](int side) {
                return corrector ? corrector->level(pair, side, c) : kWhite * pair.value[side][c];
            };
            const double difference = level(0) - level(1);  // NaN if an exposure is NaN
            sum += 0.5 * difference * difference;
        }
        differences.push_back(sum / channels);
    }
    return differences;
}

double colour_variance(std::vector<double> differences) {
    differences.erase(std::remove_if(differences.begin(), differences.end(), [](double d) { return std::isnan(d); }),
                      differences.end());
    const auto count = static_cast<std::ptrdiff_t>(kCountedShare * static_cast<double>(differences.size()));
    if (!count) return 0.0;
    std::nth_element(differences.begin(), differences.begin() + count - 1, differences.end());
    return std::accumulate(differences.begin(), differences.begin() + count, 0.0) / static_cast<double>(count);
}

}  // namespace lensprof
