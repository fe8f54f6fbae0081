// Splits the data of several cameras into the input of one fit per camera.
#pragma once

#include <vector>

#include <lensprof/fit.h>

namespace lensprof {

constexpr uint32_t kNoPlace = UINT32_MAX;

// Images of one camera that are connected by its own pairs, and the data between them.
struct CameraInput {
    lensprof_fit_options options;   // its reference and links refer to these images
    uint32_t number = 0;            // the caller's camera number
    std::vector<uint32_t> numbers;  // index of each image among all images
    std::vector<uint32_t> place;    // for each of all images, its index here; else kNoPlace
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_link> links;
    std::vector<lensprof_pair> pairs;
    std::vector<lensprof_observation> observations;

    bool has_data() const { return images.size() > 1 && !(pairs.empty() && observations.empty()); }
};

// Input of a fit of several cameras. If there are `observations` (tracks), they are fitted instead of the `pairs`.
struct CamerasData {
    const lensprof_fit_options &options;
    const std::vector<lensprof_fit_image> &images;
    std::vector<lensprof_pair> pairs;
    std::vector<lensprof_observation> observations;
};

// Camera of each image, numbered in order of first appearance.
std::vector<uint32_t> camera_numbers(const std::vector<lensprof_fit_image> &images);

// For each camera, by these numbers, the largest group of its images that shared data connects, with the data between
// them. Unknowns shared by images of several cameras are shared only within each camera. Options point into the inputs,
// which must not be copied.
std::vector<CameraInput> part_cameras(const CamerasData &data, const std::vector<uint32_t> &camera_of);

}  // namespace lensprof
