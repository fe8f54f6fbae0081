// What the program says about a fit or a profile: JSON objects and tables for people.
#pragma once

#include <array>
#include <ostream>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <lensprof/lensprof.h>

#include "cli/report/falloff.hpp"
#include "cli/report/verdict.hpp"

namespace lensprof {

using Json = nlohmann::ordered_json;

// A kind of camera, and what says that it is one.
enum class KindFrom {
    none,
    option,
    pictures,
    reconstruction  // whose pictures do not say it: today's cameras
};
struct CameraKind {
    uint32_t kind = LENSPROF_CAMERA_ANY;  // lensprof_camera_kind
    KindFrom from = KindFrom::none;
};

// What was found of one of several lens settings.
struct SettingReport {
    std::string label;  // "50 mm, f/2.8"
    lensprof_profile_key key;
    uint32_t camera = 0;        // number of its camera
    bool is_reference = false;  // the setting of the reference, whose numbers the fit has too
    lensprof_fit_setting found{};
    Verdict verdict;
    int64_t profile_id = 0;     // 0 = not stored
    bool has_same_key = false;  // as a setting that is stored
    std::string no_key;         // why nothing says what camera and lens it is of; empty: something does
};

// What was found of one of several cameras.
struct CameraReport {
    std::string label;          // "Canon EOS 6D"
    bool is_reference = false;  // the camera of the reference, whose numbers the fit has too
    lensprof_fit_camera found{};
};

// How much the colours of a point differ between the pictures that see it: the mean over pairs of pictures and channels
// of half the squared difference, levels of 255 squared, of the 90 % of all pairs that differ least. All pictures are
// compared as at the mean exposure.
struct ColourVariance {
    double before = 0.0;          // the pictures as they are
    double exposures_only = 0.0;  // corrected by exposures and white balances that were fitted without the rest
    double result = 0.0;          // corrected by the result
    size_t pairs = 0;             // 0: not measured
};

// Everything `build` found out.
struct BuildReport {
    std::vector<std::string> names;
    std::vector<lensprof_exposure> exposures;  // relative to the reference
    std::vector<lensprof_fit_image_quality> quality;
    lensprof_fit_result fit{};
    Verdict verdict;                      // of it
    std::vector<SettingReport> settings;  // none where all images are at one lens setting
    std::vector<uint32_t> setting_of;     // of each image; empty: one setting
    std::vector<CameraReport> cameras;    // none where all images are of one camera
    std::vector<uint32_t> camera_of;      // of each image; empty: one camera
    std::vector<lensprof_link> links;     // between the images, as far as they were looked for
    uint32_t reference = 0;
    bool has_falloff = true;       // else it cancels in these pictures
    bool exposures_given = false;  // on the command line, and not by EXIF
    ColourVariance variance;       // of a reconstruction
    uint32_t looks = 1;            // 2: pairs were drawn again, by the light that the first fit found
    std::vector<std::pair<std::string, std::string>> left_out;  // pictures that are not among the images, and why
    double register_s = 0, load_s = 0, sample_s = 0;
    CameraKind camera_kind;          // whose exponent the prior on gamma is
    int64_t profile_id = 0;          // 0 = not stored
    int64_t prior_id = 0;            // of the profile that was the prior; 0 = none
    std::string no_prior;            // why none was, where one was asked for
    bool prior_is_composed = false;  // of several profiles, of which prior_id is the nearest
};

// The result with what was found of a lens setting, and of its camera, in the place of what it has of the reference's.
lensprof_fit_result result_of(const BuildReport &report, const SettingReport &setting);

// Whether a fit's result holds the profile that was its prior, or a part of it.
bool holds_prior(const lensprof_fit_result &fit);

// One line. Names of files need not be UTF-8, JSON must: bytes that are not become U+FFFD, and a member `x` that holds
// such a text is followed by `x_bytes`, its bytes in hexadecimal digits.
void print_json(const Json &json, std::ostream &out);

// The object that `build --json` prints; docs/json.md describes the schema.
Json build_json(const BuildReport &report);

// The falloff that stands for all channels where only one can be written.
const lensprof_vignetting &green_falloff(const lensprof_fit_result &fit);

void print_build(const BuildReport &report, std::ostream &out);

// What is true about a simulated sequence: exposures and (green) falloff.
struct TrueValues {
    std::vector<double> ev;
    lensprof_vignetting vignetting{};
};

// Reads the truth.json of `simulate`; Failure (unreadable) when it is something else or of another number of images.
TrueValues read_truth(const std::string &path, size_t images);

// Recovered next to true values, raw and with the exponent gamma aligned (what pictures alone cannot tell).
void print_comparison(const BuildReport &report, const TrueValues &truth, std::ostream &out);

// Parts of such objects, and of tables.
Json number_or_null(double value);  // null: not known, or no number
Json covariance_json(const double *values, uint32_t n);
Json vignetting_json(const lensprof_vignetting *vignettings, uint32_t count);
Json response_json(const lensprof_response *responses, uint32_t count);

void print_vignettings(const lensprof_profile &profile, std::ostream &out);
void print_response(const lensprof_response &r, std::ostream &out);

Json key_json(const lensprof_profile_key &key);
Json provenance_json(const lensprof_provenance &provenance);
// `id` is the number in the database; 0 = not of one.
Json profile_json(int64_t id, const lensprof_profile &profile);
void print_profile(int64_t id, const lensprof_profile &profile, std::ostream &out);

// Maker and model, the maker once: "Canon EOS 6D" of "Canon" and "Canon EOS 6D".
std::string camera_name(const std::string &maker, const std::string &model);

// Camera, lens, focal length, aperture, focus and processing in words; empty where not known.
using KeyParts = std::array<std::string, 6>;
KeyParts key_parts(const lensprof_profile_key &key);

// A part of a key, "aperture unknown" where it is not known.
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
