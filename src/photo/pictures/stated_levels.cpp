#include "photo/pictures/stated_levels.hpp"

#include "photo/base/events.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

[[noreturn]] void fail(const std::string &file, const std::string &text) {
    throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": " + text);
}

bool has_codes(const Picture &picture) {
    return picture.sample == LENSPROF_SAMPLE_U8 || picture.sample == LENSPROF_SAMPLE_U16;
}

std::string named(const std::string &option) { return option.empty() ? "the stated level" : option_name(option); }

// Whether a level is a share without its %. A white level of counts is above 1.
bool is_in_shares(double value, const LevelScale &scale, bool is_white) {
    return is_white && !scale.is_known ? value <= 1.0 : scale.has_counts() && value > 0.0 && value < 1.0;
}

std::string unit_advice(double value, const Picture &picture, const LevelScale &scale, bool is_white) {
    if (!scale.is_known)
        return format(
            "its float samples are counts, which reach %.6g; give a count such as %s instead of a level of %g",
            scale.reach, is_white ? "4095" : "200", value);
    const std::string kind = has_codes(picture) ? "has integer samples"
                                                : format("has float counts, of which %g are full scale", scale.reach);
    const std::string forms = format("give a level as a value such as %.6g, or as a percentage, such as %g%%",
                                     has_codes(picture) ? 256.0 : value * scale.full_scale, 100.0 * value);
    return kind + format(", and %g is less than one of them: ", value) + forms;
}

// A value of the file as a share of full scale.
double share_of_value(double value, const Picture &picture, const std::string &file, const std::string &option,
                      const LevelScale &scale, bool is_white) {
    if (picture.traits.format == FileFormat::raw)
        fail(file,
             "the black level that a raw file states is subtracted already; give what it leaves as a percentage, "
             "or nothing");
    // In 0.2, the option of the black level was the limit of ignored grey values.
    if (is_in_shares(value, scale, is_white))
        fail(file,
             unit_advice(value, picture, scale, is_white)
                 + (option == "black" && has_codes(picture)
                        ? "; to ignore dark grey values, use " + option_name("ignore_below") + format("=%g", value)
                        : std::string()));
    if (scale.is_known && value > scale.full_scale)
        fail(file,
             has_codes(picture) || scale.full_scale != 1.0
                 ? format("its samples end at %.0f, below the stated level of %g; correct %s", scale.full_scale, value,
                          named(option).c_str())
                 : format("has float samples, from 0 to 1, below the stated level of %g; correct %s, or state the "
                          "count at saturation, if they are counts",
                          value, named(option).c_str()));
    return value / scale.full_scale;
}

double level_on(const LevelScale &scale, const StatedLevel &level, const Picture &picture, const std::string &file,
                const std::string &option, bool is_white) {
    if (!level.is_share) return share_of_value(level.number, picture, file, option, scale, is_white);
    if (!scale.is_known && level.number != 0.0)
        fail(file, "its float samples are counts; state its levels as counts, such as 200");
    return level.number;
}

// Of levels in counts, relative to white; without a white level, none is too high.
bool are_ordered(lensprof_levels levels, const LevelScale &scale) {
    if (!scale.is_known) {
        if (!(levels.white > 0.0)) return true;
        for (double &black : levels.black) black /= levels.white;
        levels.white = 1.0;
    }
    return lensprof_levels_validate(&levels) == LENSPROF_OK;
}

}  // namespace

lensprof_levels levels_of(const StatedLevels &stated, const Picture &picture, const std::string &file,
                          const lensprof_levels &others, const LevelScale &scale) {
    lensprof_levels levels = others;
    for (size_t c = 0; c < 3 && !stated.black.empty(); c++)
        levels.black[c] =
            level_on(scale, stated.black[stated.black.size() == 3 ? c : 0], picture, file, stated.black_option, false);
    if (stated.white) levels.white = level_on(scale, *stated.white, picture, file, stated.white_option, true);
    if (!are_ordered(levels, scale))
        fail(file, "its black level is not below its white level; correct the stated levels");
    return levels;
}

}  // namespace lensprof
