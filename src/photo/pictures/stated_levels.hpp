// Black and white level of pictures, as people state them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// A sample without light, or at saturation: a value of the file (256), or a share of full scale (0.06).
struct StatedLevel {
    double number = 0.0;
    bool is_share = false;
};

struct StatedLevels {
    std::vector<StatedLevel> black;    // one, or red, green and blue; empty: not stated
    std::optional<StatedLevel> white;  // empty: full scale

    bool any() const { return !black.empty() || white.has_value(); }
};

// The levels of a picture's samples. Failure, which names the file, for values if its samples are not those of the
// file (raw) or not integers, and for a black level that is not below white.
// What is not stated is that of `others`.
lensprof_levels levels_of(const StatedLevels &stated, const Picture &picture, const std::string &file,
                          const lensprof_levels &others = {});

}  // namespace lensprof
