// One pixel of a moving camera: rays into the scene, and the radiance along them.
#include <algorithm>
#include <cmath>

#include "cli/simulate/moving.hpp"

namespace lensprof {
namespace {

constexpr int kSamples = 4;
// A rotated square about the centre of the pixel: no two samples share a row or column.
constexpr double kOffsets[kSamples][2] = {{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}};

void sky_radiance(const Light &light, const Vector3 &direction, double rgb[3]) {
    const double high = std::max(direction.z, 0.0);
    const double haze[3] = {0.95, 0.97, 1.0}, zenith[3] = {0.35, 0.55, 1.0};
    for (int c = 0; c < 3; c++) rgb[c] = 1.5 * light.sky[c] * (haze[c] + (zenith[c] - haze[c]) * high);
}

// Lambert's law, and the highlight of Blinn and Phong.
void surface_radiance(const MovingWorld &world, const Line &line, const Hit &hit, double footprint_m, double rgb[3]) {
    const Light &light = world.light();
    const Look look = world.look(hit, footprint_m);
    const Vector3 light_vector = light.is_sun ? light.place : light.place - hit.point;
    const double strength = light.is_sun ? 1.0 : 9.0 / (dot(light_vector, light_vector) + 1.0);
    const Vector3 to_light = normalised(light_vector);
    const double facing = std::max(dot(hit.normal, to_light), 0.0), above = 0.6 + 0.4 * hit.normal.z;
    double highlight = 0.0;
    if (look.gloss > 0.0 && facing > 0.0) {
        const double half = dot(hit.normal, normalised(to_light - line.direction));
        highlight =
            light.gloss * look.gloss * std::pow(std::max(half, 0.0), look.sharpness) * (look.sharpness + 8.0) / 8.0;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = look.rgb[c] * (light.direct[c] * strength * facing + light.sky[c] * above)
                 + highlight * facing * light.direct[c] * strength;
}

// Footprint of a pixel on the surface, longer at a flat angle.
double footprint_of(const Pinhole &pinhole, const Line &line, const Hit &hit) {
    const double across = std::fabs(dot(hit.normal, line.direction));
    return hit.distance_m / pinhole.focal_px / std::sqrt(std::max(across, 0.05));
}

void radiance_of(const MovingWorld &world, const Pinhole &pinhole, const Line &line, const Hit &hit, double rgb[3]) {
    if (hit.surface == 0)
        sky_radiance(world.light(), line.direction, rgb);
    else
        surface_radiance(world, line, hit, footprint_of(pinhole, line, hit), rgb);
}

// All rays hit one surface at about the same distance: it is evaluated once, in the middle.
bool is_one_surface(const Hit (&hits)[kSamples]) {
    for (const Hit &hit : hits) {
        if (hit.surface != hits[0].surface || hit.surface == 0) return false;
        if (std::fabs(hit.distance_m - hits[0].distance_m) > 0.005 * hits[0].distance_m) return false;
    }
    return true;
}

Hit middle_of(const Hit (&hits)[kSamples]) {
    Hit middle = hits[0];
    middle.distance_m = 0.0, middle.point = middle.normal = Vector3();
    for (const Hit &hit : hits) {
        middle.distance_m += hit.distance_m / kSamples;
        middle.point = middle.point + 1.0 / kSamples * hit.point;
        middle.normal = middle.normal + 1.0 / kSamples * hit.normal;
    }
    middle.normal = normalised(middle.normal);
    return middle;
}

Vector3 rotated(const Vector3 &v, const Vector3 &axis, double degrees) {
    const double angle = degrees * kPi / 180.0;
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1.0 - std::cos(angle)) * dot(axis, v) * axis;
}

}  // namespace

const char *moving_word(MovingKind kind) { return kind == MovingKind::terrain ? "terrain" : "room"; }

std::shared_ptr<const MovingWorld> make_moving_world(MovingKind kind, const MovingPlan &plan) {
    return kind == MovingKind::terrain ? make_terrain(plan) : make_room(plan);
}

Pinhole pinhole_of(uint32_t width, uint32_t height, double hfov_deg) {
    return {0.5 * width / std::tan(hfov_deg * kPi / 360.0), {0.5 * (width - 1.0), 0.5 * (height - 1.0)}};
}

Pose pose_towards(const Vector3 &centre_m, const Vector3 &forward, const std::array<double, 3> &jitter_deg) {
    const Vector3 ahead = normalised(forward), right = normalised(cross(ahead, {0.0, 0.0, 1.0}));
    std::array<Vector3, 3> axes = {right, cross(ahead, right), ahead};
    for (size_t turn = 0; turn < 3; turn++) {
        const Vector3 axis = axes[turn];
        for (Vector3 &a : axes) a = rotated(a, axis, jitter_deg[turn]);
    }
    return {centre_m, axes};
}

Line line_through(const Pinhole &pinhole, const Pose &pose, double x, double y) {
    const double across = (x - pinhole.principal_px[0]) / pinhole.focal_px;
    const double down = (y - pinhole.principal_px[1]) / pinhole.focal_px;
    return {pose.centre_m, normalised(across * pose.rotation[0] + down * pose.rotation[1] + pose.rotation[2])};
}

void moving_radiance(const MovingWorld &world, const Pinhole &pinhole, const Pose &pose, const double xy[2],
                     double rgb[3]) {
    Line lines[kSamples];
    Hit hits[kSamples];
    for (int s = 0; s < kSamples; s++) {
        lines[s] = line_through(pinhole, pose, xy[0] + kOffsets[s][0], xy[1] + kOffsets[s][1]);
        hits[s] = world.trace(lines[s]);
    }
    if (is_one_surface(hits)) {
        radiance_of(world, pinhole, line_through(pinhole, pose, xy[0], xy[1]), middle_of(hits), rgb);
        return;
    }
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    for (int s = 0; s < kSamples; s++) {
        double sample[3];
        radiance_of(world, pinhole, lines[s], hits[s], sample);
        for (int c = 0; c < 3; c++) rgb[c] += sample[c] / kSamples;
    }
}

}  // namespace lensprof
