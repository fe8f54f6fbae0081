// Finds pictures that overlap: features that match under one homography.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

#include "photo/base/events.hpp"
#include "photo/registration/features.hpp"

namespace lensprof {

// Two overlapping pictures.
struct PictureLink {
    uint32_t picture[2];                                       // the lower index first
    std::vector<std::pair<cv::Point2d, cv::Point2d>> matches;  // px of the two full frames
    cv::Matx33d homography;                                    // from the first frame to the second, px
    bool is_still = false;                                     // almost nothing moved between the frames,
    bool is_scene = false;  // and this is the scene, not something fixed to the frame
};

// Up to this number of pictures, all links are looked for, with all features. Beyond, a picture that has enough links
// needs no more, and the largest features of two suffice for a link if many of them match.
constexpr size_t few_pictures = 40;

// Whether the camera only turned between neighbours in a sequence (or saw a plane): plenty of their features match, and
// nearly all of these follow one homography each.
bool turn_only(const std::vector<std::pair<Features, Features>> &neighbours);

// The links between pictures, sorted by index.
std::vector<PictureLink> find_links(const std::vector<Features> &pictures, Events &events);

// The group per picture: pictures linked directly or through others form a group. Groups are numbered in the order of
// their first picture.
using TakesLink = std::function<bool(const PictureLink &)>;
std::vector<uint32_t> groups_of(
    size_t pictures, const std::vector<PictureLink> &links,
    const TakesLink &takes = [](const PictureLink &) { return true; });

}  // namespace lensprof
