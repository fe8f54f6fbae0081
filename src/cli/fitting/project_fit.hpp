// A project and its pictures -> the result, what is reported of it, and the project with the result in it.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/fitting.hpp"
#include "cli/fitting/lens_settings.hpp"
#include "cli/fitting/overlapping_pictures.hpp"
#include "cli/fitting/project.hpp"
#include "cli/report/gain_chart.hpp"

namespace lensprof {

constexpr uint32_t falloff_flags = LENSPROF_FREE_K1 | LENSPROF_FREE_K2 | LENSPROF_FREE_K3;
constexpr uint32_t lens_flags = LENSPROF_FREE_RESPONSE | falloff_flags | LENSPROF_FREE_CENTER;

// How a project is sampled and fitted, and under what its profile is stored.
struct ProjectFitOptions {
    FitOptions fit;
    StoreOptions store;
    std::string points, reference;
    uint32_t sampling = LENSPROF_SAMPLING_BALANCED, falloff_curves = 0;  // 0: held-out error decides
    uint32_t seed = 1, pairs = 0, max_side = 800;
    bool one_lens = false;  // all images are taken as at one lens setting
};

// What is fitted and found. Not to be copied: the options of `input` point to its other members.
struct ProjectFit {
    explicit ProjectFit(Progress &shown) : progress(shown) {}
    ProjectFit(const ProjectFit &) = delete;
    ProjectFit &operator=(const ProjectFit &) = delete;

    Progress &progress;
    BuildReport report;  // its camera_kind is given
    LensSettings settings;
    FitInput input;
    std::vector<uint32_t> points;  // of a reconstruction: the scene point of each pair
    Fitted best;
    std::vector<GainCurve> gains;  // of a reconstruction: before, by exposures alone, and by this result
    std::string item;              // the input's name in a Failure
};

// What the pictures say about themselves. Beside given pairs they may be anything: only what the profile's key needs is
// read.
std::vector<PictureMetadata> picture_metadata(const ProjectFitOptions &o, const Project &project);

// The key of the profile: EXIF of the reference picture, then what the command line says. With one_lens, warns of
// pictures at other settings.
lensprof_profile_key profile_key(const ProjectFitOptions &o, const Project &project,
                                 const std::vector<PictureMetadata> &metadata, Streams &streams);

// The pairs that fit_project starts from; tracks for the method radiance are none.
DrawnPairs first_pairs(const ProjectFitOptions &o, const Project &project, Progress &progress);

// Samples the pictures, or takes the points that are given, and fits. `prior` must live as long as `done`.
void fit_project(const ProjectFitOptions &o, Project &project, const std::vector<PictureMetadata> &metadata,
                 const EarlierProfile &prior, ProjectFit &done, Streams &streams);

// The text of the project, to be written to `path`, with the result in it. A project holds five modes and one falloff:
// where the result has more it is fitted once more with these.
std::string result_text(ProjectFit &done, Project &project, const std::string &path);

}  // namespace lensprof
