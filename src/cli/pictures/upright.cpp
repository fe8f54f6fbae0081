#include "cli/pictures/upright.hpp"

#include <algorithm>

namespace lensprof {
namespace {

// Mean of a channel over the part of a picture that a pixel of the reduced picture covers.
uint8_t box_mean(const Picture &picture, uint32_t step, uint32_t x, uint32_t y, uint32_t channel) {
    const uint32_t samples = lensprof_layout_samples(picture.layout);
    const uint32_t right = std::min((x + 1) * step, picture.width), bottom = std::min((y + 1) * step, picture.height);
    uint32_t sum = 0, count = 0;
    for (uint32_t v = y * step; v < bottom; v++)
        for (uint32_t u = x * step; u < right; u++, count++)
            sum += picture.pixels[v * picture.row_bytes + size_t(u) * samples + (samples < 3 ? 0 : channel)];
    return static_cast<uint8_t>((sum + count / 2) / std::max(count, 1u));
}

}  // namespace

std::pair<uint32_t, uint32_t> stored_place(uint16_t orientation, uint32_t w, uint32_t h, uint32_t x, uint32_t y) {
    switch (orientation) {
    case 2: return {w - 1 - x, y};
    case 3: return {w - 1 - x, h - 1 - y};
    case 4: return {x, h - 1 - y};
    case 5: return {y, x};
    case 6: return {y, h - 1 - x};
    case 7: return {w - 1 - y, h - 1 - x};
    case 8: return {w - 1 - y, x};
    default: return {x, y};
    }
}

Picture upright_copy(const Picture &stored, uint16_t orientation, uint32_t side) {
    const uint32_t step = std::max(1u, (std::max(stored.width, stored.height) + side - 1) / side);
    const uint32_t width = std::max(1u, stored.width / step), height = std::max(1u, stored.height / step);
    const bool is_turned = orientation >= 5 && orientation <= 8;
    Picture copy;
    copy.width = is_turned ? height : width;
    copy.height = is_turned ? width : height;
    copy.row_bytes = size_t(3) * copy.width;
    copy.pixels.resize(copy.row_bytes * copy.height);
    for (uint32_t y = 0; y < copy.height; y++)
        for (uint32_t x = 0; x < copy.width; x++) {
            const auto [u, v] = stored_place(orientation, width, height, x, y);
            for (uint32_t c = 0; c < 3; c++)
                copy.pixels[y * copy.row_bytes + size_t(3) * x + c] = box_mean(stored, step, u, v, c);
        }
    return copy;
}

}  // namespace lensprof
