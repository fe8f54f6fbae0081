// What is calibrated: pictures, their cameras and links, and where they are compared.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <lensprof/lensprof.h>

#include "photo/base/library.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/registration/registration.hpp"

namespace lensprof {

struct Scene {
    std::string path;  // of the file it was read from, or a name of its pictures for messages

    // Per image. lensprof_pto_image states what is known of one without its pixels: camera, crop, exposure, falloff,
    // links, free parameters.
    std::vector<lensprof_pto_image> images;
    std::vector<std::string> names;                               // as written in the file
    std::vector<std::string> files;                               // path of each picture
    std::vector<PictureMetadata> metadata;                        // empty: not read yet
    std::vector<std::shared_ptr<const lensprof_profile>> models;  // response and falloff, shared by images with the
                                                                  // same; empty: none are known
    uint32_t reference = 0;                                       // image whose exposure is fixed
    lensprof_levels levels{};                                     // of the samples of all pictures; all 0: none

    // The Hugin project it was read from, which has masks and what a scene does not hold; NULL for other scenes.
    Pto document;

    // For scenes that were not read from a project: images with the same number are linked in angle of view and
    // distortion, and points show how the cameras were found.
    std::vector<uint32_t> lenses;
    std::vector<ControlPoint> control_points;

    std::vector<lensprof_scene_link> links;  // empty for a project
    std::vector<lensprof_match> matches;     // of links that the cameras do not explain, or of all links (`by_matches`)
    std::vector<uint32_t> match_points;      // of a reconstruction: the scene point per match,
    std::map<std::pair<uint32_t, uint32_t>, double> view_distances;  // and how far apart views are, relative to the
                                                                     // usual distance
    bool by_matches = false, is_reconstruction = false;
    std::vector<std::string> sources;   // files of the reconstruction, which outputs must not replace
    std::vector<lensprof_pair> pairs;   // pairs that came with the scene instead of pictures,
    std::vector<uint32_t> pair_points;  // and the scene point per pair
    std::vector<std::pair<std::string, std::string>> left_out;  // pictures that are not part of it, with reasons
    size_t unlinked = 0;                                        // pictures given that overlap no other
    double register_s = 0.0;                                    // time of finding overlaps
};

// An image of a scene without a project.
struct NewImage {
    lensprof_camera camera;
    uint32_t camera_id;  // images with the same number are linked in response and falloff,
    uint32_t lens;       // and in angle of view and distortion
};

// Sets images, models and lenses: no falloff, equal exposures, all parameters free, except the exposure of image 0.
void set_images(const std::vector<NewImage> &images, Scene &scene);

// A camera of which the size alone is known and used; its angle of view is any that is valid.
lensprof_camera camera_of_size(uint32_t width, uint32_t height);

// The frame of an image's falloff, in pixels of its file: the picture or, for one of several crops, the crop
// (lensprof_pto_image.of_crop).
struct FalloffFrame {
    double left, top;
    uint32_t width, height;
};
FalloffFrame falloff_frame_of(const lensprof_pto_image &image);

// Moves a place from pixels of the picture to those of the falloff's frame (`sign` 1), or back (-1).
void move_place(const Scene &scene, uint32_t image, double sign, double xy[2]);
void move_places(const Scene &scene, double sign, std::vector<lensprof_pair> &pairs);

// Whether an image is a crop of its file; Failure (usage) with the name of what does not support that.
bool has_crops(const Scene &scene);
void refuse_crops(const Scene &scene, const std::string &option);

// The image that a user gives by number or file name.
uint32_t image_of_word(const Scene &scene, const std::string &word);

// Finds images of a scene by file identity, regardless of the name.
class ImagesByFile {
public:
    explicit ImagesByFile(const Scene &scene);

    std::optional<uint32_t> find(const std::string &file) const;

    // Failure (usage) for a file that is not an image of the scene; the text advises to omit `option`. The first
    // image, if there are several in crops of the file.
    uint32_t at(const std::string &file, const std::string &option) const;

private:
    const Scene *scene_;
    std::map<std::string, uint32_t> images_;  // by file_identity
};

// The images of the fit: sizes, links, free parameters, and exposures relative to the reference.
std::vector<lensprof_fit_image> fit_images(const Scene &scene);

}  // namespace lensprof
