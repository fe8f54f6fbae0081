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
    double direction[2], source_xy[2] = {x, y};
    const bool is_forward = way == Way::forward;
    if (correction.bend && !is_forward && !apply_homography(from, correction.bend->back, source_xy)) return false;
    if (!lensprof_camera_unproject(&from, source_xy[0], source_xy[1], direction)) return false;
    rotate(correction.rotation, is_forward ? 1.0 : -1.0, direction);
    return lensprof_camera_project(&to, direction[0], direction[1], xy)
           && (!correction.bend || !is_forward || apply_homography(to, correction.bend->forward, xy));
}

bool sees(const lensprof_camera &first, const lensprof_camera &second, double across, double down) {
    double xy[2];
    return place_of(first, second, {}, Way::forward, across * first.width - 0.5, down * first.height - 0.5, xy)
           && xy[0] >= 0.0 && xy[1] >= 0.0 && xy[0] < second.width && xy[1] < second.height;
}

bool sight(const lensprof_camera &from, const lensprof_camera &to, const Correction &correction, Way way, double x,
           double y, Sight &out) {
    double xy[2], shifted[2];
    constexpr double step = 2.0;  // px
    if (!place_of(from, to, correction, way, x, y, xy)) return false;
    for (int d = 0; d < 2; d++) {
        double inwards = (d == 0 ? x < 0.5 * from.width : y < 0.5 * from.height) ? step : -step;
        double to_x = x + (d == 0 ? inwards : 0.0), to_y = y + (d == 1 ? inwards : 0.0);
        if (!place_of(from, to, correction, way, to_x, to_y, shifted)) return false;
        for (int e = 0; e < 2; e++) out.map[e][d] = (shifted[e] - xy[e]) / inwards;
    }
    out.x = xy[0], out.y = xy[1];
    return true;
}

}  // namespace lensprof
