// What EXIF says about the exposure: time, aperture, ISO, and whether they were set by hand.
#pragma once

#include <exiv2/exiv2.hpp>

#include "cli/pictures/metadata.hpp"

namespace lensprof {

// Fills exposure_time_s, f_number, iso, exif_ev and is_manual.
void read_exposure(const Exiv2::ExifData &exif, PictureMetadata &metadata);

// Writes what is known of them; the aperture is the key's.
void write_exposure(const PictureMetadata &metadata, Exiv2::ExifData &exif);

}  // namespace lensprof
