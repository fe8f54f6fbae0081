// Where two images show the same: by the geometry of a project, and by what corrects that between the two.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include <lensprof/geometry.h>

namespace lensprof {

// Of a direction in longitude and latitude, radians, and back.
void unit_vector(const double direction[2], double v[3]);
void direction_of_vector(const double v[3], double direction[2]);

// Axis times angle, radians: where direction v of one image is in the other; the other way round with sign -1.
using Rotation = std::array<double, 3>;
void rotate(const Rotation &rotation, double sign, double direction[2]);

// What is wrong with a project between two images: the second camera is turned by `rotation`, and what it then shows at
// a place of its frame is found where the homography `bend` maps that place. Places there are half diagonals from the
// middle of the frame.
struct Correction {
    Rotation rotation{};
    std::optional<Eigen::Matrix3d> bend;
};

// From the correction's first image to its second, or back.
enum class Way {
    forward,
    back
};

// The place xy of image `to` that shows what image `from` shows at (x, y), px of the full frames. False where `to` does
// not look.
bool place_of(const lensprof_camera &from, const lensprof_camera &to, const Correction &correction, Way way, double x,
              double y, double xy[2]);

// The same with the surroundings.
struct Sight {
    double x, y;
    double map[2][2];  // d to / d from
};
bool sight(const lensprof_camera &from, const lensprof_camera &to, const Correction &correction, Way way, double x,
           double y, Sight &out);

// Places in half diagonals of a frame from its middle, and in px.
Eigen::Vector2d frame_place(const lensprof_camera &camera, double x, double y);
void pixel_place(const lensprof_camera &camera, const Eigen::Vector2d &place, double xy[2]);

}  // namespace lensprof
