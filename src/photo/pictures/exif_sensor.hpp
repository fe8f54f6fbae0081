// The size of the sensor from EXIF, and whether the picture shows all of its frame.
#pragma once

#include "photo/pictures/exif_fields.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

// Fills size.shown_diagonal and the crop factor of the key, from the focal length of the key and the size in pixels.
void read_sensor(const Exif &exif, bool is_raw, PictureMetadata &metadata);

// Fills black_level and white_level.
void read_levels(const Exif &exif, PictureMetadata &metadata);

}  // namespace lensprof
