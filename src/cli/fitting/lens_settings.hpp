// Which pictures of a project were taken by one camera, and so share a response, and which at one setting of its lens,
// and so share a falloff.
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
    std::vector<uint32_t> camera_of_image, first_of_camera;
    bool are_several() const { return first.size() > 1; }
    bool are_of_several_cameras() const { return first_of_camera.size() > 1; }
};

// By the project's links and by EXIF, as far as both pictures state it and `store` does not for all. Cameras: by
// Ra..Re, maker and model. Settings of each: by Va..Vd, lens, focal length, aperture and focus; upright and other
// frames are apart. With `one_lens` there is one of both. Failure (usage) for more settings than a fit takes.
LensSettings lens_settings(const Project &project, const std::vector<PictureMetadata> &metadata,
                           const StoreOptions &store, bool one_lens);

// Takes all images as of one camera.
void join_cameras(LensSettings &settings);

// The camera's name, or where EXIF does not say it that of its first image.
std::string describe_camera(const lensprof_profile_key &key, const std::string &first_image);

// What tells a setting from others: "50 mm, f/2.8", or where EXIF does not say the name of its first image.
std::string describe_setting(const lensprof_profile_key &key, const std::string &first_image);

}  // namespace lensprof
