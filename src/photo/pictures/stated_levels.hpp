// Black and white level of pictures, as people state them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// A sample without light, or at saturation: a value of the file (256), or a share of full scale (0.06). Of float
// samples of 0 to 1, both are the same.
struct StatedLevel {
    double number = 0.0;
    bool is_share = false;
};

struct StatedLevels {
    std::vector<StatedLevel> black;          // one, or red, green and blue; empty: not stated
    std::optional<StatedLevel> white;        // empty: full scale
    std::string black_option, white_option;  // that state them, for option_name(); empty: unknown

    bool any() const { return !black.empty() || white.has_value(); }
};

// What samples are counted in.
struct LevelScale {
    double full_scale = 1.0;    // value of the file that is 1 in levels
    bool is_known = true;       // false: float counts that are kept, as nobody stated the one at saturation
    double reach = full_scale;  // of the samples

    // Whether a level below 1 is a share without its %: it would be less than 2 % of the range. Smaller numbers are
    // units of their own, such as 4.5.
    bool has_counts() const { return reach >= 64.0; }

    static LevelScale of(const Picture &picture) { return {full_scale_of(picture.sample), true}; }
};

// The levels of samples on a scale: all checks of what is stated. Failure, which names the file, for values if the
// samples are not those of the file (raw), for values beyond full scale or less than one count, for shares if full
// scale is unknown, and for a black level that is not below white. What is not stated is that of `others`.
lensprof_levels levels_of(const StatedLevels &stated, const Picture &picture, const std::string &file,
                          const lensprof_levels &others, const LevelScale &scale);
inline lensprof_levels levels_of(const StatedLevels &stated, const Picture &picture, const std::string &file,
                                 const lensprof_levels &others = {}) {
    return levels_of(stated, picture, file, others, LevelScale::of(picture));
}

}  // namespace lensprof
