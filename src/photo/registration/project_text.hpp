// Writes Hugin projects for pictures without one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <lensprof/geometry.h>

namespace lensprof {

// The same point in two images, px of their frames.
struct ControlPoint {
    uint32_t image[2];
    double xy[2][2];
};

struct ProjectImage {
    lensprof_camera camera;
    std::string name;     // without quotes and control characters
    uint32_t lens = 0;    // images with the same number are linked in response and falloff,
    uint32_t optics = 0;  // and in angle of view and distortion
};

// A project without photometric values; its `v` lines free those of all images, relative to the first. `comment` is the
// first line.
std::string new_project_text(const std::string &comment, const std::vector<ProjectImage> &images,
                             const std::vector<ControlPoint> &points = {});

}  // namespace lensprof
