#include "fit/online/possible_step.hpp"

#include <algorithm>
#include <cmath>

#include "fit/online/camera.hpp"
#include "fit/problem/curve_shape.hpp"

namespace lensprof {
namespace online {
namespace {

constexpr int kScans = 100;       // of the method
constexpr int kMostHeld = 32;     // bounds that hold a step
constexpr int kRadiiHeld = 24;    // at which the falloff is held
constexpr double kLeastM = 0.01;  // there

// A quantity that a step may not make negative: now + direction's. The first kRises are those of the response between
// its samples, less the smallest rise; then that of M at radii, less the least.
struct Bound {
    int number;
    double multiplier;
};

double r2_of(const Camera &camera, int radius) {
    const double reach = 1.0 + std::hypot(camera.center[0], camera.center[1]);
    return reach * reach * (radius + 1) / kRadiiHeld;
}

Globals direction_of(const Camera &camera, int number) {
    Globals direction = Globals::Zero();
    if (number < kRises) {
        for (int l = 0; l < camera.modes; l++)
            direction[l] =
                static_cast<double>(camera.mode[number + 1][l]) - static_cast<double>(camera.mode[number][l]);
        return direction;
    }
    double power = 1.0;
    for (int n = 0; n < 3; n++) direction[kModes + n] = power *= r2_of(camera, number - kRises);
    return direction;
}

double gap_of(const Camera &camera, int number, const Globals &step) {
    const Globals direction = direction_of(camera, number);
    const double now = number < kRises ? camera.table[number + 1] - camera.table[number] - kSmallestRise
                                       : 1.0 - kLeastM + direction.dot(camera.globals);
    return -now - direction.dot(step);
}

// The bound that the step violates most, of the response or else of the falloff; -1: none.
int violated(const Camera &camera, const Globals &step) {
    double table[LENSPROF_RESPONSE_SAMPLES];
    fill_table(camera.globals + step, camera, table);
    int worst = 0;
    for (int j = 1; j < kRises; j++)
        if (table[j + 1] - table[j] < table[worst + 1] - table[worst]) worst = j;
    if (gap_of(camera, worst, step) > 0.25 * kSmallestRise && camera.modes) return worst;
    worst = kRises;
    for (int n = kRises + 1; n < kRises + kRadiiHeld; n++)
        if (gap_of(camera, n, step) > gap_of(camera, worst, step)) worst = n;
    return gap_of(camera, worst, step) > 0.25 * kLeastM ? worst : -1;
}

}  // namespace

// Hildreth's method: coordinate ascent of the multipliers of the bounds that hold the step.
Globals possible_step(const Camera &camera, const GlobalMatrix &inverse, const Globals &pull) {
    Bound held[kMostHeld];
    int count = 0;
    Globals step = inverse * pull;
    const auto raise = [&](Bound &bound) {
        const Globals direction = direction_of(camera, bound.number), moves = inverse * direction;
        const double change = std::max(gap_of(camera, bound.number, step) / direction.dot(moves), -bound.multiplier);
        bound.multiplier += change, step += change * moves;
    };
    for (int n = 0; n < kScans; n++) {
        const int worst = violated(camera, step);
        if (worst < 0) break;
        const auto *known = std::find_if(held, held + count, [&](const Bound &b) { return b.number == worst; });
        if (known == held + count) {
            if (count == kMostHeld) break;
            held[count++] = {worst, 0.0};
        }
        for (int i = 0; i < count; i++) raise(held[i]);
    }
    return step;
}

}  // namespace online
}  // namespace lensprof
