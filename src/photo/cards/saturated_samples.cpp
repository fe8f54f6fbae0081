#include "photo/cards/saturated_samples.hpp"

#include <cstring>
#include <vector>

namespace lensprof {

std::optional<double> saturated_sample(const Picture &picture) {
    constexpr uint32_t neighbours = 8;      // codes below that occur
    constexpr double more = 4.0;            // times their mean: without saturation, the brightest samples are few,
    constexpr double least_share = 0.0005;  // or, on a flat top, as many as their neighbours
    if (picture.sample != LENSPROF_SAMPLE_U16) return std::nullopt;
    const uint32_t samples = lensprof_layout_samples(picture.layout),
                   channels = lensprof_layout_channels(picture.layout);
    std::vector<uint32_t> count(65536);
    for (uint32_t y = 0; y < picture.height; y++) {
        const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
        for (size_t i = 0; i < size_t{picture.width} * samples; i++) {
            uint16_t code;
            std::memcpy(&code, row + 2 * i, sizeof code);
            if (i % samples < channels) count[code]++;
        }
    }
    uint32_t largest = 65535, seen = 0;
    while (largest > 0 && count[largest] == 0) largest--;
    double below = 0.0;
    for (uint32_t code = largest; code > 0 && seen < neighbours; code--)
        if (count[code - 1]) below += count[code - 1], seen++;
    const double all = double(picture.width) * picture.height * channels;
    const bool is_saturated =
        seen == neighbours && count[largest] > least_share * all && count[largest] > more * below / neighbours;
    return is_saturated ? std::optional(largest / 65535.0) : std::nullopt;
}

}  // namespace lensprof
