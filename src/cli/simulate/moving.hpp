// A scene in space before a camera that moves (`simulate --moving`). The z axis points up.
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

// What a sequence is made for.
struct MovingPlan {
    uint32_t seed, images, width, height;
    double hfov_deg, jitter_deg;
    double gloss;  // strength of highlights; 0 = matte surfaces
};

// A pinhole camera. Centres of pixels are whole numbers.
struct Pinhole {
    double focal_px, principal_px[2];
};

Pinhole pinhole_of(uint32_t width, uint32_t height, double hfov_deg);

// Where a picture is taken from. The rows of the rotation from world to camera are right, down and forward.
struct Pose {
    Vector3 centre_m;
    std::array<Vector3, 3> rotation;
};

// Looks in a direction that need not have length 1; right is level. `jitter_deg` turns it about all axes.
Pose pose_towards(const Vector3 &centre_m, const Vector3 &forward, const std::array<double, 3> &jitter_deg);

struct Line {
    Vector3 from, direction;  // of length 1
};

// Where a line first meets a surface.
struct Hit {
    double distance_m = std::numeric_limits<double>::infinity();
    uint32_t surface = 0;  // 0 = none: the sky
    Vector3 point, normal;
};

// What a surface does to light at a point.
struct Look {
    double rgb[3];           // reflectance, 0..1
    double gloss = 0.0;      // share of the light that the highlight has; 0 = matte
    double sharpness = 1.0;  // exponent of the highlight
};

// The sun, or a lamp in a place.
struct Light {
    Vector3 place;     // m, or the direction to the sun
    bool is_sun;       // else a lamp, whose light is as stated at 3 m
    double direct[3];  // light of a white surface that faces it
    double sky[3];     // light from everywhere above
    double gloss;      // strength of its highlights, of the usual
};

class MovingWorld {
public:
    MovingWorld() = default;
    virtual ~MovingWorld() = default;
    MovingWorld(const MovingWorld &) = delete;
    MovingWorld &operator=(const MovingWorld &) = delete;

    virtual Hit trace(const Line &line) const = 0;
    // Of a point that was hit; details smaller than `footprint_m` have faded to their mean.
    virtual Look look(const Hit &hit, double footprint_m) const = 0;
    virtual const Light &light() const = 0;
    virtual std::vector<Pose> path() const = 0;  // a pose for each image of the plan
};

std::shared_ptr<const MovingWorld> make_terrain(const MovingPlan &plan);
std::shared_ptr<const MovingWorld> make_room(const MovingPlan &plan);
std::shared_ptr<const MovingWorld> make_moving_world(MovingKind kind, const MovingPlan &plan);

Line line_through(const Pinhole &pinhole, const Pose &pose, double x, double y);

// Mean radiance of a pixel, of four lines through it.
void moving_radiance(const MovingWorld &world, const Pinhole &pinhole, const Pose &pose, const double xy[2],
                     double rgb[3]);

}  // namespace lensprof
