// Drawing of charts as SVG or PNG, through cairo.
#pragma once

#include <functional>
#include <string>

#include <cairo.h>

namespace lensprof {

// Sizes in points of an SVG; a pixel of a PNG is half a point.
constexpr double text_size = 13, title_size = 15, small_size = 11;

void set_curve_colour(cairo_t *cr, size_t curve, double opacity = 1.0);  // distinct for up to 35 curves together with
void set_curve_pen(cairo_t *cr, size_t curve);                           // the dashes
void set_grey(cairo_t *cr, double grey);
void set_font(cairo_t *cr, double size, bool bold = false);

double text_width(cairo_t *cr, const std::string &text);

// Text on the base line y; its point `anchor` (0 = start, 1 = end) is at x.
void draw_text(cairo_t *cr, double x, double y, const std::string &text, double anchor);
void draw_rotated_text(cairo_t *cr, double x, double y, const std::string &text);  // vertical, centred
void stroke_line(cairo_t *cr, double x0, double y0, double x1, double y1);

struct DrawingSize {
    double width, height;
};

// The bytes of a file of this name. Text is measured before the surface of this size exists.
std::string drawing_of(const std::string &path, const std::function<DrawingSize(cairo_t *)> &measure,
                       const std::function<void(cairo_t *, const DrawingSize &)> &draw);

// Failure (usage) unless the name ends in .svg or .png, in any case.
void check_chart_name(const std::string &path);

}  // namespace lensprof
