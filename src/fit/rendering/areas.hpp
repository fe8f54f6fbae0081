// Areas of a raw frame and of the picture rendered from it: the input of the response fit.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <lensprof/rendering.h>

#include "fit/rendering/alignment.hpp"

namespace lensprof {

// Means over a square of the rendered picture and the same area of the raw frame.
struct Area {
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

// A shot: what is reported of it, and its areas.
struct RenderedShot {
    lensprof_rendering_shot found;
    std::vector<Area> areas;
};

// Aligns both pictures and selects smooth areas, where sharpening and a small misalignment do not matter. Errors: those
// of lensprof_rendering_add.
lensprof_status compare_pictures(const lensprof_image &raw, const lensprof_image &rendered, uint32_t picture,
                                 const Stop &stop, RenderedShot &shot, lensprof_error *error);

}  // namespace lensprof
