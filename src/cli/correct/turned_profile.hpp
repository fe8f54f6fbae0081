// A profile, which is in the frame of the sensor, for a picture that was turned.
#pragma once

#include <cstdint>

#include <lensprof/lensprof.h>

namespace lensprof {

// Turns centre and gain grid. `turn` is the sensor_orientation of the picture; if it is unknown, 0, the picture may
// have been turned either way: the centre is then in the middle, and the grid the mean of both.
void turn_profile(uint16_t turn, lensprof_profile &profile);

}  // namespace lensprof
