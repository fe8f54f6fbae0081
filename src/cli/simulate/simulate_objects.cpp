// Moving objects: blocks in one picture only, with radiances of their own.
#include <algorithm>
#include <cmath>

#include "cli/simulate/simulate.hpp"

namespace lensprof {
namespace {

constexpr int kGrid = 128;  // points per side for measuring the covered share

Block random_block(const lensprof_camera &camera, Random &random) {
    Block block;
    double width = camera.width * random.uniform(0.05, 0.25), height = camera.height * random.uniform(0.05, 0.25);
    double x = random.uniform(0.0, camera.width), y = random.uniform(0.0, camera.height);
    block.left = x - width / 2.0, block.right = x + width / 2.0;
    block.top = y - height / 2.0, block.bottom = y + height / 2.0;
    double brightness = std::exp(random.uniform(-4.5, 0.0));
    for (double &v : block.rgb) v = brightness * std::exp(random.uniform(-0.45, 0.45));
    block.texture = random.uniform() < 0.5 ? 0.9 : 0.0;
    block.depth = random.uniform(0.0, 1000.0);
    return block;
}

// Marks the grid points inside a block; returns the number marked so far.
int mark(const lensprof_camera &camera, const Block &block, std::vector<char> &covered) {
    for (int j = 0; j < kGrid; j++)
        for (int i = 0; i < kGrid; i++)
            if (block.contains((i + 0.5) / kGrid * camera.width, (j + 0.5) / kGrid * camera.height))
                covered[static_cast<size_t>(j * kGrid + i)] = 1;
    return static_cast<int>(std::count(covered.begin(), covered.end(), 1));
}

}  // namespace

std::vector<Block> random_blocks(const lensprof_camera &camera, double share, Random &random) {
    std::vector<Block> blocks;
    std::vector<char> covered(kGrid * kGrid);
    const double target = share * kGrid * kGrid;
    for (int previous = 0, covered_points = 0; covered_points < target; previous = covered_points) {
        Block block = random_block(camera, random);
        covered_points = mark(camera, block, covered);
        // The last block is kept if the share is then closer to the requested one: on average exactly that share is
        // covered.
        if (covered_points < target || covered_points - target < target - previous) blocks.push_back(block);
    }
    return blocks;
}

bool object_radiance(const Truth &truth, const SimulatedScene &scene, uint32_t index, double x, double y,
                     double rgb[3]) {
    if (truth.objects.empty()) return false;
    const auto &camera = truth.cameras[index];
    const auto &blocks = truth.objects[index];
    auto found = std::find_if(blocks.rbegin(), blocks.rend(), [&](const Block &b) { return b.contains(x, y); });
    if (found == blocks.rend()) return false;
    const double scale = 1.0 / lensprof_half_diagonal(camera.width, camera.height),
                 p[3] = {x * scale, y * scale, found->depth};
    double factor = found->texture > 0.0 ? std::exp(found->texture * scene.fractal(p, 25.0, 3)) : 1.0;
    for (int c = 0; c < 3; c++) rgb[c] = found->rgb[c] * factor;
    return true;
}

}  // namespace lensprof
