// The cameras of pictures that were taken about one point, or of a scene that is nearly a plane, from what matches
// between them.
//
// Minimised is, over the angles of all pictures, the angle of view and the distortion (a, b, c) of every lens, and,
// where the camera moved, its places before a plane,
//
//     sum of rho(|project(camera_j, unproject(camera_i, x_i)) - x_j|^2 / s^2) + sum of (parameter - expected)^2 /
//     sigma^2
//
// over the matches x_i, x_j of the links, px; rho(e) = log(1 + e), a Cauchy loss, whose scale s falls from a tenth of
// the picture to a few px: loops that a wrong angle of view leaves open close first, then wrong links lose their
// weight. Levenberg-Marquardt steps, forward differences, sparse normal equations.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <lensprof/geometry.h>

#include "photo/registration/matching.hpp"
#include "photo/registration/registration.hpp"

namespace lensprof {

// Prior knowledge of a picture. Pictures with the same `lens` share angle of view and distortion.
struct PictureOptics {
    uint32_t width = 0, height = 0, lens = 0;
    std::optional<double> hfov_deg;  // according to its metadata
    uint16_t orientation = 1;        // of EXIF
};

struct FoundCameras {
    SceneKind kind = SceneKind::panorama;
    std::vector<lensprof_camera> cameras;  // per picture
    std::vector<double> link_residuals;    // median per link, as a share of the longer side
};

// Estimates the cameras of one group of pictures. Longitude 0 is at the centre of the panorama, and the horizon is
// level if the cameras turn about an upright axis.
FoundCameras find_cameras(const std::vector<PictureOptics> &pictures, const std::vector<PictureLink> &links);

}  // namespace lensprof
