// A room with boxes; the camera moves around them.
#include <algorithm>
#include <cmath>

#include "cli/simulate/moving.hpp"
#include "cli/simulate/moving_box.hpp"
#include "cli/simulate/moving_texture.hpp"
#include "cli/simulate/scene_maths.hpp"
#include "cli/simulate/simulate.hpp"

namespace lensprof {
namespace {

constexpr Vector3 kHalf = {6.0, 4.5, 1.8};  // of the room, m
constexpr double kPath[2] = {4.1, 2.9};     // half axes of the camera's path, m
constexpr uint32_t kSurfaces = 8;           // ids used by a box

class Room : public MovingWorld {
public:
    explicit Room(const MovingPlan &plan) : plan_(plan) {
        light_.gloss = plan.gloss;
        walls_.half = kHalf;
        walls_.centre.z = kHalf.z;
        Random random(plan.seed * 6364136223846793005ull + 11);
        for (int b = 0; b < 11; b++) add_free_box(random);
        for (int b = 0; b < 12; b++) add_wall_box(random);
        for (size_t b = 0; b < boxes_.size(); b++) boxes_[b].surface = 1 + kSurfaces * static_cast<uint32_t>(b + 1);
    }

    Hit trace(const Line &line) const override {
        Hit hit;
        meet_box(walls_, line, BoxSide::inside, hit);
        for (const Box &box : boxes_) meet_box(box, line, BoxSide::outside, hit);
        return hit;
    }

    Look look(const Hit &hit, double footprint_m) const override {
        const uint32_t box = (hit.surface - 1) / kSurfaces, face = (hit.surface - 1) % kSurfaces;
        double uv_m[2];
        place_on_box(box ? boxes_[box - 1] : walls_, face, hit.point, uv_m);
        if (box) return look_of_box(box, face, uv_m, footprint_m);
        if (face == 4) return look_of_floor(uv_m, footprint_m);
        return face == 5 ? look_of_ceiling(uv_m, footprint_m) : look_of_wall(face, uv_m, footprint_m);
    }

    const Light &light() const override { return light_; }
    std::vector<Pose> path() const override;

private:
    void add_free_box(Random &random);
    void add_wall_box(Random &random);
    Look look_of_box(uint32_t box, uint32_t face, const double uv_m[2], double footprint_m) const;
    Look look_of_floor(const double uv_m[2], double footprint_m) const;
    Look look_of_ceiling(const double uv_m[2], double footprint_m) const;
    Look look_of_wall(uint32_t face, const double uv_m[2], double footprint_m) const;

