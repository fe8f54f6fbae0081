#include "fit/sampling/correction.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <lensprof/model.h>

namespace lensprof {
namespace {

double half_diagonal(const lensprof_camera &camera) { return lensprof_half_diagonal(camera.width, camera.height); }

// False for places beyond the homography's horizon.
bool apply_homography(const lensprof_camera &camera, const Eigen::Matrix3d &homography, double xy[2]) {
    const Eigen::Vector3d moved = homography * frame_place(camera, xy[0], xy[1]).homogeneous();
    constexpr double kHorizon = 0.1;
    if (!(moved[2] > kHorizon)) return false;
    pixel_place(camera, moved.hnormalized(), xy);
    return true;
}

// The direction, longitude and latitude, in which image `from` of a correction sees (x, y).
bool direction_of(const lensprof_camera &from, const Correction &correction, Way way, double x, double y,
                  std::array<double, 2> &direction) {
    double xy[2] = {x, y};
    if (correction.bend && way == Way::back && !apply_homography(from, correction.bend->back, xy)) return false;
    return lensprof_camera_unproject(&from, xy[0], xy[1], direction.data());
}

// The place at which image `to` sees a direction of the other.
bool place_in(const lensprof_camera &to, const Correction &correction, Way way, std::array<double, 2> direction,
              double xy[2]) {
    rotate(correction.rotation, way == Way::forward ? 1.0 : -1.0, direction.data());
    return lensprof_camera_project(&to, direction[0], direction[1], xy)
           && (!correction.bend || way == Way::back || apply_homography(to, correction.bend->forward, xy));
}

}  // namespace

Bend::Bend(const Eigen::Matrix3d &homography) : forward(homography), back(homography.inverse()) {}

void unit_vector(const double direction[2], double v[3]) {
    v[0] = std::cos(direction[1]) * std::sin(direction[0]);
    v[1] = std::sin(direction[1]);
    v[2] = std::cos(direction[1]) * std::cos(direction[0]);
}

void direction_of_vector(const double v[3], double direction[2]) {
    direction[0] = std::atan2(v[0], v[2]);
    direction[1] = std::asin(std::clamp(v[1], -1.0, 1.0));
}

void rotate(const Rotation &rotation, double sign, double direction[2]) {
    if (rotation[0] == 0.0 && rotation[1] == 0.0 && rotation[2] == 0.0) return;
    Eigen::Vector3d v, axis(rotation.data());
    unit_vector(direction, v.data());
    v = Eigen::AngleAxisd(sign * axis.norm(), axis.normalized()) * v;
    direction_of_vector(v.data(), direction);
}

Eigen::Vector2d frame_place(const lensprof_camera &camera, double x, double y) {
    return Eigen::Vector2d(x - 0.5 * (camera.width - 1.0), y - 0.5 * (camera.height - 1.0)) / half_diagonal(camera);
}

void pixel_place(const lensprof_camera &camera, const Eigen::Vector2d &place, double xy[2]) {
    xy[0] = 0.5 * (camera.width - 1.0) + half_diagonal(camera) * place[0];
    xy[1] = 0.5 * (camera.height - 1.0) + half_diagonal(camera) * place[1];
}

bool place_of(const lensprof_camera &from, const lensprof_camera &to, const Correction &correction, Way way, double x,
              double y, double xy[2]) {
    std::array<double, 2> direction;
    return direction_of(from, correction, way, x, y, direction) && place_in(to, correction, way, direction, xy);
}

bool sees(const lensprof_camera &first, const lensprof_camera &second, double across, double down) {
    double xy[2];
    return place_of(first, second, {}, Way::forward, across * first.width - 0.5, down * first.height - 0.5, xy)
           && xy[0] >= 0.0 && xy[1] >= 0.0 && xy[0] < second.width && xy[1] < second.height;
}

bool sight(const lensprof_camera &from, const lensprof_camera &to, const Correction &correction, Way way, double x,
           double y, Sight &out) {
    return Gaze(from, correction, way, x, y).sight(to, correction, way, out);
}

Gaze::Gaze(const lensprof_camera &from, const Correction &correction, Way way, double x, double y) {
    constexpr double step = 2.0;  // px, inwards
    step_ = {x < 0.5 * from.width ? step : -step, y < 0.5 * from.height ? step : -step};
    const auto look = [&](double to_x, double to_y, Direction &direction) {
        direction.is_known = direction_of(from, correction, way, to_x, to_y, direction.angles);
    };
    look(x, y, middle_), look(x + step_[0], y, neighbour_[0]), look(x, y + step_[1], neighbour_[1]);
}

bool Gaze::sight(const lensprof_camera &to, const Correction &correction, Way way, Sight &out) const {
    double xy[2], shifted[2];
    const auto sees = [&](const Direction &direction, double place[2]) {
        return direction.is_known && place_in(to, correction, way, direction.angles, place);
    };
    if (!sees(middle_, xy)) return false;
    for (size_t d = 0; d < 2; d++) {
        if (!sees(neighbour_[d], shifted)) return false;
        for (size_t e = 0; e < 2; e++) out.map[e][d] = (shifted[e] - xy[e]) / step_[d];
    }
    out.x = xy[0], out.y = xy[1];
    return true;
}

}  // namespace lensprof
