#include "cli/report/gain_chart.hpp"

#include <algorithm>
#include <cmath>

#include "cli/report/drawing.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

constexpr double gains_width = 480, gains_height = 300, gains_left = 64, gains_top = 64, gains_bottom = 56,
                 gains_right = 24, gains_line = 20;
constexpr double max_levels = 30.0;
constexpr int points = 301;

// The share of the pairs whose ends differ by less than `levels`; their variance is half the squared difference.
std::vector<double> shares_of(const GainCurve &curve) {
    std::vector<double> levels;
    for (const double variance : curve.variances)
        if (!std::isnan(variance)) levels.push_back(std::sqrt(2.0 * variance));
    std::sort(levels.begin(), levels.end());
    std::vector<double> shares;
    for (int i = 0; i < points; i++) {
        const auto end = std::upper_bound(levels.begin(), levels.end(), max_levels * i / (points - 1));
        shares.push_back(double(end - levels.begin()) / double(std::max<size_t>(levels.size(), 1)));
    }
    return shares;
}

double x_of(double levels) { return gains_left + gains_width * levels / max_levels; }
double y_of(double share) { return gains_top + gains_height * (1.0 - share); }

void draw_axes(cairo_t *cr) {
    cairo_set_line_width(cr, 1);
    set_font(cr, text_size);
    for (int i = 0; i <= 6; i++) {
        const double x = x_of(max_levels * i / 6);
        set_grey(cr, 0.88);
        stroke_line(cr, x, gains_top, x, gains_top + gains_height);
        set_grey(cr, 0.2);
        draw_text(cr, x, gains_top + gains_height + 19, format("%g", max_levels * i / 6), 0.5);
    }
    for (int i = 0; i <= 4; i++) {
        const double y = y_of(0.25 * i);
        set_grey(cr, 0.88);
        stroke_line(cr, gains_left, y, gains_left + gains_width, y);
        set_grey(cr, 0.2);
        draw_text(cr, gains_left - 8, y + 4.5, format("%d %%", 25 * i), 1);
    }
    draw_text(cr, gains_left + 0.5 * gains_width, gains_top + gains_height + 42,
              "difference of a point's colour between two pictures, levels of 255", 0.5);
    cairo_rectangle(cr, gains_left, gains_top, gains_width, gains_height);
    cairo_stroke(cr);
}

void draw_curve(cairo_t *cr, size_t number, const GainCurve &curve) {
    const std::vector<double> shares = shares_of(curve);
    cairo_save(cr);
    set_curve_pen(cr, number);
    cairo_new_path(cr);  // text leaves a current point
    for (int i = 0; i < points; i++) cairo_line_to(cr, x_of(max_levels * i / (points - 1)), y_of(shares[size_t(i)]));
    cairo_stroke(cr);
    const double y = gains_top + gains_height - 16 - gains_line * double(2 - number),
                 x = gains_left + gains_width - 230;
    stroke_line(cr, x, y, x + 34, y);
    cairo_restore(cr);
    set_grey(cr, 0.1);
    set_font(cr, text_size);
    draw_text(cr, x + 44, y + 4.5, curve.label, 0);
}

}  // namespace

std::string gain_chart(const std::string &path, const std::string &title, const std::vector<GainCurve> &curves) {
    check_chart_name(path);
    const auto measure = [&](cairo_t *cr) {
        set_font(cr, text_size);
        return DrawingSize{std::ceil(std::max(gains_left + gains_width + gains_right, 40 + text_width(cr, title))),
                           gains_top + gains_height + gains_bottom};
    };
    return drawing_of(path, measure, [&](cairo_t *cr, const DrawingSize &) {
        set_grey(cr, 1);
        cairo_paint(cr);
        draw_axes(cr);
        for (size_t k = curves.size(); k-- > 0;) draw_curve(cr, k, curves[k]);
        set_grey(cr, 0.1);
        set_font(cr, title_size, true);
        draw_text(cr, 20, 26, "Share of the pairs that differ by less", 0);
        set_font(cr, text_size);
        draw_text(cr, 20, 46, title, 0);
    });
}

}  // namespace lensprof
