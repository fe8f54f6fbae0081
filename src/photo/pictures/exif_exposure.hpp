// The exposure in EXIF: time, aperture, ISO, and whether they were set manually.
#pragma once

#include <exiv2/exiv2.hpp>

#include "photo/pictures/metadata.hpp"

namespace lensprof {

// Fills exposure_time_s, f_number, open_f_number, iso, exif_ev, captured and is_manual.
void read_exposure(const Exiv2::ExifData &exif, PictureMetadata &metadata);

// Writes the known values; the aperture is taken from the key.
void write_exposure(const PictureMetadata &metadata, Exiv2::ExifData &exif);

}  // namespace lensprof
