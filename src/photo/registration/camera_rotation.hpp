// Rotations of cameras, and between the rays of two pictures that match.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include <lensprof/geometry.h>

#include "photo/registration/cameras.hpp"

namespace lensprof {

using Match = std::pair<cv::Point2d, cv::Point2d>;
using Matches = std::vector<Match>;

double focal_px(const PictureOptics &picture, double hfov_deg);

// Rotation from the rays of the first picture to those of the second (Kabsch 1976).
Eigen::Matrix3d rotation_between(const PictureOptics &first, double first_hfov, const PictureOptics &second,
                                 double second_hfov, const Matches &matches);

// The angles of the camera model, from the world-to-camera rotation.
void set_angles(lensprof_camera &camera, const Eigen::Matrix3d &turn);
Eigen::Matrix3d turn_of(const lensprof_camera &camera);

// From the stored picture to the upright one, by EXIF orientation.
Eigen::Matrix3d upright(uint16_t orientation);

}  // namespace lensprof
