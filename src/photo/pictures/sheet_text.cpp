#include "photo/pictures/sheet_text.hpp"

#include <memory>
#include <new>

#include <cairo.h>

#include "photo/base/utf8.hpp"

namespace lensprof {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

double width_of(cairo_t *cr, const std::string &text) {
    cairo_text_extents_t extents;
    cairo_text_extents(cr, text.c_str(), &extents);
    return extents.x_advance;
}

void draw_text(cairo_t *cr, const SheetText &text) {
    const std::string valid = valid_line(text.text);
    std::string shown = valid;
    for (size_t kept = valid.size(); kept > 4 && width_of(cr, shown) > text.widest; kept--) {
        size_t end = valid.size() - kept / 2;
        while (end < valid.size() && !utf8_length(valid, end)) end++;
        shown = valid.substr(0, utf8_cut(valid, kept / 2)) + "..." + valid.substr(end);
    }
    cairo_move_to(cr, text.left, text.baseline);
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

}  // namespace

void draw_texts(Picture &band, uint32_t height, const std::vector<SheetText> &texts) {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(band.width), int(height)),
                          cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_t *cr = context.get();
    const double grey = sheet_background / 255.0;
    cairo_set_source_rgb(cr, grey, grey, grey);
    cairo_paint(cr);
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, sheet_text_size);
    cairo_set_source_rgb(cr, 0.95, 0.95, 0.95);
    for (const SheetText &text : texts) draw_text(cr, text);
    cairo_surface_flush(surface.get());
    if (cairo_status(cr) != CAIRO_STATUS_SUCCESS) throw std::bad_alloc();
    copy_pixels(surface.get(), band);
}

}  // namespace lensprof
