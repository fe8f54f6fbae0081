#include <algorithm>
#include <array>
#include <cmath>

#include "cli/simulate/simulate.hpp"
#include "fit/base/mixed_bits.hpp"
#include "photo/base/events.hpp"

namespace lensprof {

double Random::uniform() { return static_cast<double>(mixed_bits(state_ += splitmix_step) >> 11) * 0x1p-53; }

double Random::normal() {
    double u = uniform(), v = uniform();
    return std::sqrt(-2.0 * std::log(1.0 - u)) * std::cos(6.283185307179586 * v);
}

void irradiance_of(const Truth &truth, uint32_t index, double x, double y, const double rgb[3], double irradiance[3]) {
    const auto &camera = truth.cameras[index];
    double r2 = lensprof_vignetting_r2(&truth.vignetting[0], camera.width, camera.height, x, y, nullptr);
    for (uint32_t c = 0; c < 3; c++) {
        double m = lensprof_vignetting_eval(&truth.vignetting[truth.vignettings == 3 ? c : 0], r2, nullptr);
        irradiance[c] = rgb[c] * m * std::exp2(truth.exposures[index].ev) * truth.exposures[index].white_balance[c];
    }
}

void record(const Truth &truth, uint32_t index, double x, double y, const double rgb[3], double value[3]) {
    double irradiance[3];
    irradiance_of(truth, index, x, y, rgb, irradiance);
    for (uint32_t c = 0; c < 3; c++) value[c] = lensprof_response_eval(&truth.response, irradiance[c], nullptr);
}

void seen_radiance(const Truth &truth, const SimulatedScene &scene, uint32_t index, double x, double y, double rgb[3]) {
    double direction[2];
    rgb[0] = rgb[1] = rgb[2] = 0.0;
    if (object_radiance(truth, scene, index, x, y, rgb)) return;
    if (truth.world) {
        const double xy[2] = {x, y};
        return moving_radiance(*truth.world, truth.pinhole, truth.poses[index], xy, rgb);
    }
    if (!lensprof_camera_unproject(&truth.cameras[index], x, y, direction)) return;
    moved_direction(truth, scene, index, direction);
    scene.radiance(direction[0], direction[1], rgb);
}

namespace {

constexpr int kRings = 10;

bool well_exposed(const double value[3], double darkest) {
    double largest = std::max({value[0], value[1], value[2]});
    double smallest = std::min({value[0], value[1], value[2]});
    return largest <= 250.0 / 255.0 && smallest >= darkest;
}

struct Edge {
    uint32_t a, b;
};

// Ordered pairs of images that can overlap: the angle between their axes is below the sum of their half diagonal fields
// of view. In a large mosaic only a few pairs do.
std::vector<Edge> possible_overlaps(const std::vector<lensprof_camera> &cameras) {
    const double degree = std::acos(-1.0) / 180.0;
    std::vector<std::array<double, 3>> axes;
    std::vector<double> reach;
    for (const auto &c : cameras) {
        double yaw = c.yaw_deg * degree, pitch = c.pitch_deg * degree;
        axes.push_back({std::cos(pitch) * std::sin(yaw), std::sin(pitch), std::cos(pitch) * std::cos(yaw)});
        const double half_diagonal = lensprof_half_diagonal(c.width, c.height);
        reach.push_back(std::atan(std::tan(c.hfov_deg / 2.0 * degree) * 2.0 * half_diagonal / c.width));
    }
    std::vector<Edge> edges;
    for (uint32_t i = 0; i < cameras.size(); i++)
        for (uint32_t j = 0; j < cameras.size(); j++) {
            double cosine = axes[i][0] * axes[j][0] + axes[i][1] * axes[j][1] + axes[i][2] * axes[j][2];
            if (i != j && cosine > std::cos(std::min(reach[i] + reach[j], std::acos(-1.0)))) edges.push_back({i, j});
        }
    return edges;
}

// The source of pairs. Noise-free ones see only the scene.
struct Source {
    const Truth &truth;
    const SimulatedScene &scene;
    double darkest;
    bool noisy;
    std::vector<Edge> edges;

