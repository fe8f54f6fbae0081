// What a picture file says about camera, lens and exposure (EXIF, maker notes), through Exiv2.
//
// Threads: any function may run in several threads at once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/profile.h>

#include "cli/pictures/correction_mark.hpp"

namespace lensprof {

struct PictureSize {
    uint32_t width = 0, height = 0;
};

struct PictureMetadata {
    // Unknown what the file does not say. Texts without surrounding blanks, in valid UTF-8, cut to the fields' sizes.
    // Processing is JPEG (a rendered picture, whatever the file's format), but RAW for float TIFF, which by custom
    // holds values proportional to light, for camera raw files, and where the colour profile has a linear tone curve;
    // CORRECTED where corrected_by is not empty.
    lensprof_profile_key key;

    // Nothing says whether it is rendered: a 16 bit TIFF without colour profile, as raw converters write linear ones.
    bool may_be_linear = false;

    PictureSize size;           // pixels, as they are stored; 0 = not known
    bool is_of_camera = false;  // the file: a JPEG or HEIC, as cameras write them

    std::optional<CorrectionMark> mark;  // what lensprof did to the picture, if it did

    // Who took the falloff out before, "in camera (Sony: vignetting correction)"; empty = nothing says so.
    std::string corrected_by;
    uint32_t processing_before = LENSPROF_PROCESSING_JPEG;  // the key's, had it not been corrected

    std::vector<std::string>
        cut;  // options in place of what was longer than its field: --maker, --camera, --lens, --unit, --style

    std::optional<double> exposure_time_s;
    std::optional<double> iso;
    std::optional<double> f_number;  // the key's aperture

    // log2(exposure_time_s * iso / 100 / f_number^2), EV: larger means a brighter rendering of the same scene. Only
    // when all three are known.
    std::optional<double> exif_ev;

    uint16_t orientation = 1;  // EXIF's, 1..8

    bool is_manual = false;  // time, aperture and ISO were set by hand: EXIF's ExposureProgram or ExposureMode says so
};

// All unknown.
PictureMetadata unknown_metadata();

// Reads what there is; a file without EXIF is no error (nor is a BigTIFF, see below). Throws Failure (unreadable)
// when the file cannot be opened, is no picture or is damaged.
PictureMetadata read_metadata(const std::string &path);

// The XMP packet as it is in the picture; empty where there is none. Throws as read_metadata.
std::string read_xmp_packet(const std::string &path);

// Copies EXIF, maker notes, IPTC, XMP and comment of one picture to another (JPEG, PNG or TIFF) and replaces that
// file, complete or not at all. Left out is what would no longer be true: the thumbnail, sizes of the old file, and in
// TIFF all tags that describe how pixels are stored. Pixels, colour profile and resolution of the target stay.
// With `mark`, the target gets it. False when nothing could be done because one of the files is a BigTIFF, which Exiv2
// does not know. Throws Failure.
bool copy_metadata(const std::string &source, const std::string &target, const CorrectionMark *mark = nullptr);

// Writes what is known as EXIF into a picture file, replacing these fields only (aperture from the key). False when
// nothing could be done because the file is a BigTIFF. Throws Failure.
bool write_metadata(const std::string &path, const PictureMetadata &metadata);

// A mark as an XMP packet by itself, for files that Exiv2 does not know, and back.
std::string packet_of_mark(const CorrectionMark &mark);
std::optional<CorrectionMark> mark_of_packet(const std::string &packet);

}  // namespace lensprof
