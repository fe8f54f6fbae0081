// A structure-from-motion reconstruction: the positions at which several pictures show the same point of the scene.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

// The image coordinate system of the file.
enum class ImageCoordinates {
    stored_px,          // px of the stored picture, regardless of EXIF orientation
    stored_centred_px,  // the same, relative to the centre of the picture
    upright_centred     // of the picture after EXIF orientation, relative to its centre, divided by its longer side
};

struct ReconstructionCamera {
    uint32_t width = 0, height = 0;  // px, along the axes of the image coordinates; 0: not stated
};

struct ReconstructionImage {
    std::string name;     // as in the file: usually a path relative to the folder of pictures
    uint32_t camera = 0;  // index
    bool has_centre = false;
    std::array<double, 3> centre{};  // position of the camera in the scene
};

// An observation of a scene point.
struct TrackObservation {
    uint32_t point = 0, image = 0;  // indices
    uint32_t feature = 0;           // its index in the image, if the file numbers features
    float xy[2] = {};               // see ImageCoordinates; in px the centre of the first pixel is (0, 0)
    float shape[2][2] = {};  // maps the unit circle to the feature, px; a multiple of the identity if only the scale is
                             // known; all 0: unknown
    std::array<uint8_t, 3> colour{};  // red, green, blue, if has_colours
};

struct Reconstruction {
    std::string kind;    // "COLMAP database"
    std::string path;    // path of the file, or of the folder of the files
    std::string folder;  // folder of the pictures, if stated; may be from another machine
    ImageCoordinates coordinates = ImageCoordinates::stored_px;
    bool has_colours = false;    // all observations have colours
    bool has_rotations = false;  // shapes include the orientation of features

    std::vector<ReconstructionCamera> cameras;
    std::vector<ReconstructionImage> images;
    std::vector<TrackObservation> observations;  // sorted by point, then image; per point at most one per image, and at
                                                 // least two
    std::vector<std::array<double, 3>> points;   // positions in the scene; empty: unknown

    uint32_t point_count() const { return observations.empty() ? 0 : observations.back().point + 1; }
};

// Sorts observations by point and image, drops points that an image observes twice or fewer than two images observe,
// and renumbers the others from 0. Failure with the path: (unreadable) for images without a unique name and for
// positions that are not numbers, (not_usable) if nothing is left.
void clean_tracks(Reconstruction &reconstruction);

// Renumbers images in the order of their names, which often follows the path of the camera.
void sort_images(Reconstruction &reconstruction);

// Keeps the images with these indices, in ascending order, and the points that two of them observe.
void keep_images(const std::vector<uint32_t> &kept, Reconstruction &reconstruction);

bool is_finite(const std::array<double, 3> &vector);

// Maximum number of images and of observations of a reconstruction.
constexpr uint32_t max_images = 1u << 20;
constexpr int64_t max_image_side = 1 << 20;  // px
constexpr uint64_t max_observations = uint64_t(1) << 28;

}  // namespace lensprof
