// Turning and mirroring by EXIF orientation (EXIF 2.32, tag 274), 1 to 8.
#pragma once

#include <cstdint>

namespace lensprof {

// Whether a picture of this orientation is displayed with its sides swapped.
bool swaps_sides(uint16_t orientation);

// The orientation that undoes this one.
uint16_t inverse_orientation(uint16_t orientation);

// A vector from the centre of the stored picture, x to the right and y down, as the displayed picture has it.
void turn_upright(uint16_t orientation, double &x, double &y);

// The orientation that turns a stored picture into the frame of the sensor, which is wider than high; 0 if unknown.
// Cameras store what the sensor sees, and an orientation of how they were held. A picture higher than wide was rotated
// later: with an orientation that turns it back, this is the sensor's frame, otherwise it may have been rotated either
// way.
uint16_t sensor_orientation(uint32_t width, uint32_t height, uint16_t orientation);

}  // namespace lensprof
