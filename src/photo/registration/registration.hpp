// Registration of pictures without a project: finds overlaps and cameras.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <lensprof/photo.h>

#include "photo/base/events.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

enum class SceneKind {
    panorama,  // the camera rotated about one point
    plane,     // it moved over a scene that is nearly a plane
    still      // neither: frames from a tripod or a bracket, which do not show the falloff
};

// The same point in two images, px of their frames.
struct ControlPoint {
    uint32_t image[2];
    double xy[2][2];
};

// A group of pictures that overlap, directly or through others. Each camera has at least two, connected by its own
// pictures.
struct FoundScene {
    std::vector<uint32_t> pictures;  // indices, ascending; the members below use this order
    SceneKind kind = SceneKind::panorama;
    std::vector<lensprof_camera> cameras;
    std::vector<uint32_t> lenses;      // equal for pictures of one camera and size, with one lens at one focal length
    std::vector<uint32_t> camera_ids;  // equal for pictures of one camera, processing and size (upright or not)
    std::vector<ControlPoint> points;  // a few per link that the cameras explain
    std::vector<lensprof_match> matches;     // of the links that the cameras do not explain, or of all links
    bool by_matches = false;                 // pictures are compared at these matches, not through the cameras
    std::vector<lensprof_scene_link> links;  // overlapping pairs of pictures, sorted
    double residual = 0.0;                   // median over the links that fit, as a share of the longer side

    uint32_t connected_group = 0;  // equal for groups that are connected only by pictures of no group

    size_t unfit() const {  // number of links that the cameras do not explain
        return static_cast<size_t>(
            std::count_if(links.begin(), links.end(), [](const auto &link) { return !link.fits_cameras; }));
    }
    bool cameras_fit() const { return 2 * unfit() <= links.size(); }
};

// A picture that repeats another one.
struct CopiedPicture {
    uint32_t copy, original;
    std::string how;  // ", rotated, resized", or ""
};

struct Registration {
    std::vector<PictureMetadata> metadata;  // of every picture
    std::vector<FoundScene> scenes;         // largest first; stationary cameras last
    std::vector<uint32_t> isolated;         // pictures that overlap no other,
    // And those that overlap only pictures of other cameras: with a camera whose own pictures do not overlap, or do.
    std::vector<uint32_t> other_camera, disconnected;
    std::vector<std::pair<uint32_t, std::string>> unreadable;  // and the reasons
    std::vector<CopiedPicture> copies;                         // in no project
};

// Whether this program was built with registration (OpenCV).
bool can_register();

// Groups by camera, processing and size, unless `as_one` treats all as one; raw files are never mixed with others.
// `metadata` of each file; empty: it is read. Failure (usage) without OpenCV.
Registration register_pictures(const std::vector<std::string> &files, const std::vector<PictureMetadata> &metadata,
                               bool as_one, Events &events);

}  // namespace lensprof
