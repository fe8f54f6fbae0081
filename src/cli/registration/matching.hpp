// Which pictures show the same: features that match from picture to picture, under one homography.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "cli/program/progress.hpp"
#include "cli/registration/features.hpp"

namespace lensprof {

// Two pictures that show the same.
struct PictureLink {
    uint32_t picture[2];                                       // the lower number first
    std::vector<std::pair<cv::Point2d, cv::Point2d>> matches;  // px of the two full frames
    cv::Matx33d homography;                                    // from the first frame to the second, px
    bool is_still = false;                                     // hardly anything moved from one frame to the other,
    bool is_scene = false;  // and that is a scene, and not what is fixed to the frame
};

// The links among pictures, in the order of their numbers.
std::vector<PictureLink> find_links(const std::vector<Features> &pictures, Progress &progress);

// Of every picture the number of its group: pictures that links join, directly or through others, are one. Groups are
// numbered by their first picture.
using TakesLink = std::function<bool(const PictureLink &)>;
std::vector<uint32_t> groups_of(
    size_t pictures, const std::vector<PictureLink> &links,
    const TakesLink &takes = [](const PictureLink &) { return true; });

}  // namespace lensprof
