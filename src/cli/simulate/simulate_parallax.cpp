// A camera that moves between pictures: near objects shift against far ones.
#include <cmath>

#include "cli/simulate/simulate.hpp"

namespace lensprof {

// Uniform within a circle: between two pictures the nearest objects shift by at most `parallax` px.
void move_cameras(double parallax, Random &random, Truth &truth) {
    truth.parallax = parallax;
    for (size_t i = 0; i < truth.cameras.size(); i++) {
        const double turn = random.uniform(0.0, 2.0 * std::acos(-1.0));
        const double distance = 0.5 * parallax * std::sqrt(random.uniform());
        truth.positions.push_back({distance * std::cos(turn), distance * std::sin(turn)});
    }
}

// The scene consists of layers of one nearness each: takes the first, from near to far, with an object at the shifted
// position.
void moved_direction(const Truth &truth, const SimulatedScene &scene, uint32_t index, double direction[2]) {
    if (truth.positions.empty()) return;
    const auto &camera = truth.cameras[index];
    const double radians_per_px = camera.hfov_deg / camera.width * std::acos(-1.0) / 180.0;
    for (int layer = SimulatedScene::kLayers - 1; layer > 0; layer--) {
        const double nearness = static_cast<double>(layer) / (SimulatedScene::kLayers - 1);
        double moved[2];
        for (int k = 0; k < 2; k++)
            moved[k] = direction[k] - nearness * truth.positions[index][static_cast<size_t>(k)] * radians_per_px;
        if (scene.nearness(moved[0], moved[1]) != nearness) continue;
        direction[0] = moved[0], direction[1] = moved[1];
        return;
    }
}

}  // namespace lensprof
