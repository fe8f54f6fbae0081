// Pictures in no project: which overlap, and the cameras that took them, as Hugin projects.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <lensprof/geometry.h>
#include <lensprof/sample.h>

#include "cli/program/progress.hpp"
#include "cli/registration/project_text.hpp"

namespace lensprof {

enum class SceneKind {
    panorama,  // the camera turned about one point
    plane,     // it moved, over a scene that is nearly a plane
    still      // neither: frames of a tripod, a bracket, which show no falloff
};

// Pictures that overlap, directly or through others. Of each camera there are at least two, which its own pictures
// join.
struct FoundProject {
    std::vector<uint32_t> pictures;  // their numbers, ascending; the members below are in this order
    SceneKind kind = SceneKind::panorama;
    std::vector<lensprof_camera> cameras;
    std::vector<uint32_t> lenses;  // those of one camera and size, with one lens at one focal length, have one number
    std::vector<uint32_t> bodies;  // those of one camera, processing and size (upright or not) have one number
    std::vector<ControlPoint> points;     // a few of every link that the cameras fit
    std::vector<lensprof_match> matches;  // of the links that they do not fit, or of all
    bool by_matches = false;              // these, and not the cameras, say where pictures show the same
    uint32_t links = 0, unfit = 0;        // pictures that show the same; those of them that the cameras do not fit
    double residual = 0.0;                // median over the links that fit, as a share of the longer side

    uint32_t whole = 0;  // one number where pictures that are of no project join them

    bool cameras_fit() const { return 2 * unfit <= links; }
};

struct Registration {
    std::vector<FoundProject> projects;  // the one with most pictures first; still cameras last
    std::vector<uint32_t> alone;         // pictures that overlap with no other,
    // And those that overlap with pictures of other cameras alone: of a camera of which no two others overlap, and of
    // one of which others do.
    std::vector<uint32_t> foreign, apart;
    std::vector<std::pair<uint32_t, std::string>> unreadable;  // and why
};

// Whether this program was built with what registration needs.
bool can_register();

// Of several cameras, processings and sizes, unless `as_one` takes all as of one; raw files and others never are one.
// Failure (usage) without OpenCV.
Registration register_pictures(const std::vector<std::string> &files, bool as_one, Progress &progress);

}  // namespace lensprof
