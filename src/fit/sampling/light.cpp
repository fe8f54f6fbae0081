#include "fit/sampling/light.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace {

constexpr double kGamma = 2.2;
constexpr double kDarkest = 0.05;   // of M: beyond the corner a polynomial may have any value
constexpr int kSteps = 32;          // of r^2 in the frame
constexpr double kLargestR2 = 4.0;  // with the centre in a corner
constexpr size_t kEntries = 4096;

double falloff(const lensprof_vignetting &vignetting, double r2) {
    return std::max(kDarkest, lensprof_vignetting_eval(&vignetting, r2, nullptr));
}

// Values of a function from 0 to `end`, in equal steps; and the value at x, between two of them.
template <class Function>
std::vector<double> table_of(double end, Function function) {
    std::vector<double> table(kEntries + 1);
    for (size_t k = 0; k <= kEntries; k++) table[k] = function(end * static_cast<double>(k) / kEntries);
    return table;
}

double value_in(const std::vector<double> &table, double end, double x) {
    const double place = std::clamp(x / end, 0.0, 1.0) * kEntries;
    const size_t low = std::min(static_cast<size_t>(place), kEntries - 1);
    const double share = place - static_cast<double>(low);
    return (1.0 - share) * table[low] + share * table[low + 1];
}

}  // namespace

Light::Light(const lensprof_response *response, const lensprof_vignetting *vignetting)
    : response_(response), vignetting_(vignetting) {
    if (response)
        brightness_ = table_of(1.0, [&](double grey) {
            return std::pow(lensprof_response_invert(response, grey, nullptr), 1.0 / kGamma);
        });
    if (!vignetting) return;
    double darkest = 1.0;  // least M: brightened values stay below white
    for (int k = 0; k <= kSteps; k++)
        darkest = std::min(darkest, falloff(*vignetting, static_cast<double>(k) / kSteps));
    factor_ =
        table_of(kLargestR2, [&](double r2) { return std::pow(darkest / falloff(*vignetting, r2), 1.0 / kGamma); });
}

float Light::of(float grey, const lensprof_camera &camera, double x, double y) const {
    if (is_lost_grey(grey)) return grey;
    double light = response_ ? value_in(brightness_, 1.0, grey) : grey;
    if (vignetting_)
        light *= value_in(factor_, kLargestR2,
                          lensprof_vignetting_r2(vignetting_, camera.width, camera.height, x, y, nullptr));
    return std::clamp(static_cast<float>(light), kBlackGrey, kWhiteGrey);
}

}  // namespace lensprof
