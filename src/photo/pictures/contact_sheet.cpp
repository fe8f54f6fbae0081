#include "photo/pictures/contact_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "photo/pictures/sheet_text.hpp"

namespace lensprof {
namespace {

constexpr uint32_t gap = 12, line = 22, sheet_header = line + 2 * gap, label = 2 * line;  // px
constexpr uint32_t sheet_width = 1920, narrowest_cell = 160, largest_side = 960;          // px
constexpr const char *legend = "above: as taken; below: corrected";

uint32_t columns_of(size_t pictures) {
    constexpr std::pair<size_t, uint32_t> columns[] = {{1, 1}, {4, 2}, {9, 3}, {20, 4}, {60, 5}, {400, 8}};
    for (const auto &[most, count] : columns)
        if (pictures <= most) return count;
    return std::max(12u, static_cast<uint32_t>(std::ceil(std::sqrt(1.7 * static_cast<double>(pictures)))));
}

// Rows of the sheet, empty.
Picture empty_band(uint32_t width, uint32_t height) {
    Picture band;
    band.width = band.frame_width = width, band.height = band.frame_height = height;
    band.row_bytes = size_t(3) * width;
    band.pixels.assign(band.row_bytes * height, sheet_background);
    return band;
}

void paste(const Picture &from, uint32_t left, uint32_t top, Picture &band) {
    for (uint32_t y = 0; y < from.height; y++)
        std::copy_n(&from.pixels[y * from.row_bytes], size_t(from.width) * 3,
                    &band.pixels[(top + y) * band.row_bytes + size_t(left) * 3]);
}

// Labels, the pictures before, those after, and gaps.
uint32_t band_height(uint32_t tallest) { return label + 2 * (tallest + gap) + gap; }

}  // namespace

ContactSheet::ContactSheet(size_t pictures)
    : columns_(columns_of(pictures)),
      side_(std::min(largest_side, std::max(sheet_width / columns_, narrowest_cell) - gap)),
      cells_(pictures) {}

void ContactSheet::write(const std::string &path) const {
    uint32_t wide = narrowest_cell;
    for (const Cell &cell : cells_) wide = std::max({wide, cell.before.width, cell.after.width});
    const auto count = static_cast<uint32_t>(cells_.size());
    const uint32_t columns = std::max(1u, std::min(columns_, count)), bands = (count + columns - 1) / columns;
    const uint32_t width = gap + columns * (wide + gap);
    std::vector<uint32_t> high(bands, 1);  // the tallest picture of each band
    for (uint32_t i = 0; i < count; i++)
        high[i / columns] = std::max({high[i / columns], cells_[i].before.height, cells_[i].after.height});
    Picture whole;  // without pixels
    whole.width = whole.frame_width = width, whole.height = sheet_header;
    for (const uint32_t tallest : high) whole.height += band_height(tallest);
    whole.frame_height = whole.height;
    whole.row_bytes = size_t(3) * width;
    PictureWriter writer(path, whole);
    Picture top = empty_band(width, sheet_header);
    draw_texts(top, sheet_header, {{gap, gap + sheet_text_size, width - 2.0 * gap, legend}});
    writer.write(top.view());
    for (uint32_t first = 0; first < count; first += columns) {
        const uint32_t tallest = high[first / columns];
        Picture band = empty_band(width, band_height(tallest));
        const auto cells = cells_.begin() + first;
        const uint32_t shown = std::min(columns, count - first);
        std::vector<SheetText> texts;
        for (uint32_t i = 0; i < shown; i++) {
            const double left = gap + i * (wide + gap);
            texts.push_back({left, sheet_text_size, double(wide), cells[i].name});
            texts.push_back({left, line + sheet_text_size, double(wide), cells[i].note});
        }
        draw_texts(band, label, texts);
        for (uint32_t i = 0; i < shown; i++) {
            paste(cells[i].before, gap + i * (wide + gap), label, band);
            paste(cells[i].after, gap + i * (wide + gap), label + tallest + gap, band);
        }
        writer.write(band.view());
    }
    writer.finish();
    writer.commit();
}

}  // namespace lensprof
