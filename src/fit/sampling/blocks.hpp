// Blocks of grey levels and their similarity: normalised cross-correlation, which is invariant to exposure, white
// balance and falloff.
#pragma once

#include <array>
#include <cmath>
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

// A square of level pixels about a place, normalised to mean 0 and length 1. Black and saturated pixels do not count.
template <int reach>
struct Block {
    static constexpr int kSide = 2 * reach + 1, kCount = kSide * kSide;
    std::array<float, kCount> value;
    std::array<float, kCount> grey;
    double texture = 0.0;  // standard deviation before normalisation
    int lost = 0;          // number of black or saturated pixels

    // (x, y): full frame. `map` rotates and scales the square, given in px of the full frame `pixel` apart.
    bool cut(const GreyLevels::Level &level, double x, double y, double pixel, const double map[2][2]) {
        const bool is_seen = gather(level, x, y, pixel, map);
        if (is_seen) normalise();
        return is_seen;
    }

    // The same without the gradient over the block, which comes from light or falloff and does not identify a place.
    bool cut_flat(const GreyLevels::Level &level, double x, double y, double pixel, const double map[2][2]) {
        const bool is_seen = gather(level, x, y, pixel, map);
        if (is_seen) take_out_gradient(), normalise();
        return is_seen;
    }

    // 0 if too few pixels count.
    double correlation(const Block &other) const {
        if (lost || other.lost) return correlation_of_rest(other);
        float sum = 0.0f;
        for (size_t k = 0; k < value.size(); k++) sum += value[k] * other.value[k];
        return sum;
    }

    // Number of pixels that count in both.
    int shared(const Block &other) const {
        int count = 0;
        for (size_t k = 0; k < kCount; k++) count += !is_lost_grey(grey[k]) && !is_lost_grey(other.grey[k]);
        return count;
    }

private:
    // Reads `value`, less its mean.
    bool gather(const GreyLevels::Level &level, double x, double y, double pixel, const double map[2][2]) {
        const double u0 = (x + 0.5) / level.pixel, v0 = (y + 0.5) / level.pixel, step = pixel / level.pixel;
        float sum = 0.0f;
        lost = 0;
        for (int k = 0; k < kCount; k++) {
            const double a = step * (k % kSide - reach), b = step * (k / kSide - reach);
            const double u = std::floor(u0 + map[0][0] * a + map[0][1] * b);
            const double v = std::floor(v0 + map[1][0] * a + map[1][1] * b);
            if (!(u >= 0.0 && v >= 0.0 && u < level.width && v < level.height)) return false;
            const float sample =
                level.grey[static_cast<size_t>(v) * static_cast<size_t>(level.width) + static_cast<size_t>(u)];
            grey[static_cast<size_t>(k)] = sample;
            lost += is_lost_grey(sample);
            sum += sample;
        }
        for (size_t k = 0; k < kCount; k++) value[k] = grey[k] - sum / kCount;
        return true;
    }

    void take_out_gradient() {
        float along[2] = {0.0f, 0.0f}, squares = 0.0f;
        for (int k = 0; k < kCount; k++) {
            const auto a = static_cast<float>(k % kSide - reach), b = static_cast<float>(k / kSide - reach);
            along[0] += a * value[static_cast<size_t>(k)], along[1] += b * value[static_cast<size_t>(k)];
            squares += a * a;
        }
        for (int k = 0; k < kCount; k++)
            value[static_cast<size_t>(k)] -=
                (along[0] * static_cast<float>(k % kSide - reach) + along[1] * static_cast<float>(k / kSide - reach))
                / squares;
    }

    void normalise() {
        float square = 0.0f;
        for (const float sample : value) square += sample * sample;
        texture = std::sqrt(square / kCount);
        for (float &sample : value) sample = square > 0.0f ? sample / std::sqrt(square) : 0.0f;
    }

    double correlation_of_rest(const Block &other) const {
        double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
        for (size_t k = 0; k < kCount; k++) {
            if (is_lost_grey(grey[k]) || is_lost_grey(other.grey[k])) continue;
            const double p = grey[k], q = other.grey[k];
            n += 1.0, a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
        }
        const double of_both = (n * aa - a * a) * (n * bb - b * b);
        return 2.0 * n < kCount || !(of_both > 0.0) ? 0.0 : (n * ab - a * b) / std::sqrt(of_both);
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
