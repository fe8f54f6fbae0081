#include "view.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace lensprof {
namespace {

constexpr int kReach = 2;                               // patches are (2 kReach + 1) pixels square
constexpr int kSide = 2 * kReach + 1, kCount = kSide * kSide;
constexpr double kSmallestSpread = 1.0 / 255.0;         // of a patch without noise

const uint8_t *pixel(const lensprof_image &view, int u, int v, uint32_t sample) {
    uint32_t bytes = lensprof_sample_bytes(view.sample);
    return static_cast<const uint8_t *>(view.data) + static_cast<ptrdiff_t>(v) * view.row_bytes
        + (static_cast<size_t>(u) * lensprof_layout_samples(view.layout) + sample) * bytes;
}

double load(const lensprof_image &view, int u, int v, uint32_t sample) {
    const uint8_t *p = pixel(view, u, v, sample);
    if (view.sample == LENSPROF_SAMPLE_U8) return *p / 255.0;
    if (view.sample == LENSPROF_SAMPLE_U16) {
        uint16_t value;
        std::memcpy(&value, p, sizeof value);
        return value / 65535.0;
    }
    float value;
    std::memcpy(&value, p, sizeof value);
    return value;
}

double median(double *values, int count) {
    std::nth_element(values, values + count / 2, values + count);
    return values[count / 2];
}

// Mean of the values within 2.5 standard deviations of the centre, which starts at the median: nearly as exact as a
// mean for plain noise, and hardly moved where a third of the pixels are wrong, even all on one side.
double robust_mean(double *values, int count) {
    double center = median(values, count), deviation[kCount];
    for (int i = 0; i < count; i++) deviation[i] = std::abs(values[i] - center);
    double spread = 1.4826 * median(deviation, count);
    for (int round = 0; round < 3; round++) {
        double limit = 2.5 * std::max(spread, kSmallestSpread), sum = 0.0, square = 0.0;
        int kept = 0;
        for (int i = 0; i < count; i++) {
            if (std::abs(values[i] - center) > limit) continue;
            sum += values[i];
            square += (values[i] - center) * (values[i] - center);
            kept++;
        }
        if (!kept) break;
        spread = std::min(spread, 1.1 * std::sqrt(square / kept));  // 1.1: what the cut takes away from plain noise
        center = sum / kept;
    }
    return center;
}

}  // namespace

int View::channels() const { return static_cast<int>(lensprof_layout_channels(image_.view.layout)); }

double View::sample(int u, int v, int channel) const {
    bool reversed = image_.view.layout == LENSPROF_LAYOUT_BGR || image_.view.layout == LENSPROF_LAYOUT_BGRA;
    return load(image_.view, u, v, static_cast<uint32_t>(reversed ? 2 - channel : channel));
}

bool View::is_allowed(int u, int v) const {
    if (image_.mask && !image_.mask[static_cast<ptrdiff_t>(v) * image_.mask_row_bytes + u]) return false;
    uint32_t colour = lensprof_layout_channels(image_.view.layout);
    return lensprof_layout_samples(image_.view.layout) == colour || load(image_.view, u, v, colour) >= 0.5;
}

bool View::find_not_finite(uint32_t &x, uint32_t &y) const {
    const auto &view = image_.view;
    if (view.sample != LENSPROF_SAMPLE_F32) return false;
    for (y = 0; y < view.height; y++)
        for (x = 0; x < view.width; x++)
            for (uint32_t s = 0; s < lensprof_layout_samples(view.layout); s++)
                if (!std::isfinite(load(view, static_cast<int>(x), static_cast<int>(y), s))) return true;
    return false;
}

void View::to_view(double x, double y, double &u, double &v) const {
    u = (x + 0.5) / image_.reduction - 0.5;
    v = (y + 0.5) / image_.reduction - 0.5;
}

bool View::holds(double x, double y) const {
    double u, v;
    to_view(x, y, u, v);
    return u >= kReach && v >= kReach && u <= image_.view.width - 1.0 - kReach
           && v <= image_.view.height - 1.0 - kReach;
}

bool View::in_range(const Patch &patch) const {
    for (int c = 0; c < channels(); c++)
        if (!(patch.value[c] >= image_.black && patch.value[c] <= image_.white)) return false;
    return true;
}

// A quick look before the work: in some channel, the middle and its four neighbours are all black or saturated.
bool View::is_out_of_range(int u, int v) const {
    for (int c = 0; c < channels(); c++) {
        int bad = 0;
        for (auto [du, dv] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
            double value = sample(u + du, v + dv, c);
            bad += !(value >= image_.black && value <= image_.white);
        }
        if (bad == 5) return true;
    }
    return false;
}

bool View::patch(double x, double y, Patch &out) const {
    double u, v;
    to_view(x, y, u, v);
    int iu = static_cast<int>(std::lround(u)), iv = static_cast<int>(std::lround(v));
    for (int dv = -kReach; dv <= kReach; dv++)
        for (int du = -kReach; du <= kReach; du++)
            if (!is_allowed(iu + du, iv + dv)) return false;
    if (is_out_of_range(iu, iv)) return false;
    out.gradient = 0.0;
    for (int c = 0; c < channels(); c++) {
        double all[kCount], low[2][kReach * kSide], high[2][kReach * kSide];  // [0] columns, [1] rows
        int n = 0, counts[4] = {0, 0, 0, 0};
        for (int dv = -kReach; dv <= kReach; dv++)
            for (int du = -kReach; du <= kReach; du++) {
                double value = sample(iu + du, iv + dv, c);
                all[n++] = value;
                if (du < 0) low[0][counts[0]++] = value;
                if (du > 0) high[0][counts[1]++] = value;
                if (dv < 0) low[1][counts[2]++] = value;
                if (dv > 0) high[1][counts[3]++] = value;
            }
        // The two halves' centres are kReach + 1 pixels apart; medians keep single wrong pixels out of the slope.
        double gu = (median(high[0], kReach * kSide) - median(low[0], kReach * kSide)) / (kReach + 1);
        double gv = (median(high[1], kReach * kSide) - median(low[1], kReach * kSide)) / (kReach + 1);
        double value = robust_mean(all, kCount) + gu * (u - iu) + gv * (v - iv);
        out.value[c] = std::clamp(value, 0.0, 1.0);
        out.gradient += std::hypot(gu, gv);
    }
    return in_range(out);
}

bool View::point(double x, double y, Patch &out) const {
    double u, v;
    to_view(x, y, u, v);
    int iu = static_cast<int>(u), iv = static_cast<int>(v);
    double fu = u - iu, fv = v - iv;
    out.gradient = 0.0;
    for (int dv = 0; dv < 2; dv++)
        for (int du = 0; du < 2; du++)
            if (!is_allowed(iu + du, iv + dv)) return false;
    for (int c = 0; c < channels(); c++) {
        double top = (1.0 - fu) * sample(iu, iv, c) + fu * sample(iu + 1, iv, c);
        double bottom = (1.0 - fu) * sample(iu, iv + 1, c) + fu * sample(iu + 1, iv + 1, c);
        out.value[c] = std::clamp((1.0 - fv) * top + fv * bottom, 0.0, 1.0);
        out.gradient += std::hypot(0.5 * (sample(iu + 1, iv, c) - sample(iu - 1, iv, c)),
                                   0.5 * (sample(iu, iv + 1, c) - sample(iu, iv - 1, c)));
    }
    return in_range(out);
}

}  // namespace lensprof
