// Sharpening of JPEG pictures by a camera after the response: an unsharp mask, which overshoots at edges.
#include <algorithm>
#include <cmath>

#include "cli/simulate/simulate.hpp"

namespace lensprof {
namespace {

constexpr double kBlurSigma = 1.5;  // of the Gaussian, px
constexpr int kReach = 5;

// Gaussian along one direction of a channel, its weights summing to 1 at the borders too.
void blur(const std::vector<float> &from, std::vector<float> &to, uint32_t count, uint32_t step, uint32_t lines,
          uint32_t line_step) {
    double weight[kReach + 1];
    for (int j = 0; j <= kReach; j++) weight[j] = std::exp(-0.5 * j * j / (kBlurSigma * kBlurSigma));
    for (size_t line = 0; line < lines; line++)
        for (int i = 0; i < static_cast<int>(count); i++) {
            double sum = 0.0, weights = 0.0;
            for (int j = std::max(-kReach, -i); j <= std::min(kReach, static_cast<int>(count) - 1 - i); j++) {
                sum += weight[std::abs(j)]
                       * static_cast<double>(from[line * line_step + static_cast<size_t>(i + j) * step]);
                weights += weight[std::abs(j)];
            }
            to[line * line_step + static_cast<size_t>(i) * step] = static_cast<float>(sum / weights);
        }
}

}  // namespace

void sharpen(double gain, Picture &picture) {
    const uint32_t width = picture.width, height = picture.height;
    auto *pixels = reinterpret_cast<float *>(picture.pixels.data());
    std::vector<float> channel(static_cast<size_t>(width) * height), across(channel.size()), mean(channel.size());
    for (size_t c = 0; c < 3; c++) {
        for (size_t p = 0; p < channel.size(); p++) channel[p] = pixels[3 * p + c];
        blur(channel, across, width, 1, height, width);
        blur(across, mean, height, width, width, 1);
        for (size_t p = 0; p < channel.size(); p++) {
            const double value = channel[p], more = gain * (value - static_cast<double>(mean[p]));
            pixels[3 * p + c] = static_cast<float>(std::clamp(value + more, 0.0, 1.0));
        }
    }
}

}  // namespace lensprof
