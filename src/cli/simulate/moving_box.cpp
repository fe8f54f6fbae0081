#include "cli/simulate/moving_box.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace {

Vector3 into_box(const Box &box, const Vector3 &v) {
    return {box.cosine * v.x + box.sine * v.y, box.cosine * v.y - box.sine * v.x, v.z};
}

Vector3 out_of_box(const Box &box, const Vector3 &v) {
    return {box.cosine * v.x - box.sine * v.y, box.cosine * v.y + box.sine * v.x, v.z};
}

// Where a ray enters and leaves the slabs of a box, and through which faces.
struct Passage {
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
    uint32_t face_in = 0, face_out = 0;

    void cut(uint32_t axis, double origin, double step, double half) {
        const double safe = std::fabs(step) < 1e-12 ? 1e-12 : step;
        const double low = (-half - origin) / safe, high = (half - origin) / safe;
        const uint32_t ahead = safe > 0.0 ? 1 : 0;  // leaves through the positive side
        if (std::min(low, high) > from) from = std::min(low, high), face_in = 2 * axis + 1 - ahead;
        if (std::max(low, high) < to) to = std::max(low, high), face_out = 2 * axis + ahead;
    }
};

Vector3 normal_of(uint32_t face, double sign) {
    const double n = face % 2 ? sign : -sign;
    return {face / 2 == 0 ? n : 0.0, face / 2 == 1 ? n : 0.0, face / 2 == 2 ? n : 0.0};
}

}  // namespace

bool meet_box(const Box &box, const Line &line, BoxSide side, Hit &hit) {
    const Vector3 from = into_box(box, line.from - box.centre), step = into_box(box, line.direction);
    Passage passage;
    passage.cut(0, from.x, step.x, box.half.x);
    passage.cut(1, from.y, step.y, box.half.y);
    passage.cut(2, from.z, step.z, box.half.z);
    if (passage.from > passage.to) return false;
    const bool inside = side == BoxSide::inside;
    const double distance_m = inside ? passage.to : passage.from;
    if (distance_m <= 0.0 || distance_m >= hit.distance_m) return false;
    const uint32_t face = inside ? passage.face_out : passage.face_in;
    hit.distance_m = distance_m;
    hit.surface = box.surface + face;
    hit.point = line.from + distance_m * line.direction;
    hit.normal = out_of_box(box, normal_of(face, inside ? -1.0 : 1.0));
    return true;
}

void place_on_box(const Box &box, uint32_t face, const Vector3 &point, double uv_m[2]) {
    const Vector3 place = into_box(box, point - box.centre);
    uv_m[0] = face / 2 == 0 ? place.y : place.x;
    uv_m[1] = face / 2 == 2 ? place.y : place.z + box.half.z;
}

}  // namespace lensprof
