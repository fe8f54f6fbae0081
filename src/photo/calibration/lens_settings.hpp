// Determines which pictures of a project share a camera (and its response) and which share a lens setting (and its
// falloff).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photo/calibration/profile_store.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// Whether lens, focal length, aperture and focus of two keys are the same, as far as both state them and within the
// rounding of EXIF.
bool is_same_setting(const lensprof_profile_key &a, const lensprof_profile_key &b);

struct LensSettings {
    std::vector<uint32_t> of_image;  // setting and camera per image
    std::vector<uint32_t> first;     // per setting, the image with the most complete data
    std::vector<uint32_t> camera_of_image, first_of_camera;

    // Per image, the orientation that turns the picture into the frame of the others of its setting
    // (pictures/orientation.hpp). Centres are in that frame; unknown: some pictures may have been rotated either way.
    std::vector<uint16_t> turn_of_image;
    bool are_centres_unknown = false;
    std::vector<bool> is_turn_unknown;  // per setting: it has pictures that may have been rotated either way

    bool has_rotated_images() const;
    bool has_several_settings() const { return first.size() > 1; }
    bool has_several_cameras() const { return first_of_camera.size() > 1; }
};

// According to the project's links and to EXIF, as far as both pictures state it and `store` does not override it.
// Cameras: by Ra..Re, maker and model. Settings per camera: by Va..Vd, lens, focal length, aperture and focus;
// portrait and landscape frames are one setting. With `one_lens` there is one camera and one setting. Failure (usage)
// for more settings than a fit takes.
LensSettings lens_settings(const Scene &scene, const std::vector<PictureMetadata> &metadata, const StoreOptions &store,
                           bool one_lens);

// Images whose pictures have the same falloff: of one setting, and rotated in the same way. Numbered in the order of
// their images; `first` is that of the setting, if possible.
struct FalloffGroups {
    std::vector<uint32_t> of_image, first;
};
FalloffGroups falloff_groups(const LensSettings &settings);

// Treats all images as from one camera.
void join_cameras(LensSettings &settings);

// The name of the camera, or that of its first image if EXIF does not name it.
std::string describe_camera(const lensprof_profile_key &key, const std::string &first_image);

// The label of a setting, such as "50 mm, f/2.8", or the name of its first image if EXIF does not state it.
std::string describe_setting(const lensprof_profile_key &key, const std::string &first_image);

}  // namespace lensprof
