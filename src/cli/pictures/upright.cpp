#include "cli/pictures/upright.hpp"

#include <algorithm>

namespace lensprof {
namespace {

// Mean of a channel over the part of a picture that a pixel of its copy of w x h covers.
uint8_t box_mean(const Picture &picture, uint32_t w, uint32_t h, uint32_t x, uint32_t y, uint32_t channel) {
    const uint32_t samples = lensprof_layout_samples(picture.layout);
    const auto edge = [](uint32_t at, uint32_t side, uint32_t copy) {
        return static_cast<uint32_t>(uint64_t(at) * side / copy);
    };
    const uint32_t left = edge(x, picture.width, w), right = std::max(left + 1, edge(x + 1, picture.width, w));
    const uint32_t top = edge(y, picture.height, h), bottom = std::max(top + 1, edge(y + 1, picture.height, h));
    uint32_t sum = 0;
    for (uint32_t v = top; v < bottom; v++)
        for (uint32_t u = left; u < right; u++)
            sum += picture.pixels[v * picture.row_bytes + size_t(u) * samples + (samples < 3 ? 0 : channel)];
    const uint32_t count = (right - left) * (bottom - top);
    return static_cast<uint8_t>((sum + count / 2) / count);
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
    const uint32_t longer = std::max(stored.width, stored.height);
    const auto reduced = [=](uint32_t length) {
        return longer <= side ? length : std::max(1u, static_cast<uint32_t>(uint64_t(length) * side / longer));
    };
    const uint32_t width = reduced(stored.width), height = reduced(stored.height);
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
                copy.pixels[y * copy.row_bytes + size_t(3) * x + c] = box_mean(stored, width, height, u, v, c);
        }
    return copy;
}

}  // namespace lensprof
