#include "fit/sampling/blocks.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace {

constexpr double kOfScene = 0.5;  // share of a block's variance: below it, noise dominates the similarity of blocks
constexpr double kFlat = 0.05;    // of the other's texture: no exposure explains less

// The mean of the middle two of every four pixels: a single wrong pixel has no effect. `rows(v)` returns row v of
// the larger level, followed by the next.
template <class Rows>
GreyLevels::Level halved(int width, int height, double pixel, const Rows &rows) {
    GreyLevels::Level to;
    to.width = width / 2, to.height = height / 2, to.pixel = 2.0 * pixel;
    to.grey.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height));
    for (int v = 0; v < to.height; v++) {
        const float *above = rows(2 * v), *below = above + width;
        float *out = to.grey.data() + static_cast<ptrdiff_t>(v) * to.width;
        for (int u = 0; u < to.width; u++, above += 2, below += 2) {
            float low = std::min(std::min(above[0], above[1]), std::min(below[0], below[1]));
            float high = std::max(std::max(above[0], above[1]), std::max(below[0], below[1]));
            out[u] = 0.5f * (above[0] + above[1] + below[0] + below[1] - low - high);
        }
    }
    return to;
}

GreyLevels::Level halved(const GreyLevels::Level &from) {
    return halved(from.width, from.height, from.pixel,
                  [&](int v) { return from.grey.data() + static_cast<ptrdiff_t>(v) * from.width; });
}

// From two rows of the view at a time: all would need as much memory as the pictures.
GreyLevels::Level halved(const View &view) {
    const auto &picture = view.image().view;
    std::vector<float> pair(2 * static_cast<size_t>(picture.width));
    return halved(static_cast<int>(picture.width), static_cast<int>(picture.height), view.image().reduction,
                  [&](int v) {
                      view.grey_row(v, pair.data()), view.grey_row(v + 1, pair.data() + picture.width);
                      return pair.data();
                  });
}

// Variance of the mean of every four pixels, from the difference of the two diagonals.
std::vector<float> noise_of_halved(const GreyLevels::Level &from) {
    const int width = from.width / 2, height = from.height / 2;
    std::vector<float> noise(static_cast<size_t>(width) * static_cast<size_t>(height));
    for (int v = 0; v < height; v++) {
        const float *above = from.grey.data() + static_cast<ptrdiff_t>(2 * v) * from.width, *below = above + from.width;
        float *out = noise.data() + static_cast<ptrdiff_t>(v) * width;
        for (int u = 0; u < width; u++, above += 2, below += 2) {
            const float difference = 0.25f * (above[0] + below[1] - above[1] - below[0]);
            out[u] = difference * difference;
        }
    }
    return noise;
}

// Mean over the square of pixels around every pixel, clipped to the frame; along rows, then along columns.
std::vector<float> mean_about(std::vector<float> values, int width, int height) {
    constexpr int kReach = 3;
    if (values.empty()) return values;
    auto along = [&](int lines, int length, ptrdiff_t line_step, ptrdiff_t step) {
        std::vector<double> before(static_cast<size_t>(length) + 1, 0.0);
        for (int line = 0; line < lines; line++) {
            float *const first = values.data() + line * line_step;
            for (int k = 0; k < length; k++)
                before[static_cast<size_t>(k) + 1] = before[static_cast<size_t>(k)] + first[k * step];
            for (int k = 0; k < length; k++) {
                const int from = std::max(k - kReach, 0), to = std::min(k + kReach + 1, length);
                first[k * step] = static_cast<float>(
                    (before[static_cast<size_t>(to)] - before[static_cast<size_t>(from)]) / (to - from));
            }
        }
    };
    along(height, width, width, 1);
    along(width, height, 1, width);
    return values;
}

void make_light(GreyLevels::Level &level, const Light &light, const lensprof_camera &camera) {
    for (int v = 0, n = 0; v < level.height; v++)
        for (int u = 0; u < level.width; u++, n++) {
            float &grey = level.grey[static_cast<size_t>(n)];
            grey = light.of(grey, camera, (u + 0.5) * level.pixel - 0.5, (v + 0.5) * level.pixel - 0.5);
        }
}

}  // namespace

GreyLevels::GreyLevels(const View &view, const Light &light) {
    level[1] = halved(view);
    if (light.is_known()) make_light(level[1], light, view.image().camera);
    level[0] = halved(level[1]);
    wide[0] = halved(level[0]);
    wide[1] = halved(wide[0]);
    noise_ = mean_about(noise_of_halved(level[1]), level[0].width, level[0].height);
}

double GreyLevels::reliability(double x, double y, double texture) const {
    const Level &coarse = level[0];
    const auto level_index = [&](double place, int size) {
        return static_cast<size_t>(std::clamp(static_cast<int>((place + 0.5) / coarse.pixel), 0, size - 1));
    };
    const double noise =
        noise_[level_index(y, coarse.height) * static_cast<size_t>(coarse.width) + level_index(x, coarse.width)];
    return texture > 0.0 ? std::max(0.0, 1.0 - noise / (texture * texture)) : 0.0;
}

std::optional<double> likeness(const GreyLevels &first, double x, double y, const GreyLevels &second,
                               const Sight &sight) {
    Block<3> a, b;
    const double pixel = first.level[0].pixel;
    if (!a.cut(first.level[0], x, y, pixel, kUpright) || !b.cut(second.level[0], sight.x, sight.y, pixel, sight.map)
        || std::max(a.texture, b.texture) < kTexture || 2 * a.shared(b) < Block<3>::kCount)
        return std::nullopt;
    if (std::min(a.texture, b.texture) < kFlat * std::max(a.texture, b.texture)) return 0.0;
    const double of_first = first.reliability(x, y, a.texture),
                 of_second = second.reliability(sight.x, sight.y, b.texture);
    if (std::min(of_first, of_second) < kOfScene) return std::nullopt;
    return std::min(1.0, a.correlation(b) / std::sqrt(of_first * of_second));
}

std::optional<double> wide_likeness(const GreyLevels &first, double x, double y, const GreyLevels &second,
                                    const Sight &sight) {
    for (size_t n = 0; n < first.wide.size(); n++) {
        Block<3> a, b;
        const double pixel = first.wide[n].pixel;
        if (!a.cut_flat(first.wide[n], x, y, pixel, kUpright)
            || !b.cut_flat(second.wide[n], sight.x, sight.y, pixel, sight.map))
            return std::nullopt;
        if (std::max(a.texture, b.texture) < kTexture || 2 * a.shared(b) < Block<3>::kCount) continue;
        return a.correlation(b);
    }
    return std::nullopt;
}

}  // namespace lensprof
