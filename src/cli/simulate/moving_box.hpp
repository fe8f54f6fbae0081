// A box in space, turned about the vertical.
#pragma once

#include "cli/simulate/moving.hpp"

namespace lensprof {

struct Box {
    Vector3 centre, half;
    double cosine = 1.0, sine = 0.0;
    uint32_t surface = 1;  // of its face 0; face 2 * axis, and one more on the axis' positive side
};

enum class BoxSide {
    outside,
    inside
};

// Whether a line meets a side of the box nearer than `hit`, which is then where.
bool meet_box(const Box &box, const Line &line, BoxSide side, Hit &hit);

// Place on a face, m: across and, of the four that stand, up from the bottom.
void place_on_box(const Box &box, uint32_t face, const Vector3 &point, double uv_m[2]);

}  // namespace lensprof
