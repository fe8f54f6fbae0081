// What reader and writer of the Raspberry Pi's lens shading tables share.
#pragma once

namespace lensprof {

constexpr double kAlscTemperatureK = 4500.0;  // libcamera's default_ct
constexpr const char *kAlscName = "rpi.alsc";

}  // namespace lensprof
