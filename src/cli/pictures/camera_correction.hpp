// Whether the camera, or a raw converter, has taken out the lens's falloff before: what a picture says of it.
#pragma once

#include <string>

#include <lensprof/profile.h>

namespace Exiv2 {
class Image;
}

namespace lensprof {

// Who did and what says so, "in camera (Sony: vignetting correction)"; empty where nothing says so. Maker notes speak
// of the camera's own JPEG: they say nothing of other files, nor of JPEGs whose Software is a raw converter, which
// copies them from the raw file.
std::string falloff_corrected_by(const Exiv2::Image &image, const lensprof_profile_key &key);

}  // namespace lensprof
