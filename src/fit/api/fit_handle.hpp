// A fit that the caller holds: one block of memory, the caller's or the library's.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fit/api/fit_call.hpp"

struct lensprof_fit {
    uint32_t mark;  // lensprof::kHeld until the fit is released
    uint32_t is_own_memory;
    uint32_t image_count, setting_count, camera_count;
    uint32_t reference_setting, method, channels;
    uint32_t prior_images, prior_pairs;  // of the profile that the result contains, if any
    lensprof_fit_result *results;        // per setting
    lensprof_finding *findings;          // lensprof::kFindingsMax per setting
    lensprof_fit_camera *cameras;
    lensprof_fit_image_quality *quality;
    lensprof_fit_image *images;
    lensprof_exposure *exposures;
};

namespace lensprof {

constexpr uint32_t kHeld = 0x4c50464du;

// Bytes of the fit of these images.
size_t fit_bytes(const std::vector<lensprof_fit_image> &images);

// Makes the fit of a finished call in memory[fit_bytes].
lensprof_fit *make_fit(const FitCall &call, const lensprof_exposure *exposures, void *memory, bool is_own);

}  // namespace lensprof
