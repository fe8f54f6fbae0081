// Camera, lens and exposure from the metadata of a picture file (EXIF, XMP, maker notes).
//
// Threads: any function may run in several threads concurrently.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lensprof/profile.h>

#include "photo/pictures/correction_mark.hpp"

namespace lensprof {

struct PictureSize {
    uint32_t width = 0, height = 0;
    double shown_diagonal = 1.0;  // of the picture, as a share of the frame's: below 1 if EXIF proves that it was
                                  // cropped; NaN: it was cropped, but perhaps resized, too

    // The crop factor of the picture if that of the whole frame is known.
    double of_part(double crop_factor) const {
        return crop_factor == LENSPROF_UNKNOWN || std::isnan(shown_diagonal) ? LENSPROF_UNKNOWN
                                                                             : crop_factor / shown_diagonal;
    }
};

struct PictureMetadata {
    // Fields that the file does not state are unknown. Texts have no surrounding blanks, are valid UTF-8 and truncated
    // to the field size. Processing is JPEG (a rendered picture of any file format), but RAW for float TIFF, which by
    // convention holds values proportional to light, for camera raw files and FITS, and if the colour profile has a
    // linear tone curve; CORRECTED if corrected_by is not empty.
    lensprof_profile_key key;

    // Unknown whether it is rendered: a 16 bit TIFF without colour profile, as raw converters write linear ones.
    bool may_be_linear = false;

    std::string ambiguous_lens;  // what does not identify the lens, see lens_name.hpp

    std::string software;  // that wrote the file: the camera's, or a program

    PictureSize size;           // pixels, as stored; 0 = unknown
    bool is_of_camera = false;  // a JPEG or HEIC as cameras write them, not from a raw converter

    std::optional<CorrectionMark> mark;  // mark of lensprof, if any

    // Who corrected the falloff, "in camera (Sony: vignetting correction)"; empty = unknown or nobody.
    std::string corrected_by;
    uint32_t processing_before = LENSPROF_PROCESSING_JPEG;  // processing of the key if it had not been corrected

    std::vector<std::string>
        cut;  // parts of the key whose texts are too long for their fields: maker, camera, lens, unit, style

    std::optional<double> exposure_time_s;
    std::optional<double> iso;
    std::optional<double> f_number;       // aperture of the key
    std::optional<double> open_f_number;  // widest of the lens at its focal length

    // lensprof_settings_ev of the three: larger means a brighter rendering of the same scene. Set only if all are
    // known.
    std::optional<double> exif_ev;

    // Samples without light (red, green, blue) and at saturation, as the tags BlackLevel and WhiteLevel of DNG state
    // them; not of raw files, whose levels are applied when they are read.
    std::optional<std::array<double, 3>> black_level;
    std::optional<double> white_level;

    std::string captured;  // EXIF's DateTimeOriginal with its fraction of a second; empty if either is missing

    std::optional<double> taken_s;  // DateTimeOriginal, s since 1970 of a clock without time zone

    uint16_t orientation = 1;  // EXIF orientation, 1..8

    bool is_manual = false;  // time, aperture and ISO were set manually according to EXIF's ExposureProgram or
                             // ExposureMode
};

// Sets all fields to unknown.
PictureMetadata unknown_metadata();

// Reads the available metadata; a file without EXIF, or a BigTIFF (see below), is not an error. Failure (unreadable) if
// the file cannot be opened, is not a picture or is damaged.
PictureMetadata read_metadata(const std::string &path);

// The XMP packet of the picture; empty if missing. Throws like read_metadata.
std::string read_xmp_packet(const std::string &path);

// Copies EXIF, maker notes, IPTC, XMP and comment of one picture to another (JPEG, PNG or TIFF) and replaces that file,
// completely or not at all. Skipped is what would no longer be true: the thumbnail, sizes of the old file, and in TIFF
// all tags that describe pixel storage; also tags of parts that a copy leaves out (other_parts.hpp). Pixels, colour
// profile and resolution of the target stay. Adds `mark`, if given. Returns false for a BigTIFF, whose
// metadata are not supported.
bool copy_metadata(const std::string &source, const std::string &target, const CorrectionMark *mark = nullptr);

// Writes the known fields as EXIF into a picture file and replaces only these (aperture from the key). Returns false
// for a BigTIFF. Throws Failure.
bool write_metadata(const std::string &path, const PictureMetadata &metadata);

// A mark as a standalone XMP packet, for files whose metadata are not edited; and the reverse.
std::string packet_of_mark(const CorrectionMark &mark);
std::optional<CorrectionMark> mark_of_packet(const std::string &packet);

}  // namespace lensprof
