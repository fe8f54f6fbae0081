// Pictures of a card, a clear sky or a light table, which have no features to match.
#pragma once

#include <string>

namespace lensprof {

struct Picture;

// Whether a picture changes as slowly over the frame as a falloff does: nothing else is in it. Failure.
bool shows_even_light(const Picture &picture);
bool shows_even_light(const std::string &file);

}  // namespace lensprof
