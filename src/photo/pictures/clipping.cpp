#include "photo/pictures/clipping.hpp"

#include "photo/base/format.hpp"

namespace lensprof {
double white_share(const Picture &picture) {
    constexpr double white = 250.0 / 255.0;
    const size_t samples = lensprof_layout_samples(picture.layout), channels = lensprof_layout_channels(picture.layout);
    size_t count = 0;
    for (uint32_t y = 0; y < picture.height; y++) {
        const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
        for (uint32_t x = 0; x < picture.width; x++) {
            bool is_white = false;
            for (size_t c = 0; c < channels; c++)
                is_white |= sample_value(picture.sample, row, x * samples + c) > white;
            count += is_white;
        }
    }
    return static_cast<double>(count) / (static_cast<double>(picture.width) * picture.height);
}

}  // namespace lensprof
