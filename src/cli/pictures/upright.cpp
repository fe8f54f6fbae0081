#include "cli/pictures/upright.hpp"

#include <algorithm>
#include <utility>

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

// EXIF's orientation: where the pixel (x, y) of the upright picture is in the stored one of w x h.
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

}  // namespace

void turn_upright(uint16_t orientation, uint32_t &width, uint32_t &height, std::vector<uint8_t> &rgb) {
    if (orientation < 2 || orientation > 8) return;
    const std::vector<uint8_t> stored = rgb;
    const uint32_t w = width, h = height;
    if (orientation >= 5) std::swap(width, height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            const auto [u, v] = stored_place(orientation, w, h, x, y);
            std::copy_n(&stored[(size_t(v) * w + u) * 3], 3, &rgb[(size_t(y) * width + x) * 3]);
        }
}

Picture upright_copy(const Picture &stored, uint16_t orientation, uint32_t side) {
    const uint32_t longer = std::max(stored.width, stored.height);
    const auto reduced = [=](uint32_t length) {
        return longer <= side ? length : std::max(1u, static_cast<uint32_t>(uint64_t(length) * side / longer));
    };
    Picture copy;
    copy.width = reduced(stored.width), copy.height = reduced(stored.height);
    copy.pixels.reserve(size_t(3) * copy.width * copy.height);
    for (uint32_t y = 0; y < copy.height; y++)
        for (uint32_t x = 0; x < copy.width; x++)
            for (uint32_t c = 0; c < 3; c++) copy.pixels.push_back(box_mean(stored, copy.width, copy.height, x, y, c));
    turn_upright(orientation, copy.width, copy.height, copy.pixels);
    copy.row_bytes = size_t(3) * copy.width;
    return copy;
}

}  // namespace lensprof
