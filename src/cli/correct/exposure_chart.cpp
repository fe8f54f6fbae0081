#include "cli/correct/exposure_chart.hpp"

#include <algorithm>
#include <cmath>

#include "cli/report/drawing.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

constexpr double plot_width = 900, plot_height = 320, plot_left = 74, plot_top = 60, plot_bottom = 56, margin = 24;

// A step of 1, 2 or 5 times a power of ten, of which at most `most` fit into a range.
double round_step(double range, double most) {
    double step = std::pow(10.0, std::floor(std::log10(range / most)));
    for (const double factor : {1.0, 2.0, 5.0, 10.0})
        if (range / (step * factor) <= most) return step * factor;
    return step * 10.0;
}

struct ExposureAxes {
    double begin, end, low, high;

    explicit ExposureAxes(const std::vector<LevelledFrame> &frames)
        : begin(frames.front().measured.seconds), end(frames.back().measured.seconds), low(INFINITY), high(-INFINITY) {
        for (const LevelledFrame &frame : frames) {
            if (frame.measured.state != LENSPROF_FRAME_LEVELLED) continue;
            low = std::min({low, frame.measured.exposure.ev, frame.wanted.ev});
            high = std::max({high, frame.measured.exposure.ev, frame.wanted.ev});
        }
        if (!(end > begin)) end = begin + 1.0;
        const double space = std::max(0.05 * (high - low), 0.02);
        low -= space, high += space;
    }

    double x(double seconds) const { return plot_left + plot_width * (seconds - begin) / (end - begin); }
    double y(double ev) const { return plot_top + plot_height * (high - ev) / (high - low); }
};

void draw_axes(cairo_t *cr, const ExposureAxes &axes, bool has_times, const std::string &title, ChartOf shown) {
    set_font(cr, text_size);
    cairo_set_line_width(cr, 1);
    const double ev_step = round_step(axes.high - axes.low, 8), step = round_step(axes.end - axes.begin, 10);
    for (double ev = ev_step * std::ceil(axes.low / ev_step); ev <= axes.high; ev += ev_step) {
        set_grey(cr, 0.88);
        stroke_line(cr, plot_left, axes.y(ev), plot_left + plot_width, axes.y(ev));
        set_grey(cr, 0.2);
        draw_text(cr, plot_left - 8, axes.y(ev) + 4.5, format("%.4g", std::abs(ev) < 1e-9 ? 0.0 : ev), 1);
    }
    for (double t = axes.begin; t <= axes.end + 1e-9; t += step) {
        set_grey(cr, 0.88);
        stroke_line(cr, axes.x(t), plot_top, axes.x(t), plot_top + plot_height);
        set_grey(cr, 0.2);
        draw_text(cr, axes.x(t), plot_top + plot_height + 19, format("%.6g", t), 0.5);
    }
    cairo_rectangle(cr, plot_left, plot_top, plot_width, plot_height);
    cairo_stroke(cr);
    draw_text(cr, plot_left + plot_width / 2, plot_top + plot_height + 42, has_times ? "time, s" : "frame", 0.5);
    draw_rotated_text(cr, 24, plot_top + plot_height / 2,
                      shown == ChartOf::exposures ? "exposure, EV" : "light and exposure, EV");
    set_grey(cr, 0.1);
    set_font(cr, title_size, true);
    draw_text(cr, 20, 26, title, 0);
}

template <class Value>
void draw_line(cairo_t *cr, const ExposureAxes &axes, const std::vector<LevelledFrame> &frames, const Value &value_of) {
    const LevelledFrame *before = nullptr;
    for (const LevelledFrame &frame : frames) {
        if (frame.measured.state != LENSPROF_FRAME_LEVELLED) continue;
        const double x = axes.x(frame.measured.seconds), y = axes.y(value_of(frame));
        if (before && before->measured.segment == frame.measured.segment)
            cairo_line_to(cr, x, y);
        else
            cairo_move_to(cr, x, y);
        before = &frame;
    }
    cairo_stroke(cr);
}

void draw_frames(cairo_t *cr, const ExposureAxes &axes, const std::vector<LevelledFrame> &frames, ChartOf shown) {
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(cr, 1.2);
    set_curve_colour(cr, 1, 0.8);
    draw_line(cr, axes, frames, [](const LevelledFrame &frame) { return frame.measured.exposure.ev; });
    cairo_set_line_width(cr, 2);
    set_curve_colour(cr, 0);
    if (shown == ChartOf::levelling)
        draw_line(cr, axes, frames, [](const LevelledFrame &frame) { return frame.wanted.ev; });
    set_grey(cr, 0.2);
    for (const LevelledFrame &frame : frames) {
        if (frame.measured.state == LENSPROF_FRAME_LEVELLED) continue;
        const double x = axes.x(frame.measured.seconds), y = plot_top + plot_height - 8;
        stroke_line(cr, x - 3, y - 3, x + 3, y + 3);
        stroke_line(cr, x - 3, y + 3, x + 3, y - 3);
    }
}

void draw_key(cairo_t *cr) {
    set_font(cr, text_size);
    const char *const words[] = {"after", "before"};
    double x = plot_left + plot_width;
    for (size_t curve = 2; curve-- > 0;) {
        set_grey(cr, 0.1);
        draw_text(cr, x, 46, words[curve], 1);
        x -= text_width(cr, words[curve]) + 8;
        set_curve_colour(cr, curve);
        cairo_set_line_width(cr, curve ? 1.2 : 2);
        stroke_line(cr, x - 28, 42, x, 42);
        x -= 48;
    }
}

}  // namespace

std::string exposure_chart(const std::vector<LevelledFrame> &frames, bool has_times, const std::string &title,
                           const std::string &path, ChartOf shown) {
    return drawing_of(
        path,
        [](cairo_t *) {
            return DrawingSize{plot_left + plot_width + margin, plot_top + plot_height + plot_bottom};
        },
        [&](cairo_t *cr, const DrawingSize &) {
            const ExposureAxes axes(frames);
            set_grey(cr, 1);
            cairo_paint(cr);
            draw_axes(cr, axes, has_times, title, shown);
            draw_frames(cr, axes, frames, shown);
            if (shown == ChartOf::levelling) draw_key(cr);
        });
}

}  // namespace lensprof
