#include "photo/correct/light_weights.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {

// Grey values, 0..1, at which the weight of a pixel starts and is full; symmetric below white. Within 2 % of white,
// JPEG coding and noise mix saturated pixels with others.
static constexpr double none_below = 0.01, all_above = 0.06, all_below = 0.9, none_above = 0.98;

size_t samples_of_light(const Picture &header, const std::string &file) {
    const size_t samples = lensprof_layout_samples(header.layout);
    if (samples != 1 && samples != 3)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      file + ": has transparency, which merged pictures do not support; remove it");
    return samples;
}

double grey_at(const lensprof_image &rows, uint32_t y, size_t n) {
    const auto *row = static_cast<const uint8_t *>(rows.data) + static_cast<ptrdiff_t>(y) * rows.row_bytes;
    return sample_value(rows.sample, row, n);
}

double largest_grey(const lensprof_image &rows, uint32_t x, uint32_t y) {
    const size_t samples = lensprof_layout_samples(rows.layout);
    double largest = 0.0;
    for (size_t c = 0; c < samples; c++) largest = std::max(largest, grey_at(rows, y, x * samples + c));
    return largest;
}

double trust_of(double largest) {
    const double up = (largest - none_below) / (all_above - none_below);
    const double down = (none_above - largest) / (none_above - all_below);
    return std::clamp(std::min(up, down), 0.0, 1.0);
}

bool is_white(double largest) { return largest >= none_above; }

double gain_of(const Correction &job, size_t channel) {
    return std::exp2(job.exposure.ev - job.target_exposure.ev) * job.exposure.white_balance[channel]
           / job.target_exposure.white_balance[channel];
}

LightWeights::LightWeights(const Correction &job) {
    for (size_t c = 0; c < 3; c++) {
        const lensprof_response &response = job.model->response[job.model->responses == 3 ? c : 0];
        for (int k = 0; k <= steps; k++) {
            double slope = 0.0;  // of irradiance over grey value
            lensprof_response_invert(&response, static_cast<double>(k) / steps, &slope);
            weight_[c][static_cast<size_t>(k)] = slope > 0.0 ? std::pow(gain_of(job, c) / slope, 2) : 0.0;
        }
    }
}

double LightWeights::at(size_t channel, double grey) const {
    return weight_[channel][static_cast<size_t>(std::lround(steps * std::clamp(grey, 0.0, 1.0)))];
}

}  // namespace lensprof
