// Areas of a raw frame and of the picture rendered from it: the input of the response fit.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/pictures/picture.hpp"
#include "cli/response/alignment.hpp"

namespace lensprof {

// Means over a square of the rendered picture and the same area of the raw frame.
struct Place {
    enum Use : uint8_t {
        none,   // black, or partly white
        grey,   // unclipped
        white,  // all white: the response is at its maximum
    };
    std::array<float, 3> raw;         // linear, 0..1 up to the sensor's saturation
    std::array<float, 3> grey_value;  // rendered, 0..1
    std::array<uint8_t, 3> use;
    float r2;                            // squared radius in the raw frame, half diagonals
    float across, down;                  // in the raw frame, 0..1
    uint32_t picture;                    // of several
    float chroma;                        // 0 = rendered neutral, 1 = a channel at 0
    float roughness;                     // of the raw green in this and the adjacent squares: range over mean
    bool is_rougher, is_more_colourful;  // more even than half of the areas of its grey level
};

// Statistics of a file, and how well both pictures align.
struct PlacesOf {
    std::vector<Place> places;
    Alignment alignment;
    uint32_t squares = 0;                                                    // of the rendered picture
    uint32_t black = 0, white = 0, colourful = 0, saturated = 0, rough = 0;  // left out
    uint32_t width = 0, height = 0;                                          // of the rendered picture, px
    int quarter_turns = 0;                                                   // rotation that aligns it with the frame
    uint32_t channels = 3;
};

constexpr uint32_t min_rendered_side = 256;  // px, of the longer side

// Aligns both and selects smooth areas, where sharpening and a small misalignment do not matter. `name` is the name of
// the rendered picture in a Failure (not_usable): if the two do not match, or there are too few areas.
PlacesOf places_of(const Picture &raw, Picture rendered, uint32_t picture, const std::string &name);

}  // namespace lensprof
