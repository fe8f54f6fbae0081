#include "photo/pictures/picture_levels.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "photo/base/events.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

// The level of a channel; grey has that of green.
uint32_t level_channel(const Picture &picture, uint32_t channel) {
    return lensprof_layout_channels(picture.layout) == 1 ? 1 : channel;
}

// Means along parts of rows, and the noise of one of them.
struct RowMeans {
    std::vector<double> means;
    double mean = 0.0, sigma = 0.0;
};

RowMeans row_means(const Picture &picture, uint32_t channel) {
    const uint32_t samples = lensprof_layout_samples(picture.layout);
    const size_t run = std::clamp<size_t>(picture.width / 8, 1, 128);  // samples of a mean
    RowMeans found;
    double squares = 0.0;  // of differences of neighbours
    for (uint32_t y = 0; y < picture.height; y++)
        for (size_t first = 0; first + run <= picture.width; first += run) {
            const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
            double sum = 0.0, before = sample_value(picture.sample, row, first * samples + channel);
            for (size_t x = first; x < first + run; x++) {
                const double sample = sample_value(picture.sample, row, x * samples + channel);
                sum += sample, squares += (sample - before) * (sample - before), before = sample;
            }
            found.means.push_back(sum / static_cast<double>(run));
            found.mean += found.means.back();
        }
    const double count = static_cast<double>(found.means.size());
    found.mean /= count;
    found.sigma = std::sqrt(0.5 * squares / count) / static_cast<double>(run);
    return found;
}

}  // namespace

bool has_levels(const lensprof_levels &levels) {
    return levels.white != 0.0
           || std::any_of(levels.black, levels.black + 3, [](double black) { return black != 0.0; });
}

// Means are compared, by four standard errors, since noise falls below black.
void require_black_below(const Picture &picture, uint32_t channel, const lensprof_levels &levels,
                         const std::string &file, const std::string &option) {
    constexpr double clearly = 0.1, many = 0.02, noise_sigmas = 4.0;  // of the mean light; of the means
    const double black = levels.black[level_channel(picture, channel)];
    const RowMeans found = row_means(picture, channel);
    const double limit = black - clearly * std::max(found.mean - black, 0.0) - noise_sigmas * found.sigma;
    const auto below = static_cast<double>(
        std::count_if(found.means.begin(), found.means.end(), [&](double mean) { return mean < limit; }));
    const double share = below / static_cast<double>(found.means.size());
    if (share > many)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      file
                          + format(": %.0f %% of its samples lie below the black level; state a lower one with %s",
                                   100.0 * share, option.c_str()));
}

void remove_levels(const lensprof_levels &levels, Picture &picture) {
    const uint32_t samples = lensprof_layout_samples(picture.layout),
                   channels = lensprof_layout_channels(picture.layout);
    const size_t row_samples = size_t(picture.width) * samples;
    std::vector<uint8_t> values(row_samples * picture.height * sizeof(float));
    for (uint32_t y = 0; y < picture.height; y++)
        for (size_t n = 0; n < row_samples; n++) {
            const double sample = sample_value(picture.sample, picture.pixels.data() + y * picture.row_bytes, n);
            const auto channel = static_cast<uint32_t>(n % samples);  // that of an extra sample is not a colour
            const auto value = static_cast<float>(
                channel < channels ? lensprof_levels_to_value(&levels, level_channel(picture, channel), sample)
                                   : sample);
            std::memcpy(values.data() + (y * row_samples + n) * sizeof value, &value, sizeof value);
        }
    picture.pixels = std::move(values);
    picture.sample = LENSPROF_SAMPLE_F32;
    picture.row_bytes = row_samples * sizeof(float);
}

}  // namespace lensprof