    MovingPlan plan_;
    Light light_ = {{1.2, -0.8, 3.2}, false, {0.95, 0.88, 0.75}, {0.30, 0.31, 0.34}, 1.0};
    Box walls_;
    std::vector<Box> boxes_;
};

// Away from the camera's path, and from other boxes if a few attempts succeed.
void Room::add_free_box(Random &random) {
    Box box;
    box.half = {random.uniform(0.15, 0.5), random.uniform(0.15, 0.5), random.uniform(0.15, 0.85)};
    box.centre.z = box.half.z;
    const double turn = random.uniform(0.0, kPi), radius = std::hypot(box.half.x, box.half.y);
    box.cosine = std::cos(turn), box.sine = std::sin(turn);
    for (int attempt = 0; attempt < 50; attempt++) {
        const double angle = random.uniform(0.0, 2.0 * kPi), distance = std::sqrt(random.uniform());
        box.centre.x = 2.7 * distance * std::cos(angle), box.centre.y = 1.7 * distance * std::sin(angle);
        const bool is_free = std::none_of(boxes_.begin(), boxes_.end(), [&](const Box &other) {
            return std::hypot(box.centre.x - other.centre.x, box.centre.y - other.centre.y)
                   < radius + std::hypot(other.half.x, other.half.y);
        });
        if (!is_free) continue;
        boxes_.push_back(box);
        return;
    }
}

void Room::add_wall_box(Random &random) {
    Box box;
    const bool side = random.uniform() < 0.4, positive = random.uniform() < 0.5;
    const double depth = random.uniform(0.15, 0.35), width = random.uniform(0.3, 0.7);
    box.half = {side ? depth : width, side ? width : depth, random.uniform(0.3, 1.0)};
    const double along = random.uniform(-0.9, 0.9);
    box.centre = {side ? kHalf.x - depth : along * (kHalf.x - width),
                  side ? along * (kHalf.y - width) : kHalf.y - depth, box.half.z};
    if (!positive) box.centre.x = -box.centre.x, box.centre.y = -box.centre.y;
    boxes_.push_back(box);
}

// Cardboard, tiles, prints of many colours and paint; every third is glossy.
Look Room::look_of_box(uint32_t box, uint32_t face, const double uv_m[2], double footprint_m) const {
    const uint32_t seed = plan_.seed * 977u + box * 31u;
    const double kind = cell_draw(box, 0.0, 21, seed);
    Look look{};
    cell_colour(box, 0.0, seed, 0.22, look.rgb);
    if (kind < 0.3) {
        const double cell_m = 0.07 + 0.1 * cell_draw(box, 0.0, 22, seed);
        cell_colour(uv_m[0] / cell_m, uv_m[1] / cell_m, seed + face, 0.25, look.rgb);
    } else if (kind < 0.55) {
        const double seam = 1.0 - 0.7 * joint(uv_m[0] / 0.2, uv_m[1] / 0.2, 0.02, footprint_m / 0.2);
        for (double &c : look.rgb) c *= seam;
    }
    add_grain({seed + face, 0.4, 0.33}, uv_m[0], uv_m[1], footprint_m, look.rgb);
    if (cell_draw(box, 0.0, 23, seed) < 0.35) look.gloss = 0.12, look.sharpness = 30.0;
    return look;
}

// Varnished planks.
Look Room::look_of_floor(const double uv_m[2], double footprint_m) const {
    const double u = uv_m[0] / 1.6, v = uv_m[1] / 0.17;
    const double shift = cell_draw(0.0, v, 24, plan_.seed);
    Look look{};
    cell_colour(u + shift, v, plan_.seed + 5, 0.8, look.rgb);
    const double wood[3] = {0.42, 0.27, 0.15};
    const double seam = 1.0 - 0.6 * joint(0.5, v, 0.02, footprint_m / 0.17);
    for (int c = 0; c < 3; c++) look.rgb[c] = wood[c] * std::sqrt(look.rgb[c]) * seam;
    add_grain({plan_.seed * 977u + 7u, 0.5, 0.27}, 0.3 * uv_m[0], uv_m[1], footprint_m, look.rgb);
    look.gloss = 0.1, look.sharpness = 60.0;
    return look;
}

Look Room::look_of_ceiling(const double uv_m[2], double footprint_m) const {
    Look look{{0.8, 0.79, 0.76}};
    const double seam = 1.0 - 0.6 * joint(uv_m[0] / 0.6, uv_m[1] / 0.6, 0.012, footprint_m / 0.6);
    for (double &c : look.rgb) c *= seam;
    add_grain({plan_.seed * 977u + 9u, 0.3, 0.17}, uv_m[0], uv_m[1], footprint_m, look.rgb);
    return look;
}

// White plaster, bricks, paper and dark wood, with prints on all of them.
Look Room::look_of_wall(uint32_t face, const double uv_m[2], double footprint_m) const {
    const double paint[4][3] = {{0.72, 0.70, 0.64}, {0.34, 0.15, 0.10}, {0.20, 0.33, 0.28}, {0.10, 0.075, 0.055}};
    const double grain[4] = {0.16, 0.30, 0.24, 0.34};
    const uint32_t seed = plan_.seed * 977u + face * 131u;
    Look look{};
    std::copy(paint[face], paint[face] + 3, look.rgb);
    double u = uv_m[0] / 1.3 + 0.3 * face, v = uv_m[1] / 1.25 + 0.1;
    const double inset = std::max(std::fabs(from_whole(u - 0.5)), std::fabs(from_whole(v - 0.5)));
    const bool print = cell_draw(u, v, 25, seed) < 0.6 && inset < 0.2 + 0.18 * cell_draw(u, v, 26, seed);
    if (print) {
        const double cell_m = 0.06 + 0.2 * cell_draw(u, v, 27, seed);
        cell_colour(uv_m[0] / cell_m, uv_m[1] / cell_m, seed, 0.3, look.rgb);
    } else if (face == 1) {
        v = uv_m[1] / 0.09, u = uv_m[0] / 0.24 + 0.5 * std::fmod(std::floor(v + 0.5), 2.0);
        double brick[3];
        cell_colour(u + 0.5, v + 0.5, seed, 1.0, brick);
        const double mortar = joint(u + 0.5, v + 0.5, 0.06, footprint_m / 0.09);
        for (int c = 0; c < 3; c++) look.rgb[c] = mix(look.rgb[c] * std::sqrt(brick[c]), 0.5, mortar);
    } else if (face == 3) {
        const double seam = 1.0 - 0.7 * joint(uv_m[0] / 0.12, 0.5, 0.06, footprint_m / 0.12);
        for (double &c : look.rgb) c *= seam;
        look.gloss = 0.05, look.sharpness = 25.0;
    }
    add_grain({seed, 0.7, print ? 0.3 : grain[face]}, uv_m[0], uv_m[1], footprint_m, look.rgb);
    return look;
}

// Around the centre, looking across it. A few pictures cover only a part of the path, so that they overlap.
std::vector<Pose> Room::path() const {
    Random random(plan_.seed * 6364136223846793005ull + 12);
    const double step = std::min(2.0 * kPi / plan_.images, 0.3 * plan_.hfov_deg * kPi / 180.0);
    const double start = random.uniform(0.0, 2.0 * kPi);
    std::vector<Pose> poses;
    for (uint32_t i = 0; i < plan_.images; i++) {
        const double angle = start + step * i;
        const Vector3 place = {kPath[0] * std::cos(angle), kPath[1] * std::sin(angle),
                               1.65 + 0.2 * std::sin(3.0 * angle)};
        const Vector3 seen = {0.8 * std::sin(2.0 * angle), 0.8 * std::cos(3.0 * angle), 0.95};
        poses.push_back(pose_towards(place, seen - place,
                                     {plan_.jitter_deg * random.normal(), plan_.jitter_deg * random.normal(),
                                      plan_.jitter_deg * random.normal()}));
    }
    return poses;
}

}  // namespace

std::shared_ptr<const MovingWorld> make_room(const MovingPlan &plan) { return std::make_shared<Room>(plan); }

}  // namespace lensprof
