// Falloffs as maps of attenuations or gains, to and from profiles; what pictures, radical's maps and ALSC's tables
// share.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <lensprof/formats.h>

#include "falloff/map_fit.hpp"
#include "formats/text/text.hpp"

namespace lensprof {

// Values of a map that are the means of equal cells of a frame, interleaved; channel c of a pixel is value order[c].
// Attenuations, or gains where `gain`, to any scale; 0 = not known. Sets falloff and grid of the profile, whose
// covariance no longer holds, and returns the largest relative error. Throws SIZE, NOT_FINITE, ARGUMENT for values
// below 0, VIGNETTING.
struct MapValues {
    uint32_t columns, rows, channels;
    bool gain;
    uint32_t order[3];
};
double fit_values(const MapValues &form, const float *values, uint32_t width, uint32_t height,
                  lensprof_profile &profile);

// Attenuations of a valid profile at the middles of columns x rows cells of a frame, [channel][row][column], for 3
// channels, or 1: their mean. The largest of all is 1.
std::vector<double> attenuations_of(const lensprof_profile &profile, uint32_t width, uint32_t height, uint32_t columns,
                                    uint32_t rows, uint32_t channels);

// Throws SIZE for a side below 2 or over 65536, and the errors of lensprof_profile_validate.
void check_frame(uint32_t width, uint32_t height);
void check_profile(const lensprof_profile &profile);

// Changes the caller's profile, of any version, by `change`; not at all where that throws.
template <class Change>
void change_profile(lensprof_profile *profile, Change change) {
    const auto local = std::make_unique<lensprof_profile>();
    lensprof_profile_init(local.get());
    lensprof_status status = lensprof_profile_copy(local.get(), profile);
    if (status == LENSPROF_OK) {
        change(*local);
        status = lensprof_profile_copy(profile, local.get());
    }
    if (status != LENSPROF_OK)
        throw FormatFailure{status,
                            "the profile's struct_size is not set, or set by a newer lensprof; call "
                            "lensprof_profile_init first"};
}

}  // namespace lensprof
