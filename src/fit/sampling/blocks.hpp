// Blocks of grey levels and their similarity: normalised cross-correlation, which is invariant to exposure, white
// balance and falloff.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/sampling/correction.hpp"
#include "fit/sampling/light.hpp"
#include "fit/sampling/view.hpp"

namespace lensprof {

constexpr double kTexture = 0.015;  // smallest standard deviation of a comparable block, grey value 0..1

// Grey levels of a view, or the corresponding light, at a quarter and at half its size.
class GreyLevels {
public:
    struct Level {
        int width = 0, height = 0;
        double pixel = 1.0;  // px of the full frame
        std::vector<float> grey;
    };

    GreyLevels(const View &view, const Light &light);

    // Share of a block's variance that comes from the scene. `texture` is its standard deviation on the coarse level;
    // noise is what two halves of the underlying pixels do not share.
    double reliability(double x, double y, double texture) const;

    std::array<Level, 2> level;  // the coarse one first
    std::array<Level, 2> wide;   // half of the coarse one, and half of that: for the surroundings of a smooth place

private:
    std::vector<float> noise_;  // variance about every coarse pixel
};

// The pixels of a level that a square about a place covers.
template <int reach>
struct Footprint {
    static constexpr int kSide = 2 * reach + 1, kCount = kSide * kSide;
    std::array<int, kCount> column, row;  // of every pixel of the square, row by row; may be outside of the level
    int first_column, last_column, first_row, last_row;

    // (x, y): full frame. `map` rotates and scales the square, given in px of the full frame `pixel` apart. False if it
    // is far from any level.
    bool lay(const GreyLevels::Level &level, double x, double y, double pixel, const double map[2][2]) {
        const double u0 = (x + 0.5) / level.pixel, v0 = (y + 0.5) / level.pixel, step = pixel / level.pixel;
        double u[kSide], v[kSide];
        for (int k = 0; k < kSide; k++) {
            const double a = step * (k - reach);
            u[k] = u0 + map[0][0] * a, v[k] = v0 + map[1][0] * a;
        }
        constexpr double kFarthest = 1 << 24;
        for (int k : {0, kSide - 1})
            if (!(std::abs(u[k]) < kFarthest && std::abs(v[k]) < kFarthest)) return false;
        for (int k = 0, n = 0; k < kSide; k++) {
            const double b = step * (k - reach), du = map[0][1] * b, dv = map[1][1] * b;
            for (int m = 0; m < kSide; m++, n++)
                column[static_cast<size_t>(n)] = whole(u[m] + du), row[static_cast<size_t>(n)] = whole(v[m] + dv);
        }
        find_range(column, first_column, last_column), find_range(row, first_row, last_row);
        return true;
    }

    bool lies_in(const GreyLevels::Level &level, const std::array<int, 2> &shift = {0, 0}) const {
        return first_column + shift[0] >= 0 && last_column + shift[0] < level.width && first_row + shift[1] >= 0
               && last_row + shift[1] < level.height;
    }

    // Index of a pixel in the level's `grey`.
    ptrdiff_t index(size_t k, const GreyLevels::Level &level) const {
        return static_cast<ptrdiff_t>(row[k]) * level.width + column[k];
    }

private:
    static int whole(double value) {  // std::floor is a call
        const int towards_zero = static_cast<int>(value);
        return towards_zero - (value < towards_zero);
    }

    // The map is linear: the corners are outermost.
    static void find_range(const std::array<int, kCount> &places, int &first, int &last) {
        const auto [low, high] =
            std::minmax({places[0], places[kSide - 1], places[kCount - kSide], places[kCount - 1]});
        first = low, last = high;
    }
};

// Grey values of a square of pixels, row by row; those of several squares side by side if Grey is a vector.
template <int reach, class Grey>
struct Square {
    static constexpr int kSide = 2 * reach + 1, kCount = kSide * kSide;
    std::array<Grey, kCount> value;

    void take_out_mean() {
        Grey sum{};
        for (const Grey &sample : value) sum += sample;
        sum /= static_cast<float>(kCount);
        for (Grey &sample : value) sample -= sum;
    }

