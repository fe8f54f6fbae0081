#include "contact_sheet.hpp"

#include <algorithm>
#include <cstring>

namespace lensprof {
namespace {

constexpr uint32_t kThumbnailSide = 320, kGap = 8, kPerRow = 6;
constexpr uint8_t kBackground = 40;

double load(const Picture &picture, uint32_t x, uint32_t y, uint32_t s) {
    uint32_t bytes = lensprof_sample_bytes(picture.sample), samples = lensprof_layout_samples(picture.layout);
    const uint8_t *p = &picture.pixels[y * picture.row_bytes + (static_cast<size_t>(x) * samples + s) * bytes];
    if (picture.sample == LENSPROF_SAMPLE_U8) return *p / 255.0;
    if (picture.sample == LENSPROF_SAMPLE_U16) {
        uint16_t value;
        std::memcpy(&value, p, sizeof value);
        return value / 65535.0;
    }
    float value;
    std::memcpy(&value, p, sizeof value);
    return value;
}

}  // namespace

ContactSheet::Thumbnail ContactSheet::shrink(const Picture &picture) {
    uint32_t step = std::max(1u, (std::max(picture.width, picture.height) + kThumbnailSide - 1) / kThumbnailSide);
    Thumbnail small{std::max(1u, picture.width / step), std::max(1u, picture.height / step), {}};
    bool grey = lensprof_layout_channels(picture.layout) == 1;
    small.rgb.resize(static_cast<size_t>(small.width) * small.height * 3);
    for (uint32_t y = 0; y < small.height; y++)
        for (uint32_t x = 0; x < small.width; x++)
            for (uint32_t c = 0; c < 3; c++) {
                double sum = 0.0;
                uint32_t count = 0;
                for (uint32_t v = y * step; v < std::min(picture.height, (y + 1) * step); v++)
                    for (uint32_t u = x * step; u < std::min(picture.width, (x + 1) * step); u++, count++)
                        sum += load(picture, u, v, grey ? 0 : c);
                double mean = std::clamp(sum / count, 0.0, 1.0);
                small.rgb[(static_cast<size_t>(y) * small.width + x) * 3 + c] =
                    static_cast<uint8_t>(mean * 255.0 + 0.5);
            }
    return small;
}

void ContactSheet::add(const Picture &before, const Picture &after) {
    before_.push_back(shrink(before));
    after_.push_back(shrink(after));
}

void ContactSheet::write(const std::string &path) const {
    uint32_t cell_w = 1, cell_h = 1;
    for (const auto *row : {&before_, &after_})
        for (const auto &t : *row) cell_w = std::max(cell_w, t.width), cell_h = std::max(cell_h, t.height);
    auto count = static_cast<uint32_t>(before_.size());
    uint32_t columns = std::max(1u, std::min(count, kPerRow)), bands = std::max(1u, (count + columns - 1) / columns);
    Picture sheet;
    sheet.width = sheet.frame_width = columns * (cell_w + kGap) + kGap;
    sheet.height = sheet.frame_height = bands * (2 * cell_h + 3 * kGap) + kGap;
    sheet.row_bytes = static_cast<size_t>(sheet.width) * 3;
    sheet.pixels.assign(sheet.row_bytes * sheet.height, kBackground);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t row = 0; row < 2; row++) {
            const Thumbnail &t = row == 0 ? before_[i] : after_[i];
            uint32_t x0 = kGap + (i % columns) * (cell_w + kGap);
            uint32_t y0 = kGap + (i / columns) * (2 * cell_h + 3 * kGap) + row * (cell_h + kGap);
            for (uint32_t y = 0; y < t.height; y++)
                std::copy_n(&t.rgb[static_cast<size_t>(y) * t.width * 3], t.width * 3,
                            &sheet.pixels[(y0 + y) * sheet.row_bytes + static_cast<size_t>(x0) * 3]);
        }
    write_picture(path, sheet);
}

}  // namespace lensprof
