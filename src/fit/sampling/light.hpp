// Grey values as the light behind them, where response and falloff are known.
#pragma once

#include <lensprof/model.h>
#include <lensprof/sample.h>

namespace lensprof {

// Grey values, 0..1, that say nothing: black and saturated ones.
constexpr float kBlackGrey = 0.004f, kWhiteGrey = 0.98f;

inline bool is_lost_grey(float grey) { return !(grey >= kBlackGrey && grey <= kWhiteGrey); }

// Blocks of light differ between two pictures by a factor alone. Blocks of grey values differ by the shoulder and the
// toe of the response, too, so that they correlate less the farther two exposures are apart.
class Light {
public:
    Light(const lensprof_response *response, const lensprof_vignetting *vignetting);  // NULL: not known

    bool is_known() const { return response_ || vignetting_; }

    // Grey value at (x, y), px of the full frame -> the light received there in the same range, with the gamma of 2.2
    // that makes noise even; lost values as they are.
    float of(float grey, const lensprof_camera &camera, double x, double y) const;

private:
    const lensprof_response *response_;
    const lensprof_vignetting *vignetting_;
    double darkest_ = 1.0;  // least M: what is brightened stays below white
};

}  // namespace lensprof
