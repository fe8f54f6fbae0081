// What a picture's colour profile (ICC) says of its tone curve.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lensprof {

enum class ToneCurve {
    unknown,  // no profile, or one without curves that can be read (of tables, of printers)
    linear,
    other
};

// By the tone curves of red, green and blue, or of grey, of profile[bytes].
ToneCurve tone_curve_of(const uint8_t *profile, size_t bytes);

}  // namespace lensprof
