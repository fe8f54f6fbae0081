#include "photo/pictures/contact_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <utility>

#include <cairo.h>

#include "photo/base/utf8.hpp"

namespace lensprof {
namespace {

constexpr uint32_t gap = 12, line = 22, sheet_header = line + 2 * gap, label = 2 * line;  // px
constexpr uint32_t sheet_width = 1920, narrowest_cell = 160, largest_side = 960;          // px
constexpr double text_size = 16;                                                          // px
constexpr uint8_t background = 40;
constexpr const char *legend = "above: as taken; below: corrected";

uint32_t columns_of(size_t pictures) {
    constexpr std::pair<size_t, uint32_t> columns[] = {{1, 1}, {4, 2}, {9, 3}, {20, 4}, {60, 5}, {400, 8}};
    for (const auto &[most, count] : columns)
        if (pictures <= most) return count;
    return std::max(12u, static_cast<uint32_t>(std::ceil(std::sqrt(1.7 * static_cast<double>(pictures)))));
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

double width_of(cairo_t *cr, const std::string &text) {
    cairo_text_extents_t extents;
    cairo_text_extents(cr, text.c_str(), &extents);
    return extents.x_advance;
}

// Text at most `widest` pixels wide: the middle of a longer one is omitted.
void draw_text(cairo_t *cr, double x, double y, double widest, const std::string &text) {
    const std::string valid = valid_line(text);
    std::string shown = valid;
    for (size_t kept = valid.size(); kept > 4 && width_of(cr, shown) > widest; kept--) {
        size_t end = valid.size() - kept / 2;
        while (end < valid.size() && !utf8_length(valid, end)) end++;
        shown = valid.substr(0, utf8_cut(valid, kept / 2)) + "..." + valid.substr(end);
    }
    cairo_move_to(cr, x, y);
    cairo_show_text(cr, shown.c_str());
}

// Copies the pixels of cairo, which are blue, green, red and an unused byte, in native order.
void copy_pixels(cairo_surface_t *surface, Picture &band) {
    const uint8_t *data = cairo_image_surface_get_data(surface);
    const auto stride = static_cast<size_t>(cairo_image_surface_get_stride(surface));
    for (int y = 0; y < cairo_image_surface_get_height(surface); y++)
        for (uint32_t x = 0; x < band.width; x++) {
            const uint32_t pixel = reinterpret_cast<const uint32_t *>(data + y * stride)[x];
            uint8_t *to = &band.pixels[y * band.row_bytes + size_t(x) * 3];
            to[0] = uint8_t(pixel >> 16), to[1] = uint8_t(pixel >> 8), to[2] = uint8_t(pixel);
        }
}

// The texts that draw(cr) draws, in the upper `height` rows of a band.
template <class Draw>
void draw_texts(Picture &band, uint32_t height, const Draw &draw) {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(band.width), int(height)),
                          cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_t *cr = context.get();
    cairo_set_source_rgb(cr, background / 255.0, background / 255.0, background / 255.0);
    cairo_paint(cr);
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, text_size);
    cairo_set_source_rgb(cr, 0.95, 0.95, 0.95);
    draw(cr);
    cairo_surface_flush(surface.get());
    if (cairo_status(cr) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
    copy_pixels(surface.get(), band);
}

// Rows of the sheet, empty.
Picture empty_band(uint32_t width, uint32_t height) {
    Picture band;
    band.width = band.frame_width = width, band.height = band.frame_height = height;
    band.row_bytes = size_t(3) * width;
    band.pixels.assign(band.row_bytes * height, background);
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
    draw_texts(top, sheet_header, [&](cairo_t *cr) { draw_text(cr, gap, gap + text_size, width - 2.0 * gap, legend); });
    writer.write(top.view());
    for (uint32_t first = 0; first < count; first += columns) {
        const uint32_t tallest = high[first / columns];
        Picture band = empty_band(width, band_height(tallest));
        const auto cells = cells_.begin() + first;
        const uint32_t shown = std::min(columns, count - first);
        draw_texts(band, label, [&](cairo_t *cr) {
            for (uint32_t i = 0; i < shown; i++) {
                const double left = gap + i * (wide + gap);
                draw_text(cr, left, text_size, wide, cells[i].name);
                draw_text(cr, left, line + text_size, wide, cells[i].note);
            }
        });
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