    bool draw(Random &random, lensprof_pair &pair, int ring[2]) const;
    void see(lensprof_pair &pair, int side, const double scene_rgb[3]) const;
};

void Source::see(lensprof_pair &pair, int side, const double scene_rgb[3]) const {
    uint32_t image = pair.image[side];
    double x = pair.xy[side][0], y = pair.xy[side][1], rgb[3];
    bool other = noisy && object_radiance(truth, scene, image, x, y, rgb);
    if (noisy && !other && !truth.positions.empty()) {
        seen_radiance(truth, scene, image, x, y, rgb);
        other = true;
    }
    record(truth, image, x, y, other ? rgb : scene_rgb, pair.value[side]);
    if (noisy && !truth.tone.empty()) map_tone(tone_gain(truth, image, x, y), pair.value[side]);
}

// One random correspondence before noise; false if no second image sees it or it is badly exposed.
bool Source::draw(Random &random, lensprof_pair &pair, int ring[2]) const {
    auto edge = edges[static_cast<size_t>(random.uniform() * static_cast<double>(edges.size()))];
    const auto &a = truth.cameras[edge.a], &b = truth.cameras[edge.b];
    double x = random.uniform(0.0, a.width - 1.0), y = random.uniform(0.0, a.height - 1.0), direction[2], xy[2], rgb[3];
    if (!lensprof_camera_unproject(&a, x, y, direction) || !lensprof_camera_project(&b, direction[0], direction[1], xy))
        return false;
    if (xy[0] < 0.0 || xy[1] < 0.0 || xy[0] > b.width - 1.0 || xy[1] > b.height - 1.0) return false;
    scene.radiance(direction[0], direction[1], rgb);
    pair = {{edge.a, edge.b}, {{x, y}, {xy[0], xy[1]}}, {}};
    const lensprof_vignetting centred{};
    for (int side = 0; side < 2; side++) {
        const auto &camera = truth.cameras[pair.image[side]];
        see(pair, side, rgb);
        if (!well_exposed(pair.value[side], darkest)) return false;
        double r2 =
            lensprof_vignetting_r2(&centred, camera.width, camera.height, pair.xy[side][0], pair.xy[side][1], nullptr);
        ring[side] = std::min(static_cast<int>(std::sqrt(r2) * kRings), kRings - 1);
    }
    return true;
}

void disturb(const Truth &truth, Random &random, uint32_t levels, lensprof_pair &pair) {
    for (auto &value : pair.value)
        for (double &v : value) v += random.normal() * truth.noise_levels / 255.0;
    if (random.uniform() < truth.outlier_share) {
        int side = random.uniform() < 0.5 ? 0 : 1;
        for (double &v : pair.value[side]) v = random.uniform();
    }
    for (auto &value : pair.value)
        for (double &v : value) v = std::round(std::clamp(v, 0.0, 1.0) * levels) / levels;
}

}  // namespace

std::vector<lensprof_pair> simulate_pairs(const Truth &truth, const SimulatedScene &scene, uint32_t count,
                                          double darkest, bool noisy, uint32_t levels) {
    Random random(truth.seed * 1000003ull + (noisy ? 1 : 2)), noise(truth.seed * 1000003ull + 3);
    std::vector<lensprof_pair> pairs;
    const Source source{truth, scene, darkest, noisy, possible_overlaps(truth.cameras)};
    if (source.edges.empty()) return pairs;
    uint32_t per_ring[kRings] = {}, share = (count + kRings - 1) / kRings;
    for (uint64_t trial = 0, max_trials = 2000ull * count + 100000; trial < max_trials && pairs.size() < count;
         trial++) {
        if (trial % (max_trials / 20) == max_trials / 20 - 1)
            share += share / 4 + 1;  // rings that cannot be filled: others get more
        if (trial % 4096 == 0) stop_if_cancelled();
        lensprof_pair pair;
        int ring[2];
        if (!source.draw(random, pair, ring)) continue;
        uint32_t &filled = per_ring[ring[0]] <= per_ring[ring[1]] ? per_ring[ring[0]] : per_ring[ring[1]];
        if (filled >= share) continue;
        filled++;
        if (noisy) disturb(truth, noise, levels, pair);
        pairs.push_back(pair);
    }
    return pairs;
}

}  // namespace lensprof
