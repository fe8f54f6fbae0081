// Where two images show the same scene point: by the geometry of a project, and by a correction between the two images.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include <lensprof/geometry.h>

namespace lensprof {

// Converts a direction in longitude and latitude, radians, to a unit vector, and back.
void unit_vector(const double direction[2], double v[3]);
void direction_of_vector(const double v[3], double direction[2]);

// Axis times angle, radians: maps direction v of one image to the other; the opposite way with sign -1.
using Rotation = std::array<double, 3>;
void rotate(const Rotation &rotation, double sign, double direction[2]);

// A homography of a frame and its inverse. Places are in half diagonals from the middle of the frame.
struct Bend {
    explicit Bend(const Eigen::Matrix3d &homography);

    Eigen::Matrix3d forward, back;
};

// The error of a project between two images: the second camera is rotated by `rotation`, and `bend` maps a place of its
// frame to the place that shows the same.
struct Correction {
    Rotation rotation{};
    std::optional<Bend> bend;
};

// From the correction's first image to its second, or back.
enum class Way {
    forward,
    back
};

// The place xy of image `to` that shows what image `from` shows at (x, y), px of the full frames. False if `to` does
// not see it.
bool place_of(const lensprof_camera &from, const lensprof_camera &to, const Correction &correction, Way way, double x,
              double y, double xy[2]);

// The same, with the local linear map of the surroundings.
struct Sight {
    double x, y;
    double map[2][2];  // d to / d from
};
bool sight(const lensprof_camera &from, const lensprof_camera &to, const Correction &correction, Way way, double x,
           double y, Sight &out);

// What of a sight depends only on the place, for sights under several corrections: the directions of the place and of
// two neighbours. Forward, they do not depend on the correction either.
class Gaze {
public:
    Gaze(const lensprof_camera &from, const Correction &correction, Way way, double x, double y);

    bool sight(const lensprof_camera &to, const Correction &correction, Way way, Sight &out) const;

private:
    struct Direction {
        std::array<double, 2> angles;  // longitude and latitude, radians
        bool is_known;
    };
    std::array<double, 2> step_;  // px to the neighbours across and down
    Direction middle_;
    std::array<Direction, 2> neighbour_;
};

// Whether a place of the first frame, given as shares of its width and height, lies in the second, according to the
// project.
bool sees(const lensprof_camera &first, const lensprof_camera &second, double across, double down);

// Converts places between half diagonals from the middle of a frame and px.
Eigen::Vector2d frame_place(const lensprof_camera &camera, double x, double y);
void pixel_place(const lensprof_camera &camera, const Eigen::Vector2d &place, double xy[2]);

}  // namespace lensprof
