// From a measurement to a profile in the database: its key, its provenance, the database itself.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/base/library.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

// What a profile is stored for, and where.
struct StoreOptions {
    std::vector<std::string> dbs;  // databases in order: lookups search all of them
    std::string db;                // the first, where profiles are stored; empty = the default database
    std::string maker, camera, lens, unit, style;
    std::optional<uint32_t> processing;  // LENSPROF_PROCESSING_...
    double crop_factor = LENSPROF_UNKNOWN, focal = LENSPROF_UNKNOWN, aperture = LENSPROF_UNKNOWN,
           distance = LENSPROF_UNKNOWN, temperature = LENSPROF_UNKNOWN;
    bool no_store = false, force = false;
};

// Warns of names in the EXIF of `file` that are too long to be stored and are used.
void warn_of_truncation(const PictureMetadata &metadata, const StoreOptions &o, const std::string &file,
                        Events &events);

// The key of a profile: that of the picture's EXIF, overridden by `o`; the sensor size comes from the
// database's table of cameras, if listed, for a picture of that size. Failure (usage) with `file` if the camera is
// unknown and the profile is to be stored.
lensprof_profile_key override_key(lensprof_profile_key key, PictureSize size, const StoreOptions &o,
                                  const std::string &file);

// The same for a response, which belongs to the camera regardless of lens, aperture and focus. Warns of truncated
// names; Failure (usage) with `file` if the camera is unknown.
lensprof_profile_key camera_key(const StoreOptions &o, PictureMetadata metadata, const std::string &file,
                                Events &events);

// The response that pictures are stated to have: x^(1/gamma), that of a profile of the database (0: none), or linear.
std::vector<lensprof_response> given_response(const StoreOptions &o, std::optional<double> gamma, int64_t profile);

// Failure (store) before the work is done if the database cannot be used.
void check_store(const StoreOptions &o);

// Removes a new database that is still empty after a failure; one that somebody else has filled stays.
void remove_empty_store(const std::string &file);

// The canonical name of a file in provenances, however it was written.
std::string source_of(const std::string &file);

// The provenance of a profile made now.
struct Origin {
    std::string method, source;
    bool usable;           // else it was forced
    int64_t prior_id = 0;  // the profile used as its prior; 0 = none
};

// Completes the provenance with source_of(source) and the time, and stores the profile. Removes a new database if
// storing fails. Returns the profile id.
int64_t store_profile(const StoreOptions &o, lensprof_profile &profile, const Origin &origin);

}  // namespace lensprof
