// The model that corrects each picture: a profile given by id, or one looked up by EXIF.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "photo/base/databases.hpp"
#include "photo/calibration/key_filter.hpp"
#include "photo/correct/correction.hpp"
#include "photo/correct/lookup_options.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

// Why one picture cannot be corrected; other pictures are still corrected.
struct NotThisOne : Failure {
    NotThisOne(lensprof_status of, const std::string &text, bool already = false)
        : Failure(of, text), corrected_already(already) {}

    bool corrected_already;
};

struct ModelOptions {
    std::vector<std::string> dbs;
    int64_t profile = 0;
    bool from_db = false, force_falloff = false;
    bool puts_in = false;  // add the falloff, also to corrected pictures
    KeyFilter key;         // overrides EXIF
    LookupOptions lookup;
    std::optional<lensprof_response> response;  // overrides the profile
};

// The databases of the models.
class PictureModels {
public:
    // Failure (usage) for conflicting options. Without a profile, existing databases are used if
    // `by_default`.
    PictureModels(const ModelOptions &options, bool by_default);

    bool are_used() const { return !databases_.is_empty(); }

    // Sets the model of a picture, its name and how it was found. NotThisOne if no model fits.
    void choose(const PictureMetadata &metadata, Correction &job) const;

private:
    lensprof_profile_key key_of(const PictureMetadata &metadata) const;
    void take_profile(const PictureMetadata &metadata, Correction &job, lensprof_profile &profile) const;
    void check_possible(const PictureMetadata &metadata, Correction &job, const lensprof_profile &profile) const;
    void look_up(const PictureMetadata &metadata, Correction &job, lensprof_profile &profile) const;

    const ModelOptions &options_;
    Databases databases_;
};

}  // namespace lensprof
