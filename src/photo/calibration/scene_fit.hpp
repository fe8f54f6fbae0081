// Fits a project and its pictures: the result, the report, and the project with the result.
#pragma once

#include <string>
#include <vector>

#include "photo/calibration/fit.hpp"
#include "photo/calibration/lens_settings.hpp"
#include "photo/calibration/stored_prior.hpp"
#include "photo/pictures/stated_levels.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// How a project is sampled, fitted and stored.
struct SceneFitOptions {
    FitOptions fit;
    StoreOptions store;
    std::string points, reference;
    uint32_t sampling = LENSPROF_SAMPLING_BALANCED, falloff_curves = 0;  // 0: chosen by held-out error
    SamplingOptions pixels;
    StatedLevels levels;    // of the samples of linear pictures
    bool one_lens = false;  // all images are treated as one lens setting
    uint32_t free = 0;      // LENSPROF_FREE_... of every image; 0: according to the project, or all
};

// Input and result of a fit. Not copyable: the options of `input` point to other members.
struct SceneFit {
    explicit SceneFit(Events &of_caller) : events(of_caller) {}
    SceneFit(const SceneFit &) = delete;
    SceneFit &operator=(const SceneFit &) = delete;

    Events &events;
    BuildReport report;  // camera_kind is set by the caller
    LensSettings settings;
    FitInput input;
    Fitted best;
    std::string item;  // name of the input in a Failure
};

// Metadata of the pictures. If pairs are given, only what the profile key needs is read, because the pictures may be
// anything.
std::vector<PictureMetadata> picture_metadata(const SceneFitOptions &o, const Scene &scene);

// The stated levels, of the samples of all pictures. Failure (usage) if the pictures are not linear, are not of one
// sample type, or are not read.
lensprof_levels scene_levels(const SceneFitOptions &o, const Scene &scene,
                             const std::vector<PictureMetadata> &metadata);

// The key of the profile: EXIF of the reference picture, overridden by the command line. With one_lens, warns of
// pictures at other settings.
lensprof_profile_key profile_key(const SceneFitOptions &o, const Scene &scene,
                                 const std::vector<PictureMetadata> &metadata, Events &events);

struct DrawnPairs {
    std::vector<lensprof_pair> pairs;
    uint32_t channels = 3;  // or 1 if all pictures are grey
};

// The pairs that fit_project starts with; none for tracks of the method radiance.
DrawnPairs first_pairs(const SceneFitOptions &o, const Scene &scene, Events &progress);

// Samples the pictures, or takes given points, and fits. `prior` must outlive `state`.
void fit_scene(const SceneFitOptions &o, Scene &scene, const std::vector<PictureMetadata> &metadata,
               const EarlierProfile &prior, SceneFit &state, Events &events);

struct GainCurve {
    std::string label;
    std::vector<double> variances;  // per pair of pictures; see colour_differences. NaN is skipped
};

// Of a reconstruction, how much colours differ before, with exposures alone, and with the result; else empty.
std::vector<GainCurve> gain_curves(SceneFit &state);

// The text of the project with the result, to be written to `path`. A project stores five modes and one falloff; a
// result with more is refitted with these.
std::string result_text(const SceneFit &state, const Scene &scene, const std::string &path);

}  // namespace lensprof
