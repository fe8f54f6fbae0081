// What structure from motion found in pictures: the places where several of them show the same point of the scene.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace lensprof {

// How the file that was read gives image coordinates.
enum class ImageCoordinates {
    stored_px,          // px of the picture as it is stored, whatever EXIF's orientation says
    stored_centred_px,  // the same, from the middle of the picture
    upright_centred     // of the picture as EXIF's orientation turns it, from its middle, over its longer side
};

struct ReconstructionCamera {
    uint32_t width = 0, height = 0;  // px, in the axes of the image coordinates; 0: the file does not say
};

struct ReconstructionImage {
    std::string name;     // as the file has it: a path, relative to the folder of the pictures as a rule
    uint32_t camera = 0;  // index
    bool has_centre = false;
    std::array<double, 3> centre{};  // of the camera, in the scene
};

// One sight of a scene point.
struct TrackObservation {
    uint32_t point = 0, image = 0;  // indices
    uint32_t feature = 0;           // its number in the image, where the file numbers them
    float xy[2] = {};               // see ImageCoordinates; in px the middle of the first pixel is (0, 0)
    float shape[2][2] = {};  // from the unit circle to the feature, px; a multiple of the identity where only its
                             // scale is known; all 0: not known
    std::array<uint8_t, 3> colour{};  // red, green, blue, where has_colours
};

struct Reconstruction {
    std::string kind;    // "COLMAP database"
    std::string path;    // of the file, or the folder of the files
    std::string folder;  // of the pictures, where the file says it; may be of another machine
    ImageCoordinates coordinates = ImageCoordinates::stored_px;
    bool has_colours = false;    // of every observation
    bool has_rotations = false;  // shapes say how features are turned

    std::vector<ReconstructionCamera> cameras;
    std::vector<ReconstructionImage> images;
    std::vector<TrackObservation> observations;  // by point, then image; at most one of a point in an image, at least
                                                 // two of a point
    std::vector<std::array<double, 3>> points;   // positions in the scene; empty: not known

    uint32_t point_count() const { return observations.empty() ? 0 : observations.back().point + 1; }
};

// Sorts observations by point and image, leaves points out that an image sees twice, or that fewer than two see, and
// numbers the others from 0 on. Failure that names the path: (unreadable) for images without a name of their own and
// for places that are no numbers, (not_usable) where nothing is left.
void settle_tracks(Reconstruction &reconstruction);

// Numbers images in the order of their names, which is often that of the camera's way.
void sort_images(Reconstruction &reconstruction);

// Leaves the images of these numbers, which ascend, and the points that two of them see.
void keep_images(const std::vector<uint32_t> &kept, Reconstruction &reconstruction);

bool is_finite(const std::array<double, 3> &vector);

// Most images, and most observations, of one reconstruction.
constexpr uint32_t most_images = 1u << 20;
constexpr int64_t most_image_side = 1 << 20;  // px
constexpr uint64_t most_observations = uint64_t(1) << 28;

}  // namespace lensprof
