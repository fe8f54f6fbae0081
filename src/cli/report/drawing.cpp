#include "cli/report/drawing.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include <cairo-svg.h>

#include "photo/base/failure.hpp"
#include "photo/base/utf8.hpp"

namespace lensprof {
namespace {

constexpr double png_scale = 2;

struct Colour {
    double red, green, blue;
};

// The colours of Okabe & Ito, distinguishable with all kinds of colour vision, without their yellow, which is pale on
// white.
constexpr Colour colours[] = {{0, 0.447, 0.698}, {0.835, 0.369, 0},     {0, 0.620, 0.451}, {0.800, 0.475, 0.655},
                              {0.902, 0.624, 0}, {0.337, 0.706, 0.914}, {0, 0, 0}};
constexpr size_t colour_count = sizeof colours / sizeof *colours;

// Five dashes and seven colours: 35 distinct curves.
const std::vector<double> dashes[] = {{}, {8, 4}, {2, 3}, {10, 3, 2, 3}, {14, 4}};
constexpr size_t dash_count = sizeof dashes / sizeof *dashes;

bool has_extension(const std::string &path, const char *extension) {
    const size_t length = std::char_traits<char>::length(extension);
    if (path.size() <= length || path[path.size() - length - 1] == '/') return false;
    return std::equal(path.end() - long(length), path.end(), extension,
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

cairo_status_t append(void *text, const unsigned char *data, unsigned length) {
    try {
        static_cast<std::string *>(text)->append(reinterpret_cast<const char *>(data), length);
        return CAIRO_STATUS_SUCCESS;
    } catch (const std::exception &) {
        return CAIRO_STATUS_NO_MEMORY;
    }
}

void expect(cairo_status_t status, const std::string &path) {
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    if (status != CAIRO_STATUS_SUCCESS)
        throw Failure(LENSPROF_ERROR_WRITE, path + ": cannot draw the chart: " + cairo_status_to_string(status));
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

std::string svg_of(const std::string &path, const DrawingSize &size,
                   const std::function<void(cairo_t *, const DrawingSize &)> &draw) {
    std::string bytes;
    const Surface surface(cairo_svg_surface_create_for_stream(append, &bytes, size.width, size.height),
                          cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    draw(context.get(), size);
    expect(cairo_status(context.get()), path);
    cairo_surface_finish(surface.get());
    expect(cairo_surface_status(surface.get()), path);
    return bytes;
}

std::string png_of(const std::string &path, const DrawingSize &size,
                   const std::function<void(cairo_t *, const DrawingSize &)> &draw) {
    std::string bytes;
    const Surface surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(png_scale * size.width), int(png_scale * size.height)),
        cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_scale(context.get(), png_scale, png_scale);
    draw(context.get(), size);
    expect(cairo_status(context.get()), path);
    expect(cairo_surface_write_to_png_stream(surface.get(), append, &bytes), path);
    return bytes;
}

}  // namespace

void set_curve_colour(cairo_t *cr, size_t curve, double opacity) {
    const Colour &colour = colours[curve % colour_count];
    cairo_set_source_rgba(cr, colour.red, colour.green, colour.blue, opacity);
}

void set_grey(cairo_t *cr, double grey) { cairo_set_source_rgb(cr, grey, grey, grey); }

void set_font(cairo_t *cr, double size, bool bold) {
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
}

double text_width(cairo_t *cr, const std::string &text) {
    cairo_text_extents_t extents;
    cairo_text_extents(cr, text.c_str(), &extents);
    return extents.x_advance;
}

void draw_text(cairo_t *cr, double x, double y, const std::string &text, double anchor) {
    const std::string valid = valid_line(text);
    cairo_move_to(cr, x - anchor * text_width(cr, valid), y);
    cairo_show_text(cr, valid.c_str());
}

void draw_rotated_text(cairo_t *cr, double x, double y, const std::string &text) {
    cairo_save(cr);
    cairo_translate(cr, x, y);
    cairo_rotate(cr, -0.5 * M_PI);
    draw_text(cr, 0, 0, text, 0.5);
    cairo_restore(cr);
}

void stroke_line(cairo_t *cr, double x0, double y0, double x1, double y1) {
    cairo_move_to(cr, x0, y0);
    cairo_line_to(cr, x1, y1);
    cairo_stroke(cr);
}

void set_curve_pen(cairo_t *cr, size_t curve) {
    const std::vector<double> &dash = dashes[curve % dash_count];
    set_curve_colour(cr, curve);
    cairo_set_dash(cr, dash.data(), int(dash.size()), 0);
    cairo_set_line_width(cr, 2);
}

std::string drawing_of(const std::string &path, const std::function<DrawingSize(cairo_t *)> &measure,
                       const std::function<void(cairo_t *, const DrawingSize &)> &draw) {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1), cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_scale(context.get(), png_scale, png_scale);
    const DrawingSize size = measure(context.get());
    expect(cairo_status(context.get()), path);
    return has_extension(path, ".svg") ? svg_of(path, size, draw) : png_of(path, size, draw);
}

void check_chart_name(const std::string &path) {
    if (!has_extension(path, ".svg") && !has_extension(path, ".png"))
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": charts are written as .svg or .png; give a name with one of these "
                                              "endings");
}

}  // namespace lensprof
