// Local tone mapping, as phones apply it after the response, by the surroundings of every pixel.
#include <algorithm>
#include <cmath>

#include "cli/simulate/simulate.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kColumns = 64;
constexpr double kSigma = kColumns / 10.0;  // of the surroundings, in columns: a tenth of the picture's width

// Gaussian along one direction, its weights summing to 1 at the borders too.
std::vector<double> blurred(const std::vector<double> &values, uint32_t count, uint32_t step, uint32_t lines,
                            uint32_t line_step) {
    std::vector<double> result(values.size());
    const auto reach = static_cast<int>(3.0 * kSigma);
    for (uint32_t line = 0; line < lines; line++)
        for (int i = 0; i < static_cast<int>(count); i++) {
            double sum = 0.0, weights = 0.0;
            for (int j = std::max(i - reach, 0); j <= std::min(i + reach, static_cast<int>(count) - 1); j++) {
                double w = std::exp(-0.5 * (i - j) * (i - j) / (kSigma * kSigma));
                sum += w * values[line * line_step + static_cast<uint32_t>(j) * step];
                weights += w;
            }
            result[line * line_step + static_cast<uint32_t>(i) * step] = sum / weights;
        }
    return result;
}

}  // namespace

ToneMap tone_map(const Truth &truth, const SimulatedScene &scene, uint32_t index) {
    const auto &camera = truth.cameras[index];
    ToneMap map;
    map.columns = kColumns;
    map.rows =
        std::max(2u, static_cast<uint32_t>(std::lround(kColumns * static_cast<double>(camera.height) / camera.width)));
    std::vector<double> luminance;
    for (uint32_t v = 0; v < map.rows; v++)
        for (uint32_t u = 0; u < map.columns; u++) {
            double x = (camera.width - 1.0) * u / (map.columns - 1.0), y = (camera.height - 1.0) * v / (map.rows - 1.0);
            double rgb[3], value[3];
            seen_radiance(truth, scene, index, x, y, rgb);
            record(truth, index, x, y, rgb, value);
            luminance.push_back((value[0] + 2.0 * value[1] + value[2]) / 4.0);
        }
    luminance = blurred(luminance, map.columns, 1, map.rows, map.columns);
    luminance = blurred(luminance, map.rows, map.columns, map.columns, 1);
    for (double l : luminance) map.ev.push_back(truth.local_tone * (1.0 - 2.0 * l));
    return map;
}

double tone_gain(const Truth &truth, uint32_t index, double x, double y) {
    const auto &camera = truth.cameras[index];
    const auto &map = truth.tone[index];
    double u = std::clamp(x / (camera.width - 1.0), 0.0, 1.0) * (map.columns - 1.0),
           v = std::clamp(y / (camera.height - 1.0), 0.0, 1.0) * (map.rows - 1.0);
    auto i = std::min(static_cast<uint32_t>(u), map.columns - 2), j = std::min(static_cast<uint32_t>(v), map.rows - 2);
    const double *above = &map.ev[j * map.columns + i], *below = above + map.columns;
    u -= i, v -= j;
    return std::exp2((1.0 - v) * ((1.0 - u) * above[0] + u * above[1]) + v * ((1.0 - u) * below[0] + u * below[1]));
}

void map_tone(double gain, double value[3]) {
    for (int c = 0; c < 3; c++)
        if (value[c] < 1.0) value[c] = std::min(value[c] * gain, 1.0);
}

}  // namespace lensprof
