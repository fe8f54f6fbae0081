// The result of a calibration, and its JSON.
#pragma once

#include <array>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <lensprof/lensprof.h>

#include "photo/report/falloff.hpp"
#include "photo/report/verdict.hpp"

namespace lensprof {

using Json = nlohmann::ordered_json;

// A kind of camera, and its source.
enum class KindFrom {
    none,
    option,
    pictures,
    reconstruction  // whose pictures do not state it: current cameras
};
struct CameraKind {
    uint32_t kind = LENSPROF_CAMERA_ANY;  // lensprof_camera_kind
    KindFrom from = KindFrom::none;
};

// The result for one of several lens settings.
struct SettingReport {
    std::string label;  // "50 mm, f/2.8"
    lensprof_profile_key key;
    uint32_t camera = 0;        // index of its camera
    bool is_reference = false;  // the setting of the reference, whose values are also in the fit
    uint32_t number = 0;        // of the setting in the fit
    lensprof_fit_result found{};
    Verdict verdict;
    int64_t profile_id = 0;        // 0 = not stored
    bool has_same_key = false;     // the key of the stored setting
    std::string no_key;            // why camera and lens are unknown; empty: they are known
    bool is_turn_unknown = false;  // its frames are higher than wide, and may have been rotated either way
};

// The result for one of several cameras.
struct CameraReport {
    std::string label;          // "Canon EOS 6D"
    bool is_reference = false;  // the camera of the reference, whose values are also in the fit
    lensprof_fit_camera found{};
    lensprof_fit_result fit{};  // its own
};

// How much the colours of a point differ between pictures: the mean over pairs of pictures and channels of half the
// squared difference, levels of 255 squared, of the 90 % of pairs that differ least. All pictures are compared at the
// mean exposure.
struct ColourVariance {
    double before = 0.0;          // the pictures as they are
    double exposures_only = 0.0;  // corrected with exposures and white balances fitted without the rest
    double result = 0.0;          // corrected with the result
    size_t pairs = 0;             // 0: not measured
};

// What a fit uses of the exposures in EXIF.
struct ExifUse {
    size_t images = 0;                                   // with a known exposure
    bool cancels_iso = false, cancels_aperture = false;  // no picture states it, and it cancels
    std::string note;                                    // what EXIF states in part; empty: all or nothing
};

// The report of `build`.
struct BuildReport {
    std::vector<std::string> names;
    std::vector<lensprof_exposure> exposures;  // relative to the reference
    std::vector<lensprof_fit_image_quality> quality;
    lensprof_fit_result fit{};                 // of the setting of the reference
    std::shared_ptr<const lensprof_fit> held;  // what it is from; NULL without a fit
    Verdict verdict;                           // of it
    std::vector<SettingReport> settings;       // empty if all images have one lens setting
    std::vector<uint32_t> setting_of;          // per image; empty: one setting
    std::vector<CameraReport> cameras;         // empty if all images are from one camera
    std::vector<uint32_t> camera_of;           // per image; empty: one camera
    std::vector<lensprof_link> links;          // between the images, if they were determined
    uint32_t reference = 0;
    bool is_turn_unknown = false;  // if all images have one lens setting: as in SettingReport
    bool has_falloff = true;       // else the falloff cancels in these pictures
    bool exposures_given = false;  // on the command line, not by EXIF
    ExifUse exif;
    ColourVariance variance;       // of a reconstruction
    uint32_t sampling_rounds = 1;  // 2: pairs were drawn again, by the irradiance of the first fit
    std::vector<std::pair<std::string, std::string>> left_out;  // pictures left out, and why
    double register_s = 0, load_s = 0, sample_s = 0;
    CameraKind camera_kind;          // kind of camera of the prior on gamma
    lensprof_levels levels{};        // of the samples of the pictures, as stated; all 0: none
    int64_t profile_id = 0;          // 0 = not stored
    int64_t prior_id = 0;            // id of the profile used as the prior; 0 = none
    std::string no_prior;            // why there was no prior, if one was requested
    bool prior_is_composed = false;  // composed of several profiles, of which prior_id is the nearest
};

// Whether the result of a fit uses its prior profile, or a part of it.
bool holds_prior(const lensprof_fit_result &fit);

// Whether the fit left out an image, which then has no exposure.
bool is_left_out(const BuildReport &report, size_t image);

// `schema` of the JSON of all commands. 2: findings instead of one reason.
constexpr int json_schema = 2;

// File names need not be UTF-8, but JSON must be: invalid bytes become U+FFFD, and a member `x` with such a text is
// followed by `x_bytes`, its bytes in hexadecimal digits.
Json kept_in_utf8(const Json &json);

// Prints that as one line.
void print_json(const Json &json, std::ostream &out);

// The object that `build --json` prints; docs/json.md describes the schema.
Json build_json(const BuildReport &report);

// The falloff that represents all channels if only one can be written.
const lensprof_vignetting &green_falloff(const lensprof_fit_result &fit);

// Parts of such objects.
Json number_or_null(double value);  // null: unknown or not a number
Json covariance_json(const double *values, uint32_t n);
Json vignetting_json(const lensprof_vignetting *vignettings, uint32_t count);
Json gain_grid_json(const lensprof_gain_grid &grid);  // attenuation as [channel][row][column]; null without a grid
Json response_json(const lensprof_response *responses, uint32_t count);
Json samples_json(const lensprof_response *responses, uint32_t count);  // curve samples for plotting, for any kind
Json key_json(const lensprof_profile_key &key);

Json provenance_json(const lensprof_provenance &provenance);
// `id` is the id in the database; 0 = none.
Json profile_json(int64_t id, const lensprof_profile &profile);

// Maker and model without repeating the maker: "Canon EOS 6D" for "Canon" and "Canon EOS 6D".
std::string camera_name(const std::string &maker, const std::string &model);

// Camera, lens, focal length, aperture, focus and processing as text; empty if unknown.
using KeyParts = std::array<std::string, 6>;
KeyParts key_parts(const lensprof_profile_key &key);

// A part of a key, or "aperture unknown" if it is unknown.
std::string spell_part(const KeyParts &parts, size_t part);

// "Canon EOS 5D, EF 50mm, 50 mm, f/1.8, focus unknown, jpeg".
std::string describe_key(const lensprof_profile_key &key);

// raw, jpeg, corrected.
const char *processing_name(uint32_t processing);

// prior, exif, known, none.
const char *gamma_name(uint32_t from);

// any, film, digital.
const char *camera_kind_name(uint32_t kind);

}  // namespace lensprof
