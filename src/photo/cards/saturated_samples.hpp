// Where the samples of a sensor end below the full scale of their type, such as 12 bit in a file of 16 bit.
#pragma once

#include <optional>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// The largest sample of a picture of 16 bit, 0..1, if far more samples have it than have those below: they saturate.
std::optional<double> saturated_sample(const Picture &picture);

}  // namespace lensprof
