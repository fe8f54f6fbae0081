// The fit of the library, and its result per image.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/base/library.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

// How to fit.
struct FitOptions {
    uint32_t method = LENSPROF_METHOD_TRANSFER, modes = LENSPROF_MODES_AUTO, loss = LENSPROF_LOSS_ROBUST;
    uint32_t gamma_from = LENSPROF_GAMMA_AUTO;  // KNOWN: the project's response is fixed
    std::optional<uint32_t> camera_kind;        // empty: according to the pictures
    double prior_weight = 1.0, huber = 5.0;
    std::optional<double> exif_sigma;  // of all EXIF exposures, EV; 0: EXIF is not used; empty: chosen by EXIF
    bool stored = true;                // use what is stored for lens and camera as the prior
    bool stored_is_requested = false;
    int64_t stored_id = 0;  // profile to use as the prior; 0: that of a lookup
};

// Which pixels are compared.
struct SamplingOptions {
    uint32_t seed = 1, pairs = 0, max_side = 800;
};
// Whether stored profiles are the prior of this fit: the method must support it and the prior weight be above 0.
bool uses_stored_prior(const FitOptions &o);

// The name of a method, as in provenances.
const char *method_name(uint32_t method);

// The library's callback: shows the progress of a fit, and ends it if the user interrupts.
int on_fit_progress(double done, void *progress);

// The library's options, with all shared parameters free and any kind of camera unless one is given.
lensprof_fit_options fit_options(const FitOptions &o);

// The kind of camera that the prior on the exponent describes: the requested one, else that of the pictures, according
// to the camera in `key` and the file type in `metadata`.
CameraKind camera_kind_of(const FitOptions &o, lensprof_profile_key key, const PictureMetadata &metadata);

// The input of a fit.
struct FitInput {
    lensprof_fit_options options{};
    lensprof_response fixed{};
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_pair> pairs;                // used if there are no observations
    std::vector<lensprof_observation> observations;  // tracks, for the method radiance
    std::vector<uint32_t> points;                    // of a reconstruction, per pair: the scene point that it shows,
    std::vector<double> view_distances;              // and how far its views are apart

    // Per image, the orientation that turns the picture into the frame of its setting (pictures/orientation.hpp);
    // empty: no picture is rotated. Places of pairs and tracks are those of the pictures as stored.
    std::vector<uint16_t> turn_of;
};

// A result and the exposures that belong to it.
struct Fitted {
    std::shared_ptr<const lensprof_fit> held;   // NULL: not of a fit
    lensprof_fit_result result{};               // of the setting of the reference
    Verdict verdict;                            // of it
    std::vector<lensprof_exposure> exposures;   // relative to the reference; ev is NaN for images left out
    std::vector<lensprof_fit_result> settings;  // indexed by the images' `setting`
    std::vector<uint32_t> setting_of;           // per image
    std::vector<uint16_t> turn_of;              // of the input
    std::vector<lensprof_fit_camera> cameras;   // indexed by the images' `camera`
    std::vector<uint32_t> camera_of;            // per image
    uint32_t reference = 0;                     // the requested one, or the result's own if that was left out

    // Whether the pictures can be corrected with it; storing a profile requires a usable result.
    bool corrects() const { return result.usable || result.equalizes; }

    // The falloff curves of an image, with the centre in the picture as stored, and their number in its camera's fit.
    std::array<lensprof_vignetting, 3> falloff_of(uint32_t image) const;
    uint32_t falloff_curves_of(uint32_t image) const { return result_of(image).vignettings; }
    const lensprof_response &response_of(uint32_t image) const { return result_of(image).response; }

    // The result of an image's setting, or that of the reference if the setting is empty.
    const lensprof_fit_result &result_of(uint32_t image) const {
        return !settings.empty() && settings[setting_of[image]].images ? settings[setting_of[image]] : result;
    }
};

// The number of images with an exposure in the result.
size_t joined_images(const Fitted &fitted);
size_t joined_images(const std::vector<lensprof_exposure> &exposures);

// Fits and shows `progress`. `item` is the name of the input in a Failure. `quality` may be NULL.
Fitted fit(FitInput &input, uint32_t reference, const std::string &item, Events &progress,
           std::vector<lensprof_fit_image_quality> *quality);

// The report if no fit was possible: the same object with neutral values and the reason.
BuildReport no_fit(const std::vector<std::string> &names, const Failure &failure);

}  // namespace lensprof
