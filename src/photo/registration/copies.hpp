// Copies of one photograph: rotated, mirrored, resized or compressed again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "photo/registration/features.hpp"

namespace lensprof {

struct CopyCandidate {
    const Features *picture;
    std::string captured;  // moment of the exposure with its fraction of a second; empty = unknown
    std::optional<double> exposure_time_s;
    bool is_raw = false;
    bool overlaps = false;  // it is known to overlap a picture that shows something else
};

struct PictureCopy {
    uint32_t copy, original;
    std::string how;  // "", ", rotated", ", mirrored, resized"
    bool is_mirrored = false;
};

// The pictures that are copies of others, in ascending order. The original is the copy that overlaps other pictures,
// then the largest, then one in colour, then one that states its moment, then the first. Compares the detail of reduced
// versions in all eight orientations. Frames from a tripod show the same detail: upright copies need the same moment in
// both, or a moment in one only, or, without moments, equal pixels, another size or grey next to colour.
std::vector<PictureCopy> find_copies(const std::vector<CopyCandidate> &pictures);

}  // namespace lensprof
