#include "formats/code/shader_table.hpp"

#include <algorithm>
#include <cmath>

#include "formats/falloff/curve_table.hpp"

namespace lensprof {
namespace {

constexpr double kLevels = 255.0;
constexpr double kLargestError = 0.3;  // levels
// 255, 510 and 1020 steps have nodes at all levels. A table and g meet at its nodes and neither falls, so their
// inverses lie in the same step: with 1020 steps an error is at most a quarter of a level.
constexpr size_t kSizes[] = {65, 129, 256, 511, 1021};
constexpr int kGreys = 1020, kRadii = 48;  // places at which errors are measured

// g, linear between its values.
double to_light(const std::vector<float> &table, double grey) {
    const double at = grey * static_cast<double>(table.size() - 1);
    const size_t i = std::min(static_cast<size_t>(at), table.size() - 2);
    return table[i] + (at - static_cast<double>(i)) * (static_cast<double>(table[i + 1]) - table[i]);
}

// Its inverse.
double from_light(const std::vector<float> &table, double light) {
    if (light >= table.back()) return 1.0;
    const auto above = std::upper_bound(table.begin(), table.end(), light);
    const auto i = static_cast<double>(above - table.begin()) - 1.0;
    return (i + (light - above[-1]) / (static_cast<double>(above[0]) - above[-1]))
           / static_cast<double>(table.size() - 1);
}

// Falloffs of a channel from the centre to the corner farthest from it.
std::vector<double> falloffs_of(const lensprof_vignetting &falloff) {
    const double reach = 1.0 + std::hypot(falloff.center[0], falloff.center[1]);
    std::vector<double> values;
    for (int i = 0; i <= kRadii; i++) {
        const double r = reach * i / kRadii;
        values.push_back(lensprof_vignetting_eval(&falloff, r * r, nullptr));
    }
    return values;
}

// Largest error of f(g(B) / M), in levels.
double error_of(const std::vector<float> &table, const lensprof_response &response,
                const std::vector<double> &falloffs) {
    double worst = 0.0;
    for (int i = 0; i <= kGreys; i++) {
        const double grey = static_cast<double>(i) / kGreys, light = lensprof_response_invert(&response, grey, nullptr),
                     of_table = to_light(table, grey);
        for (const double m : falloffs)
            worst = std::max(worst, std::fabs(from_light(table, of_table / m)
                                              - lensprof_response_eval(&response, light / m, nullptr)));
    }
    return kLevels * worst;
}

}  // namespace

ShaderTable shader_table(const lensprof_profile &profile) {
    ShaderTable table;
    for (const size_t size : kSizes) {
        table = {};
        for (uint32_t c = 0; c < profile.responses; c++) {
            const std::vector<double> light = irradiances_of(profile.response[c], size);
            table.values.emplace_back(light.begin(), light.end());
        }
        for (uint32_t c = 0; c < std::max(profile.responses, profile.vignettings); c++) {
            const uint32_t of_response = profile.responses == 3 ? c : 0, of_falloff = profile.vignettings == 3 ? c : 0;
            table.worst = std::max(table.worst, error_of(table.values[of_response], profile.response[of_response],
                                                         falloffs_of(profile.vignetting[of_falloff])));
        }
        if (table.worst < kLargestError) break;
    }
    return table;
}

}  // namespace lensprof
