// The exposure in EXIF: time, aperture, ISO, and whether they were set manually.
#pragma once

#include "photo/pictures/exif_fields.hpp"
#include "photo/pictures/metadata.hpp"

namespace lensprof {

// Fills exposure_time_s, f_number, open_f_number, iso, exif_ev, captured, taken_s and is_manual. `maker_iso`: in the
// maker note, used if EXIF has no number.
void read_exposure(const Exif &exif, std::optional<double> maker_iso, PictureMetadata &metadata);

// Writes the known values; the aperture is taken from the key.
void write_exposure(const PictureMetadata &metadata, Exif &exif);

}  // namespace lensprof
