#include "photo/pictures/stated_levels.hpp"

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

double share_of(const StatedLevel &level, const Picture &picture, const std::string &file) {
    if (level.is_share) return level.number;
    if (picture.traits.format == FileFormat::raw)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      file + ": the black level that a raw file states is subtracted already; give what it leaves as a "
                             "percentage, or nothing");
    if (picture.sample != LENSPROF_SAMPLE_U8 && picture.sample != LENSPROF_SAMPLE_U16) {
        if (level.number != 0.0)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          file + ": has float samples, from 0 to 1; give its levels as percentages, such as 6%");
        return 0.0;
    }
    const double full = full_scale_of(picture.sample);
    if (level.number > full)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      file + format(": its samples end at %.0f, below the stated level of %g", full, level.number));
    return level.number / full;
}

}  // namespace

lensprof_levels levels_of(const StatedLevels &stated, const Picture &picture, const std::string &file,
                          const lensprof_levels &others) {
    lensprof_levels levels = others;
    for (size_t c = 0; c < 3 && !stated.black.empty(); c++)
        levels.black[c] = share_of(stated.black[stated.black.size() == 3 ? c : 0], picture, file);
    if (stated.white) levels.white = share_of(*stated.white, picture, file);
    if (stated.white && levels.white == 0.0)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": its white level cannot be 0");
    if (lensprof_levels_validate(&levels) != LENSPROF_OK)
        throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": its black level is not below its white level; correct the "
                                                      "stated levels");
    return levels;
}

}  // namespace lensprof
