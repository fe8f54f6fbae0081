// From a measurement to a profile in the database: its key, its provenance, the database itself.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/program/options.hpp"
#include "photo/base/library.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

// The options of every command that stores a profile.
struct StoreOptions {
    std::vector<std::string> dbs;  // of --db, in order: lookups search all of them
    std::string db;                // the first, where profiles are stored; empty = the default database
    std::string maker, camera, lens, unit, style;
    std::optional<uint32_t> processing;  // LENSPROF_PROCESSING_...
    double crop_factor = LENSPROF_UNKNOWN, focal = LENSPROF_UNKNOWN, aperture = LENSPROF_UNKNOWN,
           distance = LENSPROF_UNKNOWN;
    bool no_store = false, force = false;
};

void declare_store(Command &command, StoreOptions &o);

// The choices of --key processing.
Choices<std::optional<uint32_t>> processing_choices();

// Failure (usage) for conflicting options. `reads_db`: --db is allowed with --no-store; `writes_other_files`: --force
// is allowed with --no-store, because the command writes other files of the result.
void check_store_options(const StoreOptions &o, bool reads_db = false, bool writes_other_files = false);

// Warns of names in the EXIF of `file` that are too long to be stored and are used.
void warn_of_truncation(const PictureMetadata &metadata, const StoreOptions &o, const std::string &file,
                        Streams &streams);

// The key of a profile: that of the picture's EXIF, overridden by the command line; the sensor size comes from the
// database's table of cameras, if listed, for a picture of that size. Failure (usage) with `file` if the camera is
// unknown and the profile is to be stored.
lensprof_profile_key override_key(lensprof_profile_key key, PictureSize size, const StoreOptions &o,
                                  const std::string &file);

// The same for a response, which belongs to the camera regardless of lens, aperture and focus. Warns of truncated
// names; Failure (usage) with `file` if the camera is unknown.
lensprof_profile_key camera_key(const StoreOptions &o, PictureMetadata metadata, const std::string &file,
                                Streams &streams);

// Failure (store) before the work is done if the database cannot be used.
void check_store(const StoreOptions &o);

// Removes a new database that is still empty after a failure; one that somebody else has filled stays.
void remove_empty_store(const std::string &file);

// The canonical name of a file in provenances, however it was written.
std::string source_of(const std::string &file);

// The provenance of a profile made now.
struct Origin {
    std::string method, source;
    bool usable;           // else stored with --force
    int64_t prior_id = 0;  // the profile used as its prior; 0 = none
};

// Completes the provenance with source_of(source) and the time, and stores the profile. Removes a new database if
// storing fails. Returns the profile id.
int64_t store_profile(const StoreOptions &o, lensprof_profile &profile, const Origin &origin);

// Failure (usage) for the file of --report if it is not an .html file, would overwrite an input or the database, or
// cannot be written; nothing for an empty name.
void check_report(const std::string &report, const std::vector<std::string> &inputs, const StoreOptions &o);

}  // namespace lensprof
