// What only the maker notes of cameras state, by Exiv2. Without that library (maker_notes_unavailable.cpp) nothing is
// known of them.
//
// Threads: any function may run in several threads concurrently.
#pragma once

#include <optional>
#include <string>

#include <lensprof/profile.h>

#include "photo/pictures/picture_blocks.hpp"

namespace lensprof {

struct FocalRange {
    double shortest, longest;  // mm
};

struct MakerNotes {
    std::string lens_model;                // Canon's text
    std::string lens_of_number;            // as lens_of_number() returns it
    std::optional<FocalRange> lens_range;  // stated with the number
    std::string style;                     // the name of the picture style
    std::string serial_number;             // of the camera
    double distance_m = LENSPROF_UNKNOWN;  // of the focus; INFINITY
    std::optional<double> iso;
    std::string correction;  // of the falloff by the camera, "Sony: vignetting correction"; empty = none stated
};

// Nothing if the picture has no maker note, or it is damaged.
MakerNotes read_maker_notes(const std::string &path, const PictureBlocks &blocks);

// The lens with this number of a maker: its name, a list of names or, if it is unknown or several share it, the number.
// `range`, if known, distinguishes lenses of one number.
std::string lens_of_number(const std::string &maker, const std::string &model, const std::string &number,
                           const std::optional<FocalRange> &range);

// The blocks of a file in a format of its own, as some raw files are. Throws exceptions if the format is not known;
// empty without Exiv2.
std::optional<PictureBlocks> read_other_blocks(const std::string &path);

}  // namespace lensprof
