// The pictures of a scene, reduced for sampling.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// A picture reduced for sampling, with its mask; none if nothing is excluded.
struct SamplePicture {
    Picture picture;
    std::vector<uint8_t> mask;
};

// Maximum memory for the reduced pictures of a scene with their masks.
constexpr uint64_t scene_max_bytes = uint64_t(8) << 30;

// Bytes of the pixels of a picture that read_sample_picture returns.
uint64_t bytes_in_memory(const Scene &scene, const Picture &header);

// Checks the headers before the first picture is loaded. Failure (unreadable) if a picture is missing, unreadable or of
// another size than the scene states, or if all pictures, or as many as are `in_memory` together, reduced to
// `max_side`, need more memory than scene_max_bytes or than the machine has.
void check_pictures(const Scene &scene, uint32_t max_side, uint32_t in_memory = UINT32_MAX);

// Reads a picture, reduced to a longer side of at least `max_side` pixels, with the scene's levels removed. Failure
// with the file name for a size that contradicts the scene, an unreadable file, float samples that are not finite, and
// samples below the black level.
SamplePicture read_sample_picture(const Scene &scene, uint32_t image, uint32_t max_side);

// The same for all pictures, several in parallel.
std::vector<SamplePicture> read_pictures(const Scene &scene, uint32_t max_side, Events &progress);

// Failure (unreadable) with the first sample that is not finite, in rows of a picture starting at first_row.
void check_finite(const lensprof_image &rows, uint32_t first_row, uint32_t reduction, const std::string &file);

// The places of an image, at a size of its picture, at which it may be compared: 1, else 0. Empty: all.
std::vector<uint8_t> mask_of(const Scene &scene, uint32_t image, uint32_t width, uint32_t height);

// 3, or 1 if all pictures are grey.
uint32_t channel_count(const std::vector<SamplePicture> &pictures);

}  // namespace lensprof
