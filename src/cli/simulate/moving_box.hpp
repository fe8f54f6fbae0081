// A box, rotated about the vertical.
#pragma once

#include "cli/simulate/moving.hpp"

namespace lensprof {

struct Box {
    Vector3 centre, half;
    double cosine = 1.0, sine = 0.0;
    uint32_t surface = 1;  // id of its face 0; face 2 * axis, plus one on the positive side of the axis
};

enum class BoxSide {
    outside,
    inside
};

// Whether a ray meets a side of the box nearer than `hit`, which is then updated.
bool meet_box(const Box &box, const Line &line, BoxSide side, Hit &hit);

// Position on a face, m: across and, on the four vertical faces, up from the bottom.
void place_on_box(const Box &box, uint32_t face, const Vector3 &point, double uv_m[2]);

}  // namespace lensprof
