// The relative illuminance chart as SVG or PNG: one drawing for both, through cairo.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <cairo-svg.h>
#include <cairo.h>

#include "cli/program/error.hpp"
#include "cli/program/format.hpp"
#include "cli/program/output_file.hpp"
#include "cli/report/chart.hpp"

namespace lensprof {
namespace {

// Sizes in points of the SVG; a pixel of the PNG is half a point.
constexpr double plot_width = 520, plot_height = 360, left = 70, top = 64, bottom = 58, right_axis = 84;
constexpr double key_width = 44, key_line = 20, text_size = 13, title_size = 15, small_size = 11;
constexpr double png_scale = 2;

struct Colour {
    double red, green, blue;
};

// Okabe & Ito's colours, which all kinds of colour vision tell apart, without their yellow, which is pale on white.
constexpr Colour colours[] = {{0, 0.447, 0.698}, {0.835, 0.369, 0},     {0, 0.620, 0.451}, {0.800, 0.475, 0.655},
                              {0.902, 0.624, 0}, {0.337, 0.706, 0.914}, {0, 0, 0}};
constexpr size_t colour_count = sizeof colours / sizeof *colours;

// Five dashes and seven colours: no two of 35 curves look the same.
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
        throw Failure(ExitCode::failed, path + ": the chart cannot be drawn: " + cairo_status_to_string(status));
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

void set_colour(cairo_t *cr, const Colour &c, double opacity = 1.0) {
    cairo_set_source_rgba(cr, c.red, c.green, c.blue, opacity);
}

void set_grey(cairo_t *cr, double grey) { cairo_set_source_rgb(cr, grey, grey, grey); }

void set_font(cairo_t *cr, double size, bool bold = false) {
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, size);
}

double text_width(cairo_t *cr, const std::string &text) {
    cairo_text_extents_t extents;
    cairo_text_extents(cr, text.c_str(), &extents);
    return extents.x_advance;
}

// Text on the base line y, whose point `anchor` (0 = start, 1 = end) stands at x.
void draw_text(cairo_t *cr, double x, double y, const std::string &text, double anchor) {
    cairo_move_to(cr, x - anchor * text_width(cr, text), y);
    cairo_show_text(cr, text.c_str());
}

void draw_turned_text(cairo_t *cr, double x, double y, const std::string &text) {
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

// The chart's own measures: where values stand, and what the texts need.
struct Layout {
    const Chart &chart;
    ChartAxis axis;
    double width, height;

    double x(double r) const { return left + plot_width * r; }
    double y(double m) const { return top + plot_height * (axis.high - m) / (axis.high - axis.low); }
};

Layout lay_out(const Chart &chart, cairo_t *cr) {
    set_font(cr, text_size);
    double labels = 0;
    for (const ChartCurve &curve : chart.curves) labels = std::max(labels, text_width(cr, curve.label));
    const double title = text_width(cr, chart.title) + 40;
    set_font(cr, small_size);
    labels = std::max(labels, text_width(cr, chart.note) - key_width);
    const double key_height = key_line * double(chart.curves.size() + 2);
    Layout layout{chart, chart_axis(chart), 0, 0};
    layout.width = std::ceil(std::max(left + plot_width + right_axis + key_width + labels + 24, title));
    layout.height = std::ceil(top + std::max(plot_height, key_height) + bottom);
    return layout;
}

void draw_grid(cairo_t *cr, const Layout &layout) {
    cairo_set_line_width(cr, 1);
    set_font(cr, text_size);
    for (int i = 0; i <= layout.axis.steps; i++) {
        const double m = layout.axis.tick(i), y = layout.y(m);
        set_grey(cr, 0.88);
        stroke_line(cr, left, y, left + plot_width, y);
        set_grey(cr, 0.2);
        draw_text(cr, left - 8, y + 4.5, format("%g", m), 1);
    }
    for (int i = 0; i <= 4; i++) {
        const double r = 0.25 * i, x = layout.x(r);
        set_grey(cr, 0.88);
        stroke_line(cr, x, top, x, top + plot_height);
        set_grey(cr, 0.2);
        draw_text(cr, x, top + plot_height + 19, format("%g", r), 0.5);
    }
}

// The axis on the right: log2 M, in steps that leave room for the numbers.
void draw_ev_axis(cairo_t *cr, const Layout &layout) {
    const double high = std::log2(layout.axis.high), low = std::log2(std::max(layout.axis.low, layout.axis.high / 64));
    double step = 0.125;
    while ((high - low) / step > 8) step *= 2;
    set_grey(cr, 0.2);
    set_font(cr, text_size);
    for (double ev = step * std::floor(high / step); ev >= low; ev -= step) {
        const double y = layout.y(std::exp2(ev));
        if (ev < high && y - layout.y(std::exp2(ev + step)) < text_size) continue;  // numbers would touch
        stroke_line(cr, left + plot_width, y, left + plot_width + 5, y);
        draw_text(cr, left + plot_width + 9, y + 4.5, format("%.3g", ev + 0.0), 0);
    }
}

void draw_band(cairo_t *cr, const Layout &layout, const ChartCurve &curve) {
    for (size_t i = 0; i < chart_samples; i++)
        cairo_line_to(cr, layout.x(double(i) / (chart_samples - 1)), layout.y(curve.m[i] + curve.sigma[i]));
    for (size_t i = chart_samples; i-- > 0;)
        cairo_line_to(cr, layout.x(double(i) / (chart_samples - 1)), layout.y(curve.m[i] - curve.sigma[i]));
    cairo_close_path(cr);
    cairo_fill(cr);
}

void set_pen(cairo_t *cr, size_t curve) {
    const std::vector<double> &dash = dashes[curve % dash_count];
    set_colour(cr, colours[curve % colour_count]);
    cairo_set_dash(cr, dash.data(), int(dash.size()), 0);
    cairo_set_line_width(cr, 2);
}

void draw_curves(cairo_t *cr, const Layout &layout) {
    const std::vector<ChartCurve> &curves = layout.chart.curves;
    cairo_save(cr);
    cairo_rectangle(cr, left, top, plot_width, plot_height);
    cairo_clip(cr);
    for (size_t k = 0; k < curves.size(); k++)
        if (curves[k].has_sigma) {
            set_colour(cr, colours[k % colour_count], 0.15);
            draw_band(cr, layout, curves[k]);
        }
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    for (size_t k = curves.size(); k-- > 0;) {
        set_pen(cr, k);
        for (size_t i = 0; i < chart_samples; i++)
            cairo_line_to(cr, layout.x(double(i) / (chart_samples - 1)), layout.y(curves[k].m[i]));
        cairo_stroke(cr);
    }
    cairo_restore(cr);
}

void draw_key(cairo_t *cr, const Layout &layout) {
    const double x = left + plot_width + right_axis;
    const std::vector<ChartCurve> &curves = layout.chart.curves;
    set_font(cr, text_size);
    for (size_t k = 0; k < curves.size(); k++) {
        const double y = top + 8 + key_line * double(k);
        cairo_save(cr);
        set_pen(cr, k);
        stroke_line(cr, x, y, x + key_width - 10, y);
        cairo_restore(cr);
        set_grey(cr, 0.1);
        draw_text(cr, x + key_width, y + 4.5, curves[k].label, 0);
    }
    set_font(cr, small_size);
    set_grey(cr, 0.35);
    double y = top + 12 + key_line * double(curves.size());
    const bool has_bands = std::any_of(curves.begin(), curves.end(), [](const ChartCurve &c) { return c.has_sigma; });
    if (has_bands) draw_text(cr, x, y, "bands: 1 sigma", 0);
    if (has_bands) y += key_line;
    draw_text(cr, x, y, layout.chart.note, 0);
}

void draw(cairo_t *cr, const Layout &layout) {
    set_grey(cr, 1);
    cairo_paint(cr);
    draw_grid(cr, layout);
    draw_ev_axis(cr, layout);
    draw_curves(cr, layout);
    set_grey(cr, 0.2);
    cairo_set_line_width(cr, 1);
    cairo_rectangle(cr, left, top, plot_width, plot_height);
    cairo_stroke(cr);
    draw_key(cr, layout);
    set_grey(cr, 0.1);
    set_font(cr, title_size, true);
    draw_text(cr, 20, 26, "Relative illuminance", 0);
    set_font(cr, text_size);
    draw_text(cr, 20, 46, layout.chart.title, 0);
    const double middle = left + 0.5 * plot_width;
    draw_text(cr, middle, top + plot_height + 42, "r, half diagonals from the centre of the falloff (1 = corner)", 0.5);
    draw_turned_text(cr, 24, top + 0.5 * plot_height, "M, light relative to the centre");
    draw_turned_text(cr, left + plot_width + 62, top + 0.5 * plot_height, "EV relative to the centre");
}

// Texts are measured before there is a picture of their size.
Layout measure(const Chart &chart, const std::string &path) {
    const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1), cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_scale(context.get(), png_scale, png_scale);
    const Layout layout = lay_out(chart, context.get());
    expect(cairo_status(context.get()), path);
    return layout;
}

std::string svg_of(const Layout &layout, const std::string &path) {
    std::string bytes;
    const Surface surface(cairo_svg_surface_create_for_stream(append, &bytes, layout.width, layout.height),
                          cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    draw(context.get(), layout);
    expect(cairo_status(context.get()), path);
    cairo_surface_finish(surface.get());
    expect(cairo_surface_status(surface.get()), path);
    return bytes;
}

std::string png_of(const Layout &layout, const std::string &path) {
    std::string bytes;
    const Surface surface(
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, int(png_scale * layout.width), int(png_scale * layout.height)),
        cairo_surface_destroy);
    const Context context(cairo_create(surface.get()), cairo_destroy);
    cairo_scale(context.get(), png_scale, png_scale);
    draw(context.get(), layout);
    expect(cairo_status(context.get()), path);
    expect(cairo_surface_write_to_png_stream(surface.get(), append, &bytes), path);
    return bytes;
}

}  // namespace

void check_chart_name(const std::string &path) {
    if (!has_extension(path, ".svg") && !has_extension(path, ".png"))
        throw Failure(ExitCode::usage, path + ": a chart is written as .svg or .png; give a name that ends so");
}

void draw_chart(const Chart &chart, const std::string &path) {
    check_chart_name(path);
    const Layout layout = measure(chart, path);
    const std::string bytes = has_extension(path, ".svg") ? svg_of(layout, path) : png_of(layout, path);
    write_file(path, bytes.data(), bytes.size());
}

}  // namespace lensprof
