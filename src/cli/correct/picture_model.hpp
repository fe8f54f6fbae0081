// What each picture is corrected with: a profile by its number, or one that is looked up by EXIF.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/correct/correction.hpp"
#include "cli/pictures/metadata.hpp"
#include "cli/profiles/key_filter.hpp"
#include "cli/profiles/lookup_options.hpp"
#include "cli/program/databases.hpp"

namespace lensprof {

// Why one picture is not corrected, which is no reason not to correct the others.
struct NotThisOne : Failure {
    NotThisOne(ExitCode exit_code, const std::string &text, bool already = false)
        : Failure(exit_code, text), corrected_already(already) {}

    bool corrected_already;
};

struct ModelOptions {
    std::vector<std::string> dbs;
    int64_t profile = 0;
    bool from_db = false, force_falloff = false;
    bool puts_in = false;  // the falloff is to be put in: into a corrected picture, too
    KeyFilter key;         // in place of EXIF's
    LookupOptions lookup;
    std::optional<lensprof_response> response;  // in place of the profile's

    void add_options(Command &command);
};

// The databases that models come from.
class PictureModels {
public:
    // Failure (usage) for options that contradict each other. Without --profile and --from-db the databases are used
    // where there is one and `by_default`.
    PictureModels(const ModelOptions &options, bool by_default);

    bool are_used() const { return !databases_.is_empty(); }

    // Sets the model of a picture, what it is called and how it was found. NotThisOne where there is none that fits.
    void choose(const PictureMetadata &metadata, Correction &job) const;

private:
    lensprof_profile_key key_of(const PictureMetadata &metadata) const;
    void take_profile(const PictureMetadata &metadata, Correction &job, lensprof_profile &profile) const;
    void look_up(const PictureMetadata &metadata, Correction &job, lensprof_profile &profile) const;

    const ModelOptions &options_;
    Databases databases_;
};

}  // namespace lensprof
