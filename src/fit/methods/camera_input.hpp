// Data of several cameras, parted: what each is fitted to.
#pragma once

#include <vector>

#include <lensprof/fit.h>

namespace lensprof {

constexpr uint32_t kNoPlace = UINT32_MAX;

// Images of one camera that pairs of its own join, and the data between them.
struct CameraInput {
    lensprof_fit_options options;   // its reference and links are of these images
    uint32_t number = 0;            // the caller's, of the camera
    std::vector<uint32_t> numbers;  // of its images among all
    std::vector<uint32_t> place;    // of each image of all among these; kNoPlace
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_link> links;
    std::vector<lensprof_pair> pairs;
    std::vector<lensprof_observation> observations;

    bool has_data() const { return images.size() > 1 && !(pairs.empty() && observations.empty()); }
};

// What a fit of several cameras is given. `observations`: tracks, which are fitted in place of their `pairs`; or none.
struct CamerasData {
    const lensprof_fit_options &options;
    const std::vector<lensprof_fit_image> &images;
    std::vector<lensprof_pair> pairs;
    std::vector<lensprof_observation> observations;
};

// Of each image the camera, numbered as they come.
std::vector<uint32_t> camera_numbers(const std::vector<lensprof_fit_image> &images);

// Of each camera, by these numbers, the largest group of its images that what they share joins, with the data between
// them. Unknowns that images of several cameras share are shared within each. Options point into the inputs, which must
// not be copied.
std::vector<CameraInput> part_cameras(const CamerasData &data, const std::vector<uint32_t> &camera_of);

}  // namespace lensprof
