// The relative illuminance chart as SVG or PNG: one drawing for both.
#include <algorithm>
#include <cmath>

#include "cli/report/chart.hpp"
#include "cli/report/drawing.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/output_file.hpp"

namespace lensprof {
namespace {

constexpr double plot_width = 520, plot_height = 360, left = 70, top = 64, bottom = 58, right_axis = 84;
constexpr double key_width = 44, key_line = 20;

// Layout of the chart: positions of values, and space for text.
struct Layout {
    const Chart *chart;
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
    Layout layout{&chart, chart_axis(chart), 0, 0};
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

// The right axis: log2 M, in steps that leave room for the numbers.
void draw_ev_axis(cairo_t *cr, const Layout &layout) {
    const double high = std::log2(layout.axis.high), low = std::log2(std::max(layout.axis.low, layout.axis.high / 64));
    double step = 0.125;
    while ((high - low) / step > 8) step *= 2;
    set_grey(cr, 0.2);
    set_font(cr, text_size);
    for (double ev = step * std::floor(high / step); ev >= low; ev -= step) {
        const double y = layout.y(std::exp2(ev));
        if (ev < high && y - layout.y(std::exp2(ev + step)) < text_size) continue;  // labels would touch
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

void draw_curves(cairo_t *cr, const Layout &layout) {
    const std::vector<ChartCurve> &curves = layout.chart->curves;
    cairo_save(cr);
    cairo_rectangle(cr, left, top, plot_width, plot_height);
    cairo_clip(cr);
    for (size_t k = 0; k < curves.size(); k++)
        if (curves[k].has_sigma) {
            set_curve_colour(cr, k, 0.15);
            draw_band(cr, layout, curves[k]);
        }
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    for (size_t k = curves.size(); k-- > 0;) {
        set_curve_pen(cr, k);
        for (size_t i = 0; i < chart_samples; i++)
            cairo_line_to(cr, layout.x(double(i) / (chart_samples - 1)), layout.y(curves[k].m[i]));
        cairo_stroke(cr);
    }
    cairo_restore(cr);
}

void draw_key(cairo_t *cr, const Layout &layout) {
    const double x = left + plot_width + right_axis;
    const std::vector<ChartCurve> &curves = layout.chart->curves;
    set_font(cr, text_size);
    for (size_t k = 0; k < curves.size(); k++) {
        const double y = top + 8 + key_line * double(k);
        cairo_save(cr);
        set_curve_pen(cr, k);
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
    draw_text(cr, x, y, layout.chart->note, 0);
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
    draw_text(cr, 20, 46, layout.chart->title, 0);
    const double middle = left + 0.5 * plot_width;
    draw_text(cr, middle, top + plot_height + 42, "r, half diagonals from the centre of the falloff (1 = corner)", 0.5);
    draw_rotated_text(cr, 24, top + 0.5 * plot_height, "M, light relative to the centre");
    draw_rotated_text(cr, left + plot_width + 62, top + 0.5 * plot_height, "EV relative to the centre");
}

}  // namespace

void draw_chart(const Chart &chart, const std::string &path) {
    check_chart_name(path);
    Layout layout{&chart, {}, 0, 0};
    const auto measure = [&](cairo_t *cr) {
        layout = lay_out(chart, cr);
        return DrawingSize{layout.width, layout.height};
    };
    const std::string bytes = drawing_of(path, measure, [&](cairo_t *cr, const DrawingSize &) { draw(cr, layout); });
    write_file(path, bytes.data(), bytes.size());
}

}  // namespace lensprof
