// What every command that fits has in common: its options, the call, what is said about the result.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cli/fitting/profile_store.hpp"
#include "cli/fitting/stored_prior.hpp"
#include "cli/pictures/metadata.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"

namespace lensprof {

// How to fit.
struct FitOptions {
    uint32_t method = LENSPROF_METHOD_TRANSFER, modes = LENSPROF_MODES_AUTO, loss = LENSPROF_LOSS_ROBUST;
    uint32_t gamma_from = LENSPROF_GAMMA_AUTO;  // KNOWN: the project's response is held
    std::optional<uint32_t> camera_kind;        // empty: what the pictures say
    double prior_weight = 1.0, huber = 5.0;
    std::optional<double> exif_sigma;  // of all EXIF exposures, EV; 0: none is used; empty: by what EXIF says of them
    bool stored = true;                // what is stored of the lens and the camera is the prior, as far as it goes
    bool stored_is_asked = false;
    int64_t stored_id = 0;  // the profile that is the prior; 0: what a lookup finds
};

// What not every command has to offer.
struct FitChoices {
    bool debevec = false;        // the pictures' exposures may be known
    bool known_response = true;  // a project says a response that may be held
    bool stored_prior = false;   // a stored profile may be the prior
};
void declare_fit(Command &command, FitOptions &o, FitChoices choices = {});

// Whether stored knowledge is the prior of this fit: the method takes one, and priors have a weight.
bool takes_stored_prior(const FitOptions &o);

// Of --method, as provenances name it.
const char *method_name(uint32_t method);

// Failure (usage) for options that contradict each other.
void check_fit_options(const FitOptions &o);

// The library's options; everything shared is free, and the camera of any kind unless one is asked for.
lensprof_fit_options fit_options(const FitOptions &o);

// The kind of camera whose exponent the prior is of: the one asked for, else that of the pictures, whose `key` says the
// camera, and `metadata` of one of them what the files are.
CameraKind camera_kind_of(const FitOptions &o, lensprof_profile_key key, const PictureMetadata &metadata);

// What is fitted.
struct FitInput {
    lensprof_fit_options options{};
    lensprof_response fixed{};
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_pair> pairs;                // what is fitted where there are no observations
    std::vector<lensprof_observation> observations;  // tracks, for the method radiance
};

// A result and the exposures that belong to it.
struct Fitted {
    lensprof_fit_result result{};
    std::vector<lensprof_exposure> exposures;    // relative to the reference; ev is NaN of images that were left out
    std::vector<lensprof_fit_setting> settings;  // by the images' `setting`; `result` has that of the reference
    std::vector<uint32_t> setting_of;            // of each image
    std::vector<lensprof_fit_camera> cameras;    // by the images' `camera`; `result` has that of the reference
    std::vector<uint32_t> camera_of;             // of each image
    uint32_t reference = 0;                      // the one asked for, or where that was left out the result's own

    // Whether the pictures may be corrected with it; a profile to store has to be usable.
    bool corrects() const { return result.usable || result.evens; }

    // The curves of an image, and how many its camera's fit has.
    const lensprof_vignetting *falloff_of(uint32_t image) const {
        return settings.empty() ? result.vignetting : settings[setting_of[image]].vignetting;
    }
    uint32_t falloff_curves_of(uint32_t image) const {
        return is_of_own_camera(image) ? cameras[camera_of[image]].vignettings : result.vignettings;
    }
    const lensprof_response &response_of(uint32_t image) const {
        return is_of_own_camera(image) ? cameras[camera_of[image]].response : result.response;
    }

    // Whether the fit of an image is that of one camera of several.
    bool is_of_own_camera(uint32_t image) const { return !cameras.empty() && cameras[camera_of[image]].images; }
};

// The number of images that a result has exposures of.
size_t joined_images(const Fitted &fitted);

// Fits, with `progress` shown. `item` names the input in a Failure. `quality` may be NULL.
Fitted fit(FitInput &input, uint32_t reference, const std::string &item, Progress &progress,
           std::vector<lensprof_fit_image_quality> *quality);

// What is reported where no fit could be made: the same object, neutral, with the reason.
BuildReport no_fit(const std::vector<std::string> &names, const Failure &failure);

// Where a result goes.
struct Finish {
    std::string method;  // for the provenance
    std::string source;  // what it was made from
    bool json = false;
    bool evens_pictures = false;            // what evens them out is a success where nothing is to be stored
    OutputFiles *outputs = nullptr;         // committed once the profile is stored; or NULL
    const EarlierProfile *prior = nullptr;  // that the fit was given; or NULL
};

// What is said about a result that is not usable: of what, why, and that it was not stored where it could be.
std::string not_usable_text(const std::string &source, const Verdict &verdict, const StoreOptions &store);

// Stores a result that is usable or forced, prints it, says on standard error what is wrong with it. Returns the exit
// code.
int finish_fit(BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store, const Finish &finish,
               Streams &streams);

// Failure (usage) for a longest side that holds too few samples.
void check_max_side(uint32_t max_side);

// Seconds since `since`, which becomes now.
double lap(std::chrono::steady_clock::time_point &since);

}  // namespace lensprof
