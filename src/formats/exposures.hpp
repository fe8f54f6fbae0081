// What reader and writer of exposures.json share: its contents, and its limits.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include <lensprof/exposures.h>

#include "core/sized.h"
#include "formats/json.hpp"

namespace lensprof {

constexpr const char *kExposuresFile = "lensprof exposures";
constexpr int64_t kExposuresSchema = 1;
constexpr int64_t kExposuresSide = 1 << 20;  // px
constexpr size_t kLevels = 256;              // of an 8 bit picture

// Bytes of the structs' first versions.
constexpr size_t kFirstInfo = LP_END_OF(lensprof_exposures_info, software);
constexpr size_t kFirstCamera = LP_END_OF(lensprof_exposures_camera, response);
constexpr size_t kFirstLens = LP_END_OF(lensprof_exposures_lens, vignetting);
constexpr size_t kFirstImage = LP_END_OF(lensprof_exposures_image, white_balance_sigma);

}  // namespace lensprof

struct lensprof_exposures {
    lensprof_exposures_info info;
    std::vector<lensprof_exposures_camera> cameras;
    std::vector<lensprof_exposures_lens> lenses;
    std::vector<lensprof_exposures_image> images;
    std::deque<std::string> texts;  // to which the names point
};
