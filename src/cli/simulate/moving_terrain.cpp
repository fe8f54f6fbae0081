// Hills with fields, houses and trees, surveyed by a drone that flies rows.
#include <algorithm>
#include <cmath>

#include "cli/simulate/moving.hpp"
#include "cli/simulate/moving_box.hpp"
#include "cli/simulate/moving_heights.hpp"
#include "cli/simulate/moving_texture.hpp"
#include "cli/simulate/scene_maths.hpp"
#include "cli/simulate/simulate.hpp"

namespace lensprof {
namespace {

constexpr double kAltitude = 62.0;           // of the drone above the middle of the ground, m
constexpr double kTilt = 14.0;               // of its camera, forward from straight down, degrees
constexpr double kAhead = 0.22;              // share of a picture's height between two pictures of a row
constexpr double kAside = 0.38;              // share of a picture's width between two rows
constexpr double kMargin = 70.0;             // of the hills beyond the drone's path, m
constexpr double kBucket = 10.0;             // side of the lattice for finding houses and trees, m
constexpr double kField = 21.0;              // side of a field, m
constexpr uint32_t kGround = 1, kFirst = 8;  // ids of surfaces; a house takes 8, a tree 1

// Rows of the survey. Their number makes the surveyed area about square.
struct Survey {
    uint32_t rows, columns;
    double ahead_m, aside_m;

    explicit Survey(const MovingPlan &plan) {
        const double width_m = 2.0 * kAltitude * std::tan(plan.hfov_deg * kPi / 360.0);
        ahead_m = kAhead * width_m * plan.height / plan.width, aside_m = kAside * width_m;
        const double square = std::sqrt(plan.images * ahead_m / aside_m);
        rows = std::max(1u, static_cast<uint32_t>(std::lround(square)));
        columns = (plan.images + rows - 1) / rows;
    }
    double reach_x_m() const { return 0.5 * (rows - 1) * aside_m + kMargin; }
    double reach_y_m() const { return 0.5 * (columns - 1) * ahead_m + kMargin; }
};

// Across from the middle of the road, m.
double from_road(double x, double y) { return x - 14.0 * std::sin(y / 31.0) - 9.0; }

struct Tree {
    Vector3 centre;
    double radius_m;
};

class Terrain : public MovingWorld {
public:
    explicit Terrain(const MovingPlan &plan)
        : plan_(plan),
          survey_(plan),
          ground_(plan.seed * 977u, survey_.reach_x_m(), survey_.reach_y_m()),
          columns_(static_cast<int>(2.0 * survey_.reach_x_m() / kBucket) + 1),
          rows_(static_cast<int>(2.0 * survey_.reach_y_m() / kBucket) + 1),
          buckets_(static_cast<size_t>(columns_) * static_cast<size_t>(rows_)) {
        light_.gloss = plan.gloss;
        Random random(plan.seed * 6364136223846793005ull + 21);
        const double hectares = 4.0 * survey_.reach_x_m() * survey_.reach_y_m() / 1e4;
        for (int h = 0; h < static_cast<int>(9.0 * hectares); h++) add_house(random);
        for (int t = 0; t < static_cast<int>(130.0 * hectares); t++) add_tree(random);
    }

    Hit trace(const Line &line) const override;
    Look look(const Hit &hit, double footprint_m) const override;
    const Light &light() const override { return light_; }
    std::vector<Pose> path() const override;

private:
    // Objects above a piece of ground.
    struct Bucket {
        std::vector<uint32_t> houses, trees;
    };
    int column_of(double x) const {
        return std::clamp(static_cast<int>((x + survey_.reach_x_m()) / kBucket), 0, columns_ - 1);
    }
    int row_of(double y) const {
        return std::clamp(static_cast<int>((y + survey_.reach_y_m()) / kBucket), 0, rows_ - 1);
    }
    template <class Visit>
    void for_each_bucket(const Vector3 &a, const Vector3 &b, const Visit &visit) const;
    bool is_free(double x, double y, double radius_m) const;
    void add_house(Random &random);
    void add_tree(Random &random);
    void meet_tree(uint32_t tree, const Line &line, Hit &hit) const;
    Look look_of_ground(const Hit &hit, double footprint_m) const;
    Look look_of_house(uint32_t house, uint32_t face, const Vector3 &point, double footprint_m) const;
    Look look_of_tree(uint32_t tree, const Vector3 &point, double footprint_m) const;

