// Which pictures of a project were taken at one setting of the lens, and so share a falloff.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/fitting/profile_store.hpp"
#include "cli/fitting/project.hpp"

namespace lensprof {

struct LensSettings {
    std::vector<uint32_t> of_image;  // number of each image's
    std::vector<uint32_t> first;     // of each setting the image that states most of it
    bool are_several() const { return first.size() > 1; }
};

// By the project's links (Va..Vd) and by EXIF: lens, focal length, aperture and focus, as far as both pictures state
// them and `store` does not for all; upright and other frames are apart. With `one_lens` there is one setting. Failure
// (usage) for more than a fit takes.
LensSettings lens_settings(const Project &project, const std::vector<PictureMetadata> &metadata,
                           const StoreOptions &store, bool one_lens);

// What tells a setting from others: "50 mm, f/2.8", or where EXIF does not say the name of its first image.
std::string describe_setting(const lensprof_profile_key &key, const std::string &first_image);

}  // namespace lensprof
