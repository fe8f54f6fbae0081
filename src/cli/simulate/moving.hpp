// A 3D scene for a moving camera (`simulate --set moving`). The z axis points up.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "cli/simulate/moving_maths.hpp"

namespace lensprof {

enum class MovingKind {
    terrain,
    room
};

const char *moving_word(MovingKind kind);  // "terrain", ...

// Parameters of a sequence.
struct MovingPlan {
    uint32_t seed, images, width, height;
    double hfov_deg, jitter_deg;
    double gloss;  // strength of highlights; 0 = matte surfaces
};

// A pinhole camera. Pixel centres are integers.
struct Pinhole {
    double focal_px, principal_px[2];
};

Pinhole pinhole_of(uint32_t width, uint32_t height, double hfov_deg);

// The pose of a picture. The rows of the rotation from world to camera are right, down and forward.
struct Pose {
    Vector3 centre_m;
    std::array<Vector3, 3> rotation;
};

// A pose looking in a direction, not necessarily of length 1; right is level. `jitter_deg` rotates it about all axes.
Pose pose_towards(const Vector3 &centre_m, const Vector3 &forward, const std::array<double, 3> &jitter_deg);

struct Line {
    Vector3 from, direction;  // of length 1
};

// The first intersection of a ray with a surface.
struct Hit {
    double distance_m = std::numeric_limits<double>::infinity();
    uint32_t surface = 0;  // 0 = none: the sky
    Vector3 point, normal;
};

// Reflection properties of a surface at a point.
struct Look {
    double rgb[3];           // reflectance, 0..1
    double gloss = 0.0;      // share of the highlight; 0 = matte
    double sharpness = 1.0;  // exponent of the highlight
};

// The sun, or a lamp.
struct Light {
    Vector3 place;     // m, or the direction to the sun
    bool is_sun;       // else a lamp, whose irradiance is as stated at 3 m
    double direct[3];  // radiance of a white surface facing it
    double sky[3];     // ambient light from above
    double gloss;      // strength of its highlights, relative to the usual
};

class MovingWorld {
public:
    MovingWorld() = default;
    virtual ~MovingWorld() = default;
    MovingWorld(const MovingWorld &) = delete;
    MovingWorld &operator=(const MovingWorld &) = delete;

    virtual Hit trace(const Line &line) const = 0;
    // The surface at an intersection; details smaller than `footprint_m` have faded to their mean.
    virtual Look look(const Hit &hit, double footprint_m) const = 0;
    virtual const Light &light() const = 0;
    virtual std::vector<Pose> path() const = 0;  // one pose per image of the plan
};

std::shared_ptr<const MovingWorld> make_terrain(const MovingPlan &plan);
std::shared_ptr<const MovingWorld> make_room(const MovingPlan &plan);
std::shared_ptr<const MovingWorld> make_moving_world(MovingKind kind, const MovingPlan &plan);

Line line_through(const Pinhole &pinhole, const Pose &pose, double x, double y);

// Mean radiance of a pixel, from four rays.
void moving_radiance(const MovingWorld &world, const Pinhole &pinhole, const Pose &pose, const double xy[2],
                     double rgb[3]);

}  // namespace lensprof
