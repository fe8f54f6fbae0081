// The cameras that are fitted: rectilinear, with radial distortion, turned, and moved before the plane z = 1. The model
// is that of geometry.h; what depends on the camera alone is computed once, and points need no angles.
#pragma once

#include <Eigen/Core>

#include <lensprof/geometry.h>

namespace lensprof {

class Pinhole {
public:
    Pinhole() = default;
    explicit Pinhole(const lensprof_camera &camera);  // ignores what is not fitted: shift, shear, other planes

    // The direction of a pixel in the frame of the camera, without distortion. False outside the lens.
    bool ray(double x, double y, Eigen::Vector3d &direction) const;

    // From the frame of the camera to that of the scene: where the ray meets the plane if the camera was moved. False
    // if it does not.
    bool seen(const Eigen::Vector3d &ray, Eigen::Vector3d &direction) const;

    // The pixel of what is seen in a direction from the centre. False if the camera does not see it.
    bool project(const Eigen::Vector3d &direction, Eigen::Vector2d &xy) const;

private:
    double scale_at(double r) const;     // of a distance r from the axis, half of the shorter side = 1
    double undistorted(double r) const;  // negative if there is no such distance
    double slope(double r) const;
    double end_of_rise() const;

    Eigen::Matrix3d turn_;  // scene to camera
    Eigen::Vector3d place_;
    Eigen::Vector2d centre_;
    double focal_ = 1.0, half_side_ = 1.0, radial_[4] = {};  // the coefficients of r^4, r^3, r^2 and r
    double rises_to_ = 0.0;                                  // the distance up to which the distortion rises
    bool is_moved_ = false, is_distorted_ = false;
};

}  // namespace lensprof
