// Makes a scene of pictures.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/registration/registration.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// Whether a word of the command line names a picture or folder, not a project.
bool is_picture_argument(const std::string &word);

// Lists every picture once, regardless of its names; copies of a picture are left out. If a folder is the only word,
// reports use paths relative to it.
struct Photographs {
    std::string label;  // number of all pictures
    std::vector<std::string> files, names;
    std::vector<std::pair<std::string, std::string>> left_out;  // files and reasons
};
Photographs list_photographs(const std::vector<std::string> &words, const std::vector<NamedPicture> &pictures);

// The named pictures and those of named folders. Outputs of calibrate are left out. What is left out is listed on
// standard error. Failure (usage) for raw files among others, and if fewer than two pictures remain.
Photographs find_photographs(const std::vector<std::string> &words, Events &events);

// Finds the overlaps and returns the scene of the largest group; pictures left out are listed on standard error. With
// `one_lens` all pictures are treated as from one camera. All parameters are free. Failure (not_usable) if no two
// pictures overlap.
Scene scene_of_pictures(const Photographs &list, bool one_lens, Events &events);

// Why a picture is not part of a scene that it overlaps, directly or through others.
inline std::string no_overlap_within_camera() {
    return "no two pictures of its camera, size or processing overlap" + advice("one_lens");
}
std::string no_overlap_of(const std::string &file);
bool is_of_even_light(const std::string &file);  // false if it cannot be read any more
inline std::string linked_by_other_camera() {
    return "only pictures of another camera, size or processing connect it to the others" + advice("one_lens");
}

// Why pictures of a stationary camera are not fitted, and what to use them for.
inline std::string still_camera_reason() {
    return ": the camera did not move, so the pictures cannot show the falloff" + advice("still_camera");
}

// Note for a scene whose cameras do not fit.
constexpr const char *poor_cameras_note =
    "no camera model fits the pictures well, because of parallax, distortion or moving objects. The pictures are "
    "compared only at matched points; a project or preview of them does not show the scene";

// Sets what registration has found of the pictures of a group.
void set_found(const FoundScene &found, Scene &scene);

}  // namespace lensprof
