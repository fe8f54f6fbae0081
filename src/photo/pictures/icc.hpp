// The tone curve according to a picture's colour profile (ICC).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lensprof {

enum class ToneCurve {
    unknown,  // no profile, or one without readable curves (tables, printers)
    linear,
    other
};

// From the tone curves of red, green and blue, or of grey, in profile[bytes].
ToneCurve tone_curve_of(const uint8_t *profile, size_t bytes);

// A profile with linear tone curves for pictures in camera colours (with sRGB primaries, because a profile needs some;
// its description states that the colours are those of the camera), or for grey pictures.
std::vector<uint8_t> linear_profile(bool grey);

}  // namespace lensprof
