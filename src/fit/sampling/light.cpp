#include "fit/sampling/light.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace {

constexpr double kGamma = 2.2;
constexpr double kDarkest = 0.05;  // of M: beyond the corner a polynomial may have any value
constexpr int kSteps = 32;

double falloff(const lensprof_vignetting &vignetting, double r2) {
    return std::max(kDarkest, lensprof_vignetting_eval(&vignetting, r2, nullptr));
}

}  // namespace

Light::Light(const lensprof_response *response, const lensprof_vignetting *vignetting)
    : response_(response), vignetting_(vignetting) {
    for (int k = 0; vignetting_ && k <= kSteps; k++)
        darkest_ = std::min(darkest_, falloff(*vignetting_, static_cast<double>(k) / kSteps));
}

float Light::of(float grey, const lensprof_camera &camera, double x, double y) const {
    if (is_lost_grey(grey)) return grey;
    double light = response_ ? lensprof_response_invert(response_, static_cast<double>(grey), nullptr)
                             : std::pow(static_cast<double>(grey), kGamma);
    if (vignetting_) {
        const double r2 = lensprof_vignetting_r2(vignetting_, camera.width, camera.height, x, y, nullptr);
        light *= darkest_ / falloff(*vignetting_, r2);
    }
    return std::clamp(static_cast<float>(std::pow(light, 1.0 / kGamma)), kBlackGrey, kWhiteGrey);
}

}  // namespace lensprof
