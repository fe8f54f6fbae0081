// From a measurement to a profile in the database: its key, its provenance, the database itself.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/pictures/metadata.hpp"
#include "cli/program/library.hpp"
#include "cli/program/options.hpp"

namespace lensprof {

// The options of every command that stores a profile.
struct StoreOptions {
    std::vector<std::string> dbs;  // of --db, in their order: lookups ask all of them
    std::string db;                // the first: profiles are stored there; empty = the user's own
    std::string maker, camera, lens, unit, style;
    std::optional<uint32_t> processing;  // LENSPROF_PROCESSING_...
    double crop_factor = LENSPROF_UNKNOWN, focal = LENSPROF_UNKNOWN, aperture = LENSPROF_UNKNOWN,
           distance = LENSPROF_UNKNOWN;
    bool no_store = false, force = false;
};

void declare_store(Command &command, StoreOptions &o);

// The words of --processing.
Choices<std::optional<uint32_t>> processing_choices();

// Failure (usage) for options that contradict each other: --no-store leaves --db to a command that reads it, too, and
// --force to one that writes other files of the result.
void check_store_options(const StoreOptions &o, bool reads_db = false, bool writes_else = false);

// Warns of names in the EXIF of `file` that are too long to be stored, where they are.
void warn_of_cut(const PictureMetadata &metadata, const StoreOptions &o, const std::string &file, Streams &streams);

// The key of a profile: that of a picture's EXIF, then what the command line says; the sensor's size by the database's
// table of cameras, where it tells, for a picture of that size. Failure (usage) that names `file`
// when nothing says what camera it was and the profile is to be stored.
lensprof_profile_key override_key(lensprof_profile_key key, PictureSize size, const StoreOptions &o,
                                  const std::string &file);

// The same of a response, which belongs to the camera whatever lens, aperture and focus the pictures were taken with.
// Warns of what is cut; Failure (usage) that names `file` where nothing says which camera it was.
lensprof_profile_key camera_key(const StoreOptions &o, PictureMetadata metadata, const std::string &file,
                                Streams &streams);

// Failure (store) before the work is done when the database cannot be used.
void check_store(const StoreOptions &o);

// A database that was to be made for what failed is not left behind empty; one that somebody else has filled stays.
void remove_empty_store(const std::string &file);

// A file as provenances name it: one name, however it was written.
std::string source_of(const std::string &file);

// What a provenance says of a profile that was made now.
struct Origin {
    std::string method, source;
    bool usable;       // else stored by --force
    int64_t held = 0;  // the profile that is in it; 0 = none
};

// Completes the provenance, with source_of(source) and the time, and stores the profile. A new database
// that could not take it is not left behind. Returns its number.
int64_t store_profile(const StoreOptions &o, lensprof_profile &profile, const Origin &origin);

}  // namespace lensprof
