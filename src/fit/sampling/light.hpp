// Converts grey values to light if response and falloff are known.
#pragma once

#include <vector>

#include <lensprof/model.h>
#include <lensprof/sample.h>

namespace lensprof {

// Grey values, 0..1, beyond which a value carries no information: black and saturated ones.
constexpr float kBlackGrey = 0.004f, kWhiteGrey = 0.98f;

inline bool is_lost_grey(float grey) { return !(grey >= kBlackGrey && grey <= kWhiteGrey); }

// Blocks of light differ between two pictures only by a factor. Blocks of grey values also differ by the shoulder and
// the toe of the response, so that they correlate less the farther apart two exposures are.
class Light {
public:
    Light(const lensprof_response *response, const lensprof_vignetting *vignetting);  // NULL: not known

    bool is_known() const { return response_ || vignetting_; }

    // Converts a grey value at (x, y), px of the full frame, to the light received there, in the same range and with a
    // gamma of 2.2 that makes the noise uniform. Black and saturated values stay as they are.
    float of(float grey, const lensprof_camera &camera, double x, double y) const;

private:
    const lensprof_response *response_;
    const lensprof_vignetting *vignetting_;
    // Tables, because there are millions of pixels: a grey value by the grey value measured, and the factor that the
    // falloff requires by r^2.
    std::vector<double> brightness_, factor_;
};

}  // namespace lensprof
