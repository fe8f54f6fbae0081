#include "photo/pictures/orientation.hpp"

#include <utility>

namespace lensprof {
namespace {

constexpr uint16_t kMirrored = 2, kMirroredDown = 4, kTransposed = 5, kClockwise = 6, kAnticlockwise = 8, kLast = 8;

}  // namespace

bool swaps_sides(uint16_t orientation) { return orientation >= kTransposed && orientation <= kLast; }

uint16_t inverse_orientation(uint16_t orientation) {
    return orientation == kClockwise ? kAnticlockwise : orientation == kAnticlockwise ? kClockwise : orientation;
}

void turn_upright(uint16_t orientation, double &x, double &y) {
    static const struct {
        bool left, up;  // after swapping the sides
    } signs[kLast + 1] = {{false, false}, {false, false}, {true, false}, {true, true}, {false, true},
                          {false, false}, {true, false},  {true, true},  {false, true}};
    if (orientation > kLast) return;
    if (swaps_sides(orientation)) std::swap(x, y);
    if (signs[orientation].left) x = -x;
    if (signs[orientation].up) y = -y;
}

uint16_t sensor_orientation(uint32_t width, uint32_t height, uint16_t orientation) {
    if (height > width) return swaps_sides(orientation) ? orientation : 0;
    return orientation == kMirrored || orientation == kMirroredDown ? orientation : 1;
}

}  // namespace lensprof
