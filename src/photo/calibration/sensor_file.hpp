// Lens shading tables of a sensor for the Raspberry Pi (libcamera's rpi.alsc), at several colour temperatures.
#pragma once

#include <string>
#include <vector>

#include <lensprof/profile.h>

namespace lensprof {

struct SensorTables {
    uint32_t columns = 16, rows = 12;  // 32 x 32 for a Pi 5
};

// What a file of one sensor loses: the largest relative difference of green at a temperature from the luminance table,
// which is one for all.
struct SensorFileCost {
    double green = 0.0;
    bool has_colours = false;  // else the file has the luminance table alone
};

// The bytes of the file. `aspect`: width over height of the frame. The colour temperatures of the keys differ; for one
// profile it may be unknown, and is then 4500 K. If no profile has a falloff per channel, the file has the luminance
// table alone, as for a mono sensor. Failure.
std::string sensor_file_text(std::vector<const lensprof_profile *> profiles, double aspect, const SensorTables &tables,
                             SensorFileCost &cost);

}  // namespace lensprof
