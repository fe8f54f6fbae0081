#include "fit/scene/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "fit/base/quantile.hpp"

namespace lensprof {
namespace {

constexpr double kCountedShare = 0.9;              // of the pairs: the others may show different objects
constexpr double kWhite = 255.0, kDarkest = 1e-6;  // irradiance

// Corrects grey values to the mean exposure, as seen by the camera of the reference.
class Corrector {
public:
    explicit Corrector(const ColourCorrection &by) : by_(by) {
        lensprof_exposure_mean(by.exposures, by.responses.size(), &mean_);
    }

    bool is_known(uint32_t image) const { return !std::isnan(by_.exposures[image].ev); }

    // Irradiance without falloff, at the exposure of the image.
    double irradiance(const lensprof_pair &pair, int side, int channel) const {
        const uint32_t image = pair.image[side];
        const lensprof_vignetting &falloff = by_.falloffs[image][channel];
        const double r2 = lensprof_vignetting_r2(&falloff, by_.images[image].width, by_.images[image].height,
                                                 pair.xy[side][0], pair.xy[side][1], nullptr);
        return lensprof_response_invert(by_.responses[image], pair.value[side][channel], nullptr)
               / lensprof_vignetting_eval(&falloff, r2, nullptr);
    }

    // From an image to the mean exposure; 1 for an unknown one.
    double gain(uint32_t image, int channel) const {
        const lensprof_exposure &exposure = by_.exposures[image];
        return is_known(image)
                   ? std::exp2(mean_.ev - exposure.ev) * mean_.white_balance[channel] / exposure.white_balance[channel]
                   : 1.0;
    }

    double level(double irradiance) const {
        return kWhite * lensprof_response_eval(by_.responses[by_.reference], irradiance, nullptr);
    }

private:
    const ColourCorrection &by_;
    lensprof_exposure mean_;
};

}  // namespace

namespace {

// Half the squared difference, mean over the channels.
template <class Difference>
double mean_of_channels(int channels, Difference difference) {
    double sum = 0.0;
    for (int c = 0; c < channels; c++) sum += 0.5 * difference(c) * difference(c);
    return sum / channels;
}

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
        const bool is_known = !corrector || (corrector->is_known(pair.image[0]) && corrector->is_known(pair.image[1]));
        const auto level = [&](int side, int c) {
            return corrector
                       ? corrector->level(corrector->irradiance(pair, side, c) * corrector->gain(pair.image[side], c))
                       : kWhite * pair.value[side][c];
        };
        differences.push_back(is_known ? mean_of_channels(channels, [&](int c) { return level(0, c) - level(1, c); })
                                       : NAN);
    }
    return differences;
}

void compare_unknown_exposures(const std::vector<lensprof_pair> &pairs, int channels,
                               const ColourCorrection &correction, std::vector<double> &differences) {
    const Corrector corrector(correction);
    std::map<std::array<uint32_t, 2>, std::vector<size_t>> links;
    for (size_t p = 0; p < pairs.size(); p++)
        if (std::isnan(differences[p])) links[{pairs[p].image[0], pairs[p].image[1]}].push_back(p);
    for (const auto &[images, numbers] : links) {
        const int known = corrector.is_known(images[0]) ? 0 : 1;
        double ratio[3] = {};  // ln of the irradiance at the known end over that at the other
        for (int c = 0; c < channels; c++) {
            std::vector<double> ratios;
            for (const size_t p : numbers)
                ratios.push_back(std::log(std::max(corrector.irradiance(pairs[p], known, c), kDarkest)
                                          / std::max(corrector.irradiance(pairs[p], 1 - known, c), kDarkest)));
            ratio[c] = median(ratios);
        }
        for (const size_t p : numbers)
            differences[p] = mean_of_channels(channels, [&, at = images[static_cast<size_t>(known)]](int c) {
                const double gain = corrector.gain(at, c);
                return corrector.level(corrector.irradiance(pairs[p], known, c) * gain)
                       - corrector.level(corrector.irradiance(pairs[p], 1 - known, c) * std::exp(ratio[c]) * gain);
            });
    }
}

double colour_variance(std::vector<double> differences) {
    differences.erase(std::remove_if(differences.begin(), differences.end(), [](double d) { return std::isnan(d); }),
                      differences.end());
    const auto count = static_cast<std::ptrdiff_t>(kCountedShare * static_cast<double>(differences.size()));
    if (!count) return NAN;
    std::nth_element(differences.begin(), differences.begin() + count - 1, differences.end());
    return std::accumulate(differences.begin(), differences.begin() + count, 0.0) / static_cast<double>(count);
}

}  // namespace lensprof
