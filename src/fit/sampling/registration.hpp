// Whether two images show the same at a pair of places, and how far a project is off between them: blocks of the
// pictures compared by normalised cross-correlation, which exposure, white balance and falloff leave as it is.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fit/sampling/view.hpp"

namespace lensprof {

// Of a direction in longitude and latitude, radians, and back.
void unit_vector(const double direction[2], double v[3]);
void direction_of_vector(const double v[3], double direction[2]);

// Axis times angle, radians: where direction v of one image is in the other; the other way round with sign -1.
using Rotation = std::array<double, 3>;
void rotate(const Rotation &rotation, double sign, double direction[2]);

// The place xy of the second image that shows what the first shows at (x, y), px of the full frames: by the geometry,
// and then `rotation` times `sign`. False where the second image does not look.
bool place_of(const lensprof_camera &first, const lensprof_camera &second, const Rotation &rotation, double sign,
              double x, double y, double xy[2]);

// The same with the surroundings.
struct Sight {
    double x, y;
    double map[2][2];  // d second / d first
};
bool sight(const lensprof_camera &first, const lensprof_camera &second, const Rotation &rotation, double sign, double x,
           double y, Sight &out);

// Grey levels of a view, at a quarter and at half its size.
class GreyLevels {
public:
    struct Level {
        int width = 0, height = 0;
        double pixel = 1.0;  // px of the full frame
        std::vector<float> grey;
    };

    explicit GreyLevels(const View &view);

    std::array<Level, 2> level;  // the coarse one first
};

// Correlation of the surroundings of a place; nothing where neither has texture. Low where something moved, stands in
// the way, or the project is wrong.
std::optional<double> likeness(const GreyLevels &first, double x, double y, const GreyLevels &second,
                               const Sight &sight);

// The small rotation under which blocks match, from coarse to fine. Zero where the project is right within a pixel of
// the views, or the pictures do not tell.
Rotation registration(const lensprof_camera &first, const GreyLevels &first_grey, const lensprof_camera &second,
                      const GreyLevels &second_grey);

}  // namespace lensprof
