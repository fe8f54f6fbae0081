// What reader and writer of Adobe's lens profiles share.
#pragma once

#include <cstdint>

namespace lensprof {

constexpr double kLcpInfinityM = 999999995904.0;  // which Adobe's files have for infinity, 1e12 in single precision
constexpr double kLcpFarM = 10000.0;              // from here on a distance is infinity
constexpr uint32_t kLcpWidth = 3000, kLcpHeight = 2000;  // of frames whose size is not known; only the ratio counts

}  // namespace lensprof
