// An unblended mosaic of a project's pictures before and after correction, to judge a fit by eye.
#pragma once

#include <string>
#include <vector>

#include "photo/calibration/fit.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// A picture as it is and as the result corrects it, to the mean exposure; 8 bit, reduced.
struct CorrectedCopy {
    Picture before, after;
    lensprof_camera camera{};
    uint32_t image = 0;
};

// The images that a result has exposures of.
std::vector<uint32_t> images_with_exposure(const Fitted &fitted);

// Copies of these images, with a longer side of at least `max_side` pixels.
std::vector<CorrectedCopy> corrected_copies(const Scene &scene, const Fitted &fitted,
                                            const std::vector<uint32_t> &images, uint32_t max_side, Events &progress);

// Both of one size, 8 bit RGB, the longer side 1600 pixels.
struct Mosaic {
    Picture before, after;
};
constexpr uint32_t tile_side = 500;  // px to which its pictures are reduced
Mosaic mosaic_of(const std::vector<CorrectedCopy> &copies);

// Failure (usage) for a name without a picture extension.
void check_preview(const std::string &path);

// Writes the mosaic before and, below it, after correction, of the images with an exposure in the result: each point is
// taken from the picture whose centre is nearest. Rectilinear if all cameras look forward or the camera moved, else
// equirectangular.
void write_preview(const std::string &path, const Scene &scene, const Fitted &fitted, Events &progress);

// The same, of a mosaic.
void write_mosaic(const std::string &path, const Mosaic &mosaic);

// The mosaics in a picture of write_mosaic.
Mosaic read_preview(const std::string &path);

}  // namespace lensprof
