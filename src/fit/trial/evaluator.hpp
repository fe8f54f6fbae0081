// Evaluates a candidate at the ends of pairs.
#pragma once

#include <array>
#include <cmath>

#include "fit/trial/exposures.hpp"
#include "fit/trial/residuals.hpp"

namespace lensprof {

class Evaluator {
public:
    Evaluator(const TrialPairs &pairs, const TrialModel &model) : pairs_(pairs), model_(model) {}

    const lensprof_response &response(uint32_t channel) const {
        return model_.responses[model_.response_count == 3 ? channel : 0];
    }
    double falloff(const lensprof_pair &pair, int side, uint32_t channel) const {
        const lensprof_fit_image &image = pairs_.images[pair.image[side]];
        return model_.falloff ? lensprof_profile_falloff(model_.falloff, channel, image.width, image.height,
                                                         pair.xy[side][0], pair.xy[side][1], nullptr)
                              : 1.0;
    }
    IrradianceDifference difference(const lensprof_pair &pair, uint32_t channel) const {
        IrradianceDifference d{{pair.image[0], pair.image[1]}, 0.0, 0.0};
        double variance = 0.0;
        for (int side = 0; side < 2; side++) {
            double slope = 0.0;
            const double light = lensprof_response_invert(&response(channel), pair.value[side][channel], &slope);
            if (!(light > 0.0) || !(slope > 0.0)) return d;  // black, or a flat part of the curve
            const double log_light = std::log(light / falloff(pair, side, channel));
            d.log_ratio += side ? -log_light : log_light;
            variance += slope * slope / (light * light);
        }
        d.sigma = std::sqrt(variance) / 255.0;
        return d;
    }
    // The residual at both ends, levels, and ln of the ratio of the exposures.
    std::array<double, 2> residuals(const lensprof_pair &pair, uint32_t channel, double log_exposure) const {
        const double ratio = falloff(pair, 0, channel) / falloff(pair, 1, channel) * std::exp(log_exposure);
        const lensprof_response &f = response(channel);
        const double a = pair.value[0][channel], b = pair.value[1][channel];
        const double x = lensprof_response_invert(&f, a, nullptr), y = lensprof_response_invert(&f, b, nullptr);
        return {255.0 * (a - lensprof_response_eval(&f, y * ratio, nullptr)),
                255.0 * (b - lensprof_response_eval(&f, x / ratio, nullptr))};
    }

private:
    const TrialPairs &pairs_;
    const TrialModel &model_;
};

}  // namespace lensprof
