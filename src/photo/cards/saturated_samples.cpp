#include "photo/cards/saturated_samples.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

namespace lensprof {
namespace {

uint16_t code_at(const uint8_t *row, size_t i) {
    uint16_t code;
    std::memcpy(&code, row + 2 * i, sizeof code);
    return code;
}

// Every sample of colour, without alpha.
template <class Add>
void over_colours(const Picture &picture, const Add &add) {
    const size_t samples = lensprof_layout_samples(picture.layout), channels = lensprof_layout_channels(picture.layout);
    const size_t width = picture.width;
    for (uint32_t y = 0; y < picture.height; y++) {
        const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
        if (samples == channels)
            for (size_t i = 0; i < width * samples; i++) add(code_at(row, i));
        else
            for (size_t i = 0; i < width * samples; i += samples)
                for (size_t c = 0; c < channels; c++) add(code_at(row, i + c));
    }
}

}  // namespace

std::optional<double> saturated_sample(const Picture &picture) {
    constexpr uint32_t neighbours = 8;      // codes below that occur
    constexpr double more = 4.0;            // times their mean: without saturation, the brightest samples are few,
    constexpr double least_share = 0.0005;  // or, on a flat top, as many as their neighbours
    if (picture.sample != LENSPROF_SAMPLE_U16) return std::nullopt;
    uint16_t largest = 0;
    uint32_t have_it = 0;
    over_colours(picture, [&](uint16_t code) { largest = std::max(largest, code); });
    over_colours(picture, [&](uint16_t code) { have_it += code == largest ? 1 : 0; });
    const double all = double(picture.width) * picture.height * lensprof_layout_channels(picture.layout);
    if (!(have_it > least_share * all)) return std::nullopt;  // most pictures: the rest takes longer
    std::vector<uint32_t> count(65536);
    over_colours(picture, [&](uint16_t code) { count[code]++; });
    uint32_t seen = 0;
    double below = 0.0;
    for (uint32_t code = largest; code > 0 && seen < neighbours; code--)
        if (count[code - 1]) below += count[code - 1], seen++;
    const bool is_saturated = seen == neighbours && have_it > more * below / neighbours;
    return is_saturated ? std::optional(largest / 65535.0) : std::nullopt;
}

}  // namespace lensprof
