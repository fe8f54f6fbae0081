#include "fit/rendering/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <Eigen/Dense>

namespace lensprof {
namespace {

constexpr double kPerceptual = 1.0 / 2.2;
constexpr int kCoarseSide = 80, kFineSide = 1024;
constexpr int kHalfWindow = 6;         // px: side of a level, and of the window for normalising structure
constexpr float kMinContrast = 0.01f;  // on the kPerceptual scale: below it is noise

double half_diagonal(const Plane &p) { return 0.5 * std::hypot(p.width, p.height); }

// Averages of `count` equal parts of a row, sharing pixels on boundaries proportionally.
void average_row(const std::vector<float> &row, std::vector<float> &parts) {
    const double step = double(row.size()) / double(parts.size());
    for (size_t i = 0; i < parts.size(); i++) {
        const double from = double(i) * step, to = std::min(from + step, double(row.size()));
        double sum = 0.0;
        for (auto k = static_cast<size_t>(from); double(k) < to; k++)
            sum += row[k] * (std::min(to, double(k + 1)) - std::max(from, double(k)));
        parts[i] = static_cast<float>(sum / step);
    }
}

// Of 8 or 16 bit samples, 0..1.
void read_channel(const lensprof_image &picture, int y, size_t channels, size_t channel, std::vector<float> &row) {
    const uint8_t *bytes = static_cast<const uint8_t *>(picture.data) + size_t(y) * picture.row_bytes;
    const auto *words = reinterpret_cast<const uint16_t *>(bytes);
    for (size_t x = 0; x < row.size(); x++) {
        const size_t index = x * channels + channel;
        row[x] = picture.sample == LENSPROF_SAMPLE_U16 ? static_cast<float>(words[index]) / 65535.0f
                                                       : static_cast<float>(bytes[index]) / 255.0f;
    }
}

Plane averaged(const lensprof_image &picture, int width, int height) {
    const size_t channels = picture.layout == LENSPROF_LAYOUT_GREY ? 1 : 3;
    Plane plane{width, height, std::vector<float>(size_t(width) * size_t(height), 0.0f)};
    std::vector<float> row(picture.width), parts(static_cast<size_t>(width));
    const double step = double(picture.height) / height;
    for (int y = 0; y < static_cast<int>(picture.height); y++) {
        read_channel(picture, y, channels, channels / 2, row);
        average_row(row, parts);
        for (auto k = static_cast<int>(y / step); k < height && k * step < y + 1; k++) {
            const double share = (std::min((k + 1) * step, y + 1.0) - std::max(k * step, double(y))) / step;
            float *out = plane.values.data() + size_t(k) * size_t(width);
            for (size_t x = 0; x < parts.size() && share > 0.0; x++) out[x] += static_cast<float>(share) * parts[x];
        }
    }
    return plane;
}

// Sums of all values above and left of a pixel, for means over windows.
class WindowSums {
public:
    WindowSums(const Plane &plane, bool squares) : width_(plane.width), height_(plane.height) {
        sums_.assign(size_t(width_ + 1) * size_t(height_ + 1), 0.0);
        for (int y = 0; y < height_; y++) {
            double row = 0.0;
            for (int x = 0; x < width_; x++) {
                const double v = plane.at(x, y);
                row += squares ? v * v : v;
                sums_[at(x + 1, y + 1)] = sums_[at(x + 1, y)] + row;
            }
        }
    }
    double mean(int x, int y) const {
        const int left = std::max(x - kHalfWindow, 0), right = std::min(x + kHalfWindow + 1, width_);
        const int top = std::max(y - kHalfWindow, 0), low = std::min(y + kHalfWindow + 1, height_);
        const double sum = sums_[at(right, low)] - sums_[at(left, low)] - sums_[at(right, top)] + sums_[at(left, top)];
        return sum / ((right - left) * (low - top));
    }

private:
    size_t at(int x, int y) const { return size_t(y) * size_t(width_ + 1) + size_t(x); }
    int width_, height_;
    std::vector<double> sums_;
};

// Removes local mean and contrast, which exposure, curve and falloff change; returns the share with contrast.
Plane normalised(const Plane &plane, double *texture) {
    const WindowSums sums(plane, false), squares(plane, true);
    Plane out = plane;
    size_t textured = 0;
    for (int y = 0; y < plane.height; y++)
        for (int x = 0; x < plane.width; x++) {
            const double mean = sums.mean(x, y);
            const auto contrast = static_cast<float>(std::sqrt(std::max(0.0, squares.mean(x, y) - mean * mean)));
            textured += contrast > 2.0f * kMinContrast;
            out.values[size_t(y) * size_t(plane.width) + size_t(x)] =
                (plane.at(x, y) - static_cast<float>(mean)) / (contrast + kMinContrast);
        }
    if (texture) *texture = double(textured) / double(std::max<size_t>(plane.values.size(), 1));
    return out;
}

// A value and its gradient between pixels; false outside.
bool sample(const Plane &p, double x, double y, double out[3]) {
    if (!(x >= 0.0 && y >= 0.0 && x < p.width - 1.0 && y < p.height - 1.0)) return false;
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    const double u = x - i, v = y - j;
    const double a = p.at(i, j), b = p.at(i + 1, j), c = p.at(i, j + 1), d = p.at(i + 1, j + 1);
    out[0] = (a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v;
    out[1] = (b - a) * (1 - v) + (d - c) * v;
    out[2] = (c - a) * (1 - u) + (d - b) * u;
    return true;
}

struct Level {
    Plane raw, rendered;
    double texture = 0.0;
};

Level level_of(const lensprof_image &raw, const lensprof_image &rendered, int side) {
    Level level;
    level.rendered = normalised(structure_of(rendered, side, 1.0), &level.texture);
    level.raw = normalised(structure_of(raw, side, kPerceptual), nullptr);
    return level;
}

double correlation_of(const Level &level, const Alignment &alignment) {
    const Plane &t = level.rendered, &raw = level.raw;
    const double rho = half_diagonal(t), raw_rho = half_diagonal(raw);
    double product = 0.0, first_square = 0.0, second_square = 0.0, at[2], value[3];
    size_t inside = 0;
    for (int y = 0; y < t.height; y++)
        for (int x = 0; x < t.width; x++) {
            alignment.map((x - 0.5 * (t.width - 1)) / rho, (y - 0.5 * (t.height - 1)) / rho, at);
            if (!sample(raw, 0.5 * (raw.width - 1) + raw_rho * at[0], 0.5 * (raw.height - 1) + raw_rho * at[1], value))
                continue;
            product += t.at(x, y) * value[0], first_square += t.at(x, y) * t.at(x, y),
                second_square += value[0] * value[0];
            inside++;
        }
    const double share = double(inside) / double(std::max<size_t>(t.values.size(), 1));
    return first_square > 0.0 && second_square > 0.0
               ? product / std::sqrt(first_square * second_square) * std::min(1.0, share / 0.8)
               : 0.0;
}

// The scale at which the rendered picture is as wide, or as high, as the frame: the smaller one.
double covering_scale(const lensprof_image &raw, const lensprof_image &rendered) {
    const double fit = std::min(double(raw.width) / rendered.width, double(raw.height) / rendered.height);
    return fit * std::hypot(rendered.width, rendered.height) / std::hypot(raw.width, raw.height);
}

Alignment best_of_grid(const Level &level, double cover) {
    Alignment best;
    best.scale = cover;
    for (double scale = 1.02; scale > 0.78; scale *= 0.98)
        for (int j = -3; j <= 3; j++)
            for (int i = -3; i <= 3; i++) {
                Alignment trial;
                trial.scale = cover * scale;
                trial.shift[0] = 0.02 * i, trial.shift[1] = 0.02 * j;
                trial.correlation = correlation_of(level, trial);
                if (trial.correlation > best.correlation) best = trial;
            }
    return best;
}

constexpr int kUnknowns = 5;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Gradient = Eigen::Matrix<double, kUnknowns, 1>;

// One row of pixels into the normal equations of (shift x, shift y, ln scale, k1, k2).
void add_row(const Level &level, const Alignment &a, int y, Normal &h, Gradient &g) {
    const Plane &t = level.rendered, &raw = level.raw;
    const double rho = half_diagonal(t), raw_rho = half_diagonal(raw);
    const double v = (y - 0.5 * (t.height - 1)) / rho;
    for (int x = 0; x < t.width; x++) {
        const double u = (x - 0.5 * (t.width - 1)) / rho, r2 = u * u + v * v;
        double at[2], value[3];
        a.map(u, v, at);
        if (!sample(raw, 0.5 * (raw.width - 1) + raw_rho * at[0], 0.5 * (raw.height - 1) + raw_rho * at[1], value))
            continue;
        const double residual = value[0] - t.at(x, y), weight = 1.0 / (1.0 + residual * residual);
        const double along = raw_rho * a.scale * (value[1] * u + value[2] * v);
        Gradient row;
        row << raw_rho * value[1], raw_rho * value[2], along * (1.0 + a.k1 * r2 + a.k2 * r2 * r2), along * r2,
            along * r2 * r2;
        h.noalias() += weight * row * row.transpose();
        g += weight * residual * row;
    }
}

// Constrains parameters that a picture with little texture at the edges does not determine.
void refine(const Level &level, bool bends, const Stop &stop, Alignment &a) {
    for (int round = 0; round < 12; round++) {
        stop.check();
        Normal h = Normal::Zero();
        Gradient g = Gradient::Zero();
        for (int y = 0; y < level.rendered.height; y++) add_row(level, a, y, h, g);
        const double size = h(2, 2) + 1e-9;
        h.diagonal().array() += 1e-6 * size;
        h(3, 3) += (bends ? 1e-3 : 1e9) * size, h(4, 4) += (bends ? 1e-2 : 1e9) * size;
        g(3) += (bends ? 1e-3 : 0.0) * size * a.k1, g(4) += (bends ? 1e-2 : 0.0) * size * a.k2;
        const Gradient step = h.ldlt().solve(-g);
        Alignment trial = a;
        trial.shift[0] += step(0), trial.shift[1] += step(1);
        trial.scale *= std::exp(std::clamp(step(2), -0.05, 0.05));
        trial.k1 += step(3), trial.k2 += step(4);
        trial.correlation = correlation_of(level, trial);
        if (!(trial.correlation >= a.correlation)) return;
        a = trial;
        if (step.cwiseAbs().maxCoeff() < 1e-6) return;
    }
}

}  // namespace

void Alignment::map(double x, double y, double raw[2]) const {
    const double r2 = x * x + y * y, bend = scale * (1.0 + k1 * r2 + k2 * r2 * r2);
    raw[0] = shift[0] + bend * x;
    raw[1] = shift[1] + bend * y;
}

Plane structure_of(const lensprof_image &picture, int side, double exponent) {
    const double reduction = std::max(1.0, double(std::max(picture.width, picture.height)) / side);
    Plane plane = averaged(picture, std::max(1, static_cast<int>(std::lround(picture.width / reduction))),
                           std::max(1, static_cast<int>(std::lround(picture.height / reduction))));
    if (exponent == 1.0) return plane;
    double sum = 0.0;
    for (float v : plane.values) sum += v;
    const double white = std::max(5.0 * sum / double(plane.values.size()), 1e-6);
    for (float &v : plane.values) v = static_cast<float>(std::pow(std::min(1.0, v / white), exponent));
    return plane;
}

Alignment align_coarsely(const lensprof_image &raw, const lensprof_image &rendered, const Stop &stop) {
    const Level level = level_of(raw, rendered, kCoarseSide);
    Alignment alignment = best_of_grid(level, covering_scale(raw, rendered));
    refine(level, false, stop, alignment);
    alignment.texture = level.texture;
    return alignment;
}

Alignment align_pictures(const lensprof_image &raw, const lensprof_image &rendered, const Stop &stop) {
    Alignment alignment = align_coarsely(raw, rendered, stop);
    const int longer_side = static_cast<int>(std::max(rendered.width, rendered.height));
    for (int side = 2 * kCoarseSide; side / 2 < std::min(longer_side, kFineSide); side *= 2) {
        const Level level = level_of(raw, rendered, std::min(side, kFineSide));
        alignment.correlation = correlation_of(level, alignment);
        refine(level, side > 2 * kCoarseSide, stop, alignment);
        alignment.texture = level.texture;
    }
    return alignment;
}

RotatedImage rotated(const lensprof_image &picture, int quarters) {
    RotatedImage out{{}, picture};
    if (quarters % 4 == 0) return out;
    const size_t bytes = picture.layout == LENSPROF_LAYOUT_GREY ? 1 : 3;
    if (quarters % 2) std::swap(out.view.width, out.view.height);
    out.view.row_bytes = size_t(out.view.width) * bytes;
    out.pixels.resize(out.view.row_bytes * out.view.height);
    out.view.data = out.pixels.data();
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = 0; x < picture.width; x++) {
            const uint32_t right = picture.height - 1 - y, back = picture.width - 1 - x;
            const uint32_t to_x = quarters == 1 ? right : quarters == 2 ? back : y;
            const uint32_t to_y = quarters == 1 ? x : quarters == 2 ? right : back;
            std::memcpy(out.pixels.data() + to_y * out.view.row_bytes + to_x * bytes,
                        static_cast<const uint8_t *>(picture.data) + y * picture.row_bytes + x * bytes, bytes);
        }
    return out;
}

}  // namespace lensprof
