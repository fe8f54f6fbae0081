#include "photo/pictures/clipping.hpp"

#include <cstring>

#include "photo/base/format.hpp"

namespace lensprof {
namespace {

// Sample `s` of a row, 0..1.
double value_at(const Picture &picture, const uint8_t *row, size_t s) {
    uint16_t code;
    float value;
    switch (picture.sample) {
    case LENSPROF_SAMPLE_U8: return row[s] / 255.0;
    case LENSPROF_SAMPLE_U16: std::memcpy(&code, row + 2 * s, sizeof code); return code / 65535.0;
    default: std::memcpy(&value, row + 4 * s, sizeof value); return static_cast<double>(value);
    }
}

}  // namespace

double white_share(const Picture &picture) {
    constexpr double white = 250.0 / 255.0;
    const size_t samples = lensprof_layout_samples(picture.layout), channels = lensprof_layout_channels(picture.layout);
    size_t count = 0;
    for (uint32_t y = 0; y < picture.height; y++) {
        const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
        for (uint32_t x = 0; x < picture.width; x++) {
            bool is_white = false;
            for (size_t c = 0; c < channels; c++) is_white |= value_at(picture, row, x * samples + c) > white;
            count += is_white;
        }
    }
    return static_cast<double>(count) / (static_cast<double>(picture.width) * picture.height);
}

}  // namespace lensprof
