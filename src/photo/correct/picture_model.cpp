#include "photo/correct/picture_model.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "photo/base/databases.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/correct/falloff_doubt.hpp"
#include "photo/correct/lookup_report.hpp"
#include "photo/pictures/orientation.hpp"
#include "photo/pictures/rotated_profile.hpp"
#include "photo/pictures/sensor.hpp"

namespace lensprof {

PictureModels::PictureModels(const ModelOptions &options, bool by_default) : options_(options) {
    const auto files =
        options.profile && options.dbs.empty() ? std::vector<std::string>{store_path("")} : databases_of(options.dbs);
    const bool has_database = by_default && (!options.dbs.empty() || path_exists(files[0]));
    if (options.profile || options.from_db || has_database) databases_ = Databases(files);
}

// EXIF, overridden by the command line. The sensor size is that of the table of cameras, if listed.
lensprof_profile_key PictureModels::key_of(const PictureMetadata &metadata) const {
    lensprof_profile_key key = metadata.key;
    if (options_.force_falloff || options_.puts_in) key.processing = metadata.processing_before;
    options_.key.put_into(key);
    const double given = options_.lookup.crop_factor;
    const double crop = given != LENSPROF_UNKNOWN ? given : crop_factor_in_tables(databases_, key, metadata.size);
    if (crop != LENSPROF_UNKNOWN) key.crop_factor = crop;
    return key;
}

[[noreturn]] static void fail_corrected(const std::string &file, const PictureMetadata &metadata) {
    throw NotThisOne(LENSPROF_ERROR_NOT_FOUND,
                     file + ": its falloff was already corrected, " + metadata.corrected_by + advice("force_falloff"),
                     true);
}

static bool is_corrected(const lensprof_profile_key &key, const PictureMetadata &metadata) {
    return key.processing == LENSPROF_PROCESSING_CORRECTED && !metadata.corrected_by.empty();
}

// A profile of another processing has another response, or only the remaining falloff.
void PictureModels::take_profile(const PictureMetadata &metadata, Correction &job, lensprof_profile &profile) const {
    lensprof_error error{};
    check(lensprof_store_get(databases_.store(0), options_.profile, &profile, &error), databases_.file(0), &error);
    job.profile_id = options_.profile;
    const lensprof_profile_key key = key_of(metadata);
    const uint32_t processing = key.processing, profile_processing = profile.key.processing;
    if (processing == profile_processing) return;
    if (is_corrected(key, metadata)) fail_corrected(job.source, metadata);
    if (options_.response && processing != LENSPROF_PROCESSING_CORRECTED
        && profile_processing != LENSPROF_PROCESSING_CORRECTED)
        return;
    const std::string processing_text = processing_name(processing), profile_text = processing_name(profile_processing);
    throw NotThisOne(LENSPROF_ERROR_ARGUMENT, job.source + ": is treated as " + processing_text + ", but profile "
                                                  + std::to_string(options_.profile) + " is for " + profile_text
                                                  + " pictures; give " + option_name("processing") + "=" + profile_text
                                                  + " if this picture is " + profile_text + ", or its "
                                                  + option_name("response"));
}

// What is missing, in EXIF or in the databases: camera, lens or setting.
static std::string missing_part(const lensprof_profile_key &key, const PictureMetadata &metadata,
                                const lensprof_lookup &lookup) {
    const bool is_of_exif = std::strcmp(key.lens, metadata.key.lens) == 0;
    if (is_of_exif && !metadata.ambiguous_lens.empty())
        return "EXIF does not identify the lens: " + metadata.ambiguous_lens;
    if (!*key.lens) return *key.camera_model ? "EXIF does not name the lens" : "EXIF names neither camera nor lens";
    switch (lookup.reason_code[0]) {
    case LENSPROF_REASON_LOOKUP_NO_LENS: return "the lens is missing";
    case LENSPROF_REASON_LOOKUP_NO_CAMERA: return "the camera is missing";
    case LENSPROF_REASON_LOOKUP_FOCAL_MISSING:
    case LENSPROF_REASON_LOOKUP_APERTURE_MISSING: return "EXIF does not state the setting";
    case LENSPROF_REASON_LOOKUP_NO_FOCAL:
    case LENSPROF_REASON_LOOKUP_NO_APERTURE:
    case LENSPROF_REASON_LOOKUP_FOCAL_BEYOND:
    case LENSPROF_REASON_LOOKUP_APERTURE_BEYOND:
    case LENSPROF_REASON_LOOKUP_TOO_FAR: return "the setting is missing";
    default: return "";
    }
}

// Suggests the options for data missing from the picture. If none is missing, the lens may be stored under another
// name, or EXIF states a setting that the lens does not have.
static std::string missing_options(const lensprof_profile_key &key, const lensprof_lookup &lookup) {
    std::string options;
    const auto add = [&](bool is_missing, const char *what, const char *option) {
        if (is_missing)
            options += (options.empty() ? "give " : ", ") + std::string(what) + " with " + option_name(option);
    };
    add(!*key.lens, "the lens", "lens");
    add(key.focal_mm == LENSPROF_UNKNOWN, "the focal length", "focal");
    add(key.aperture == LENSPROF_UNKNOWN, "the aperture", "aperture");
    if (!options.empty()) return options;
    switch (lookup.reason_code[0]) {
    case LENSPROF_REASON_LOOKUP_FOCAL_BEYOND:
        return "check the lens and the focal length, which " + option_name("lens") + " and " + option_name("focal")
               + " replace";
    case LENSPROF_REASON_LOOKUP_APERTURE_BEYOND:
        return "check the lens and the aperture, which " + option_name("lens") + " and " + option_name("aperture")
               + " replace";
    default: return "give the lens name used in the database with " + option_name("lens");
    }
}

void PictureModels::look_up(const PictureMetadata &metadata, Correction &job, lensprof_profile &profile) const {
    const lensprof_profile_key key = key_of(metadata);
    const lensprof_lookup_options options = options_.lookup.options();
    lensprof_lookup lookup;
    lensprof_lookup_init(&lookup);
    const lensprof_status status = databases_.look_up(key, options, profile, lookup);
    if (status == LENSPROF_ERROR_NOT_FOUND && is_corrected(key, metadata)) fail_corrected(job.source, metadata);
    const std::string missing = missing_part(key, metadata, lookup);
    const bool is_all = !*key.lens && lookup.reason_code[0] == LENSPROF_REASON_LOOKUP_NO_CAMERA;  // no lens, no profile
    if (status == LENSPROF_ERROR_NOT_FOUND)
        throw NotThisOne(LENSPROF_ERROR_NOT_FOUND,
                         job.source + ": no profile for " + describe_key(key) + " in " + databases_.names() + " ("
                             + missing + (missing.empty() || is_all ? "" : "; ") + (is_all ? "" : lookup.reason)
                             + describe_nearest(nearest_names(databases_, key, lookup)) + "); make one"
                             + advice("make_profile") + ", " + missing_options(key, lookup)
                             + ", or give a profile with " + option_name("profile"));
    if (lookup.exact && lookup.falloff_store == 0)
        job.profile_id = lookup.id[0];
    else
        job.lookup = std::make_shared<Found>(options_.response ? with_response_given({lookup, databases_.files()})
                                                               : Found{lookup, databases_.files()});
}

// Of a picture that shows a part of its frame.
static std::string crop_note(const PictureSize &size) {
    if (size.shown_diagonal == 1.0) return "";
    if (std::isnan(size.shown_diagonal))
        return "EXIF states another shape: it was cropped, perhaps resized, so the size of its part of the sensor is "
               "unknown; give "
               + option_name("crop_factor");
    return format(
        "EXIF states a larger frame: it was cropped to %.0f %% of the diagonal; the falloff is scaled to "
        "that, around the middle of the picture (%s changes the scale)",
        100.0 * size.shown_diagonal, option_name("crop_factor").c_str());
}

// A prediction that is worse than no correction for many lenses is used only if asked for.
static void check_error(const lensprof_lookup &lookup, const lensprof_profile_key &key, const std::string &file) {
    constexpr double largest_sigma = 0.1;  // of M in the corner
    if (lookup.sigma == LENSPROF_UNKNOWN || lookup.sigma <= largest_sigma) return;
    std::string step =
        "make a profile of this setting" + advice("make_profile") + ", or use " + option_name("doubtful");
    if (std::hypot(lookup.falloff_sigma, lookup.distance_sigma) <= largest_sigma && lookup.sensor_sigma > largest_sigma)
        step = std::string(*key.camera_model ? "the size of the camera's sensor is unknown" : "EXIF names no camera")
               + "; give " + option_name("crop_factor") + ", or the camera with " + option_name("camera") + " and "
               + option_name("maker");
    throw NotThisOne(LENSPROF_ERROR_NOT_FOUND, file + ": the falloff is too uncertain, " + describe_error(lookup)
                                                   + format(", above %.1f; ", largest_sigma) + step);
}

// A falloff that no lens has is applied only if asked for by the number of the profile or by --key doubtful=yes.
void PictureModels::check_possible(const PictureMetadata &metadata, Correction &job,
                                   const lensprof_profile &profile) const {
    const std::string doubt = impossible_falloff(profile, metadata.size.width, metadata.size.height);
    if (doubt.empty() || options_.lookup.doubtful) return;
    if (!options_.profile)
        throw NotThisOne(LENSPROF_ERROR_NOT_FOUND, job.source + ": " + doubt + ", as with no lens; make a profile"
                                                       + advice("make_profile") + ", or use "
                                                       + option_name("doubtful"));
    job.note = doubt + ", as with no lens";
}

void PictureModels::choose(const PictureMetadata &metadata, Correction &job) const {
    auto profile = std::shared_ptr<lensprof_profile>(new_profile());
    options_.profile ? take_profile(metadata, job, *profile) : look_up(metadata, job, *profile);
    if (job.lookup && !options_.lookup.doubtful) check_error(job.lookup->lookup, key_of(metadata), job.source);
    check_possible(metadata, job, *profile);
    turn_profile(sensor_orientation(metadata.size.width, metadata.size.height, metadata.orientation), *profile);
    if (job.note.empty() && !options_.profile && options_.lookup.crop_factor == LENSPROF_UNKNOWN)
        job.note = crop_note(metadata.size);
    if (options_.response) {
        profile->responses = 1;
        profile->response[0] = *options_.response;
        profile->covariance_size = 0;  // of a missing response
    }
    if (metadata.may_be_linear && !options_.response && !options_.key.processing)
        job.note = "this 16 bit TIFF is not marked as linear; it is treated as rendered (give "
                   + option_name("processing") + " to state it)";
    if (options_.force_falloff && !options_.puts_in && !metadata.corrected_by.empty())
        job.note = "its falloff was already corrected, " + metadata.corrected_by + ", and is corrected again";
    job.model = profile;
    job.model_name = describe_key(profile->key);
}

}  // namespace lensprof
