// Profiles are in the frame of the sensor, pictures may have been rotated since.
#pragma once

#include <cstdint>

#include <lensprof/lensprof.h>

namespace lensprof {

// Turns centre and gain grid of a profile for a picture. `turn` is the sensor_orientation of the picture; if it is
// unknown, 0, the picture may have been rotated either way: the centre is then in the middle, and the grid the mean of
// both.
void turn_profile(uint16_t turn, lensprof_profile &profile);

// The reverse, for a profile that was measured in the frame of a picture.
void turn_profile_to_sensor(uint16_t turn, lensprof_profile &profile);

}  // namespace lensprof
