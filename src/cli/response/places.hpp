// Places of a raw frame and of the picture that the camera rendered of it: what the response is fitted to.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/pictures/picture.hpp"
#include "cli/response/alignment.hpp"

namespace lensprof {

// Means over a square of the rendered picture, and over the same part of the raw frame.
struct Place {
    enum Use : uint8_t {
        none,   // black, or partly white
        grey,   // between black and white
        white,  // all white: the response has reached it
    };
    std::array<float, 3> raw;         // linear, 0..1 of the sensor's saturation
    std::array<float, 3> grey_value;  // rendered, 0..1
    std::array<uint8_t, 3> use;
    float r2;                            // squared radius in the raw frame, half diagonals
    float across, down;                  // in the raw frame, 0..1
    uint32_t picture;                    // of several
    float chroma;                        // 0 = rendered neutral, 1 = a channel at 0
    float roughness;                     // of the raw green in the square and those around it: range over mean
    bool is_rougher, is_more_colourful;  // than half of the places of its grey level
};

// How much there is of a file, and how well the two fit.
struct PlacesOf {
    std::vector<Place> places;
    Alignment alignment;
    uint32_t squares = 0;                                                    // of the rendered picture
    uint32_t black = 0, white = 0, colourful = 0, saturated = 0, rough = 0;  // left out
    uint32_t width = 0, height = 0;                                          // of the rendered picture, px
    int quarter_turns = 0;  // by which it was turned to lie as the frame does
    uint32_t channels = 3;
};

constexpr uint32_t least_rendered_side = 256;  // px, of the longer side

// Aligns both and takes the places that are smooth: there, neither sharpening nor a small misalignment counts. `name`
// is that of the rendered picture in a Failure (not_usable): where the two do not show the same, or too little.
PlacesOf places_of(const Picture &raw, Picture rendered, uint32_t picture, const std::string &name);

}  // namespace lensprof