    MovingPlan plan_;
    Survey survey_;
    Heights ground_;
    Light light_ = {normalised({0.45, 0.35, 0.82}), true, {0.92, 0.86, 0.76}, {0.22, 0.26, 0.34}, 1.0};
    int columns_, rows_;
    std::vector<Bucket> buckets_;
    std::vector<Box> houses_;
    std::vector<Tree> trees_;
    double highest_ = 0.0;  // of houses and trees
};

// The buckets of the rectangle between two places.
template <class Visit>
void Terrain::for_each_bucket(const Vector3 &a, const Vector3 &b, const Visit &visit) const {
    const int left = column_of(std::min(a.x, b.x)), right = column_of(std::max(a.x, b.x));
    const int first = row_of(std::min(a.y, b.y)), last = row_of(std::max(a.y, b.y));
    for (int j = first; j <= last; j++)
        for (int i = left; i <= right; i++)
            visit(static_cast<size_t>(j) * static_cast<size_t>(columns_) + static_cast<size_t>(i));
}

bool Terrain::is_free(double x, double y, double radius_m) const {
    if (std::fabs(from_road(x, y)) < radius_m + 3.5) return false;
    return std::none_of(houses_.begin(), houses_.end(), [&](const Box &house) {
        return std::hypot(x - house.centre.x, y - house.centre.y) < radius_m + std::hypot(house.half.x, house.half.y);
    });
}

void Terrain::add_house(Random &random) {
    Box house;
    house.half = {random.uniform(2.5, 5.0), random.uniform(2.0, 4.0), random.uniform(2.2, 4.5)};
    const double turn = random.uniform(0.0, kPi), radius_m = std::hypot(house.half.x, house.half.y);
    house.cosine = std::cos(turn), house.sine = std::sin(turn);
    house.centre.x = random.uniform(-1.0, 1.0) * (survey_.reach_x_m() - 10.0);
    house.centre.y = random.uniform(-1.0, 1.0) * (survey_.reach_y_m() - 10.0);
    house.centre.z = ground_.height_at(house.centre.x, house.centre.y) + 0.6 * house.half.z;
    if (!is_free(house.centre.x, house.centre.y, radius_m)) return;
    const auto index = static_cast<uint32_t>(houses_.size());
    house.surface = kFirst + 8 * index;
    houses_.push_back(house);
    highest_ = std::max(highest_, house.centre.z + house.half.z);
    const Vector3 reach = {radius_m, radius_m, 0.0};
    for_each_bucket(house.centre - reach, house.centre + reach,
                    [&](size_t bucket) { buckets_[bucket].houses.push_back(index); });
}

// More of them in the wood.
void Terrain::add_tree(Random &random) {
    Tree tree;
    tree.radius_m = random.uniform(0.8, 2.6);
    const double x = random.uniform(-1.0, 1.0) * (survey_.reach_x_m() - 4.0);
    const double y = random.uniform(-1.0, 1.0) * (survey_.reach_y_m() - 4.0), wish = random.uniform();
    if (wish > ramp(-0.3, 0.6, noise2(x / 45.0, y / 45.0, plan_.seed * 977u + 61u)) + 0.1) return;
    if (!is_free(x, y, tree.radius_m)) return;
    tree.centre = {x, y, ground_.height_at(x, y) + 0.7 * tree.radius_m};
    const auto index = static_cast<uint32_t>(trees_.size());
    trees_.push_back(tree);
    highest_ = std::max(highest_, tree.centre.z + tree.radius_m);
    const Vector3 reach = {tree.radius_m, tree.radius_m, 0.0};
    for_each_bucket(tree.centre - reach, tree.centre + reach,
                    [&](size_t bucket) { buckets_[bucket].trees.push_back(index); });
}

void Terrain::meet_tree(uint32_t index, const Line &line, Hit &hit) const {
    const Tree &tree = trees_[index];
    const Vector3 to_centre = tree.centre - line.from;
    const double closest_m = dot(to_centre, line.direction),
                 half_chord_squared = tree.radius_m * tree.radius_m - dot(to_centre, to_centre) + closest_m * closest_m;
    if (half_chord_squared <= 0.0) return;
    const double distance_m = closest_m - std::sqrt(half_chord_squared);
    if (distance_m <= 0.0 || distance_m >= hit.distance_m) return;
    hit.distance_m = distance_m;
    hit.surface = kFirst + 8 * static_cast<uint32_t>(houses_.size()) + index;
    hit.point = line.from + distance_m * line.direction;
    hit.normal = 1.0 / tree.radius_m * (hit.point - tree.centre);
}

// The ground first: objects on it are hit between there and where the ray descends below the highest of them.
Hit Terrain::trace(const Line &line) const {
    Hit hit;
    if (ground_.meet(line, hit.distance_m)) {
        hit.surface = kGround;
        hit.point = line.from + hit.distance_m * line.direction;
        hit.normal = ground_.normal(hit.point.x, hit.point.y);
    }
    if (line.direction.z > -0.02) return hit;
    const double high = std::max((highest_ - line.from.z) / line.direction.z, 0.0);
    const double low = std::min(hit.distance_m, (-30.0 - line.from.z) / line.direction.z);
    for_each_bucket(line.from + high * line.direction, line.from + low * line.direction, [&](size_t bucket) {
        for (const uint32_t house : buckets_[bucket].houses) meet_box(houses_[house], line, BoxSide::outside, hit);
        for (const uint32_t tree : buckets_[bucket].trees) meet_tree(tree, line, hit);
    });
    return hit;
}

Look Terrain::look(const Hit &hit, double footprint_m) const {
    if (hit.surface == kGround) return look_of_ground(hit, footprint_m);
    const uint32_t object = hit.surface - kFirst;
    if (object < 8 * houses_.size()) return look_of_house(object / 8, object % 8, hit.point, footprint_m);
    return look_of_tree(object - 8 * static_cast<uint32_t>(houses_.size()), hit.point, footprint_m);
}

// Fields with furrows, each of its own colour and some of them wet; bare stone where it is steep, woods and a road.
Look Terrain::look_of_ground(const Hit &hit, double footprint_m) const {
    const uint32_t seed = plan_.seed * 977u + 40u;
    const double x = hit.point.x, y = hit.point.y;
    const double u = x / kField + 0.3 * noise2(x / 40.0, y / 40.0, seed),
                 v = y / (1.4 * kField) + 0.3 * noise2(x / 35.0, y / 35.0, seed + 1);
    Look look{};
    cell_colour(u, v, seed, 0.19, look.rgb);
    const double earth[3] = {1.05, 1.0, 0.62}, mean = (look.rgb[0] + look.rgb[1] + look.rgb[2]) / 3.0;
    for (int c = 0; c < 3; c++) look.rgb[c] = mix(look.rgb[c], mean, 0.4) * earth[c];
    const double turn = kPi * cell_draw(u, v, 31, seed);
    const double furrow = (x * std::cos(turn) + y * std::sin(turn)) / 0.9;
    const double depth = 0.5 * cell_draw(u, v, 32, seed) * ramp(0.2, 0.5, 0.45 / footprint_m);
    for (double &c : look.rgb) c *= 1.0 + depth * std::cos(2.0 * kPi * furrow);
    const double hedge = joint(u, v, 0.022, footprint_m / kField),
                 wood = ramp(-0.1, 0.25, noise2(x / 45.0, y / 45.0, plan_.seed * 977u + 61u));
    const double stone = ramp(0.13, 0.22, 1.0 - hit.normal.z);
    const double road_distance = from_road(x, y), road = 1.0 - ramp(2.1, 2.5, std::fabs(road_distance));
    const double leaves[3] = {0.05, 0.075, 0.03}, rock[3] = {0.34, 0.31, 0.27}, asphalt[3] = {0.13, 0.13, 0.135};
    for (int c = 0; c < 3; c++) {
        look.rgb[c] = mix(mix(look.rgb[c], leaves[c], std::max(hedge, 0.85 * wood)), rock[c], stone);
        look.rgb[c] = mix(look.rgb[c], asphalt[c], road);
    }
    if (std::fabs(road_distance) < 0.12 && from_whole(y / 6.0) > 0.0) look.rgb[0] = look.rgb[1] = look.rgb[2] = 0.7;
    const double lightness = std::exp2(1.3 * noise2(x / 55.0, y / 55.0, seed + 3));  // of sand, clay and peat
    for (double &c : look.rgb) c *= lightness;
    add_grain({seed + 2, 9.0, 0.32}, x, y, footprint_m, look.rgb);
    if (road < 0.5 && cell_draw(u, v, 33, seed) < 0.2) look.gloss = 0.04, look.sharpness = 20.0;
    return look;
}

// Plaster with windows below a roof of tiles or of glossy metal.
Look Terrain::look_of_house(uint32_t house, uint32_t face, const Vector3 &point, double footprint_m) const {
    const uint32_t seed = plan_.seed * 977u + 100u + house * 17u;
    double uv_m[2];
    place_on_box(houses_[house], face, point, uv_m);
    Look look{};
    if (face == 5) {
        const double roofs[3][3] = {{0.42, 0.14, 0.08}, {0.30, 0.31, 0.33}, {0.12, 0.12, 0.14}};
        const auto kind = static_cast<size_t>(3.0 * cell_draw(house, 0.0, 34, seed));
        const double seam = 1.0 - 0.6 * joint(uv_m[0] / 0.7, kind == 1 ? 0.5 : uv_m[1] / 0.45, 0.08, footprint_m / 0.5);
        for (int c = 0; c < 3; c++) look.rgb[c] = roofs[kind][c] * seam;
        if (kind == 1) look.gloss = 0.06, look.sharpness = 25.0;
    } else {
        cell_colour(house, 0.0, seed, 0.5, look.rgb);
        const double u = from_whole(uv_m[0] / 1.9), v = from_whole(uv_m[1] / 2.4 - 0.5);
        if (std::fabs(u) < 0.22 && std::fabs(v) < 0.25) look = {{0.05, 0.06, 0.08}, 0.08, 40.0};
    }
    add_grain({seed + face, 1.6, 0.27}, uv_m[0], uv_m[1], footprint_m, look.rgb);
    return look;
}

Look Terrain::look_of_tree(uint32_t tree, const Vector3 &point, double footprint_m) const {
    const uint32_t seed = plan_.seed * 977u + 200u;
    Look look{};
    cell_colour(tree, 0.0, seed, 1.0, look.rgb);
    const double leaves[3] = {0.085, 0.12, 0.04};
    for (int c = 0; c < 3; c++) look.rgb[c] = leaves[c] * std::sqrt(look.rgb[c]);
    add_grain({seed + 1, 1.2, 0.5}, point.x + 0.7 * point.z, point.y + 0.45 * point.z, footprint_m, look.rgb);
    return look;
}

// Up one row and down the next, with the drone ahead of its camera's view.
std::vector<Pose> Terrain::path() const {
    Random random(plan_.seed * 6364136223846793005ull + 22);
    std::vector<Pose> poses;
    for (uint32_t i = 0; i < plan_.images; i++) {
        const uint32_t row = i / survey_.columns, column = i % survey_.columns;
        const double heading = row % 2 ? -1.0 : 1.0;
        const Vector3 place = {(row - 0.5 * (survey_.rows - 1)) * survey_.aside_m + random.normal(),
                               heading * (column - 0.5 * (survey_.columns - 1)) * survey_.ahead_m + random.normal(),
                               kAltitude + random.normal()};
        const double tilt = kTilt * kPi / 180.0;
        poses.push_back(pose_towards(place, {0.0, heading * std::sin(tilt), -std::cos(tilt)},
                                     {plan_.jitter_deg * random.normal(), plan_.jitter_deg * random.normal(),
                                      plan_.jitter_deg * random.normal()}));
    }
    return poses;
}

}  // namespace

std::shared_ptr<const MovingWorld> make_terrain(const MovingPlan &plan) { return std::make_shared<Terrain>(plan); }

}  // namespace lensprof