    // The gradient over the square comes from light or falloff and does not identify a place.
    void take_out_gradient() {
        constexpr float squares = kSide * reach * (reach + 1) * kSide / 3.0f;  // of the columns, over all pixels
        Grey across{}, down{};
        for (size_t v = 0, k = 0; v < kSide; v++)
            for (size_t u = 0; u < kSide; u++, k++) across += value[k] * along(u), down += value[k] * along(v);
        for (size_t v = 0, k = 0; v < kSide; v++)
            for (size_t u = 0; u < kSide; u++, k++) value[k] -= (across * along(u) + down * along(v)) / squares;
    }

    Grey sum_of_squares() const {
        Grey sum{};
        for (const Grey &sample : value) sum += sample * sample;
        return sum;
    }

private:
    // Columns or rows from the middle.
    static constexpr float along(size_t k) { return static_cast<float>(k) - static_cast<float>(reach); }
};

// A square of level pixels about a place, normalised to mean 0 and length 1. Black and saturated pixels do not count.
template <int reach>
struct Block : Square<reach, float> {
    using Values = Square<reach, float>;
    using Values::kCount, Values::value;
    std::array<float, kCount> grey;
    double texture = 0.0;  // standard deviation before normalisation
    int lost = 0;          // number of black or saturated pixels

    // At (x, y) of the full frame; see Footprint::lay.
    bool cut(const GreyLevels::Level &level, double x, double y, double pixel, const double map[2][2]) {
        const bool is_seen = gather(level, x, y, pixel, map);
        if (is_seen) Values::take_out_mean(), normalise();
        return is_seen;
    }

    // The same without the gradient.
    bool cut_flat(const GreyLevels::Level &level, double x, double y, double pixel, const double map[2][2]) {
        const bool is_seen = gather(level, x, y, pixel, map);
        if (is_seen) Values::take_out_mean(), Values::take_out_gradient(), normalise();
        return is_seen;
    }

    // 0 if too few pixels count.
    double correlation(const Block &other) const {
        if (lost || other.lost) return correlation_of_rest(other.grey);
        float sum = 0.0f;
        for (size_t k = 0; k < value.size(); k++) sum += value[k] * other.value[k];
        return sum;
    }

    // The same from the pixels that count in both blocks alone.
    double correlation_of_rest(const std::array<float, kCount> &other) const {
        double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
        for (size_t k = 0; k < kCount; k++) {
            if (is_lost_grey(grey[k]) || is_lost_grey(other[k])) continue;
            const double p = grey[k], q = other[k];
            n += 1.0, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
        }
        const double of_both = (n * aa - a * a) * (n * bb - b * b);
        return 2.0 * n < kCount || !(of_both > 0.0) ? 0.0 : (n * ab - a * b) / std::sqrt(of_both);
    }

    // Number of pixels that count in both.
    int shared(const Block &other) const {
        int count = 0;
        for (size_t k = 0; k < kCount; k++) count += !is_lost_grey(grey[k]) && !is_lost_grey(other.grey[k]);
        return count;
    }

private:
    bool gather(const GreyLevels::Level &level, double x, double y, double pixel, const double map[2][2]) {
        Footprint<reach> footprint;
        if (!footprint.lay(level, x, y, pixel, map) || !footprint.lies_in(level)) return false;
        lost = 0;
        for (size_t k = 0; k < kCount; k++) {
            value[k] = grey[k] = level.grey[static_cast<size_t>(footprint.index(k, level))];
            lost += is_lost_grey(grey[k]);
        }
        return true;
    }

    void normalise() {
        const float square = Values::sum_of_squares(), length = std::sqrt(square);
        texture = std::sqrt(square / static_cast<float>(kCount));
        for (float &sample : value) sample = square > 0.0f ? sample / length : 0.0f;
    }
};

constexpr double kUpright[2][2] = {{1.0, 0.0}, {0.0, 1.0}};

// Correlation of the surroundings of a place, corrected for noise; empty if they have no scene texture that both images
// show. It is low if something moved or stands in the way, or if the project is wrong.
std::optional<double> likeness(const GreyLevels &first, double x, double y, const GreyLevels &second,
                               const Sight &sight);

// The same for the wider surroundings of a place without texture of its own: the square with texture, of one twice and
// one four times as wide.
std::optional<double> wide_likeness(const GreyLevels &first, double x, double y, const GreyLevels &second,
                                    const Sight &sight);

}  // namespace lensprof
