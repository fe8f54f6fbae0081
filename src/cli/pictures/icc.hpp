// What a picture's colour profile (ICC) says of its tone curve.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lensprof {

enum class ToneCurve {
    unknown,  // no profile, or one without curves that can be read (of tables, of printers)
    linear,
    other
};

// By the tone curves of red, green and blue, or of grey, of profile[bytes].
ToneCurve tone_curve_of(const uint8_t *profile, size_t bytes);

// A profile of linear tone curves, for pictures in a camera's own colours (with the primaries of sRGB, as a profile
// must have some; its description states that the colours are the camera's), or for grey ones.
std::vector<uint8_t> linear_profile(bool grey);

}  // namespace lensprof
