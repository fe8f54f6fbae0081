// The gain grid: what k1..k3 leave of the falloff and of the light, by least squares on bilinear nodes. A node is the
// model's falloff over k1..k3 at its place, times a factor that a smoothness term keeps even.
#include <algorithm>
#include <cmath>

#include <Eigen/SparseCholesky>

#include "core/gain_grid.h"
#include "fit/flat/fit.hpp"

namespace lensprof {
namespace {

constexpr int kNodes = 24;               // along the longer side
constexpr int kFineNodes = 32;           // where it carries a part of the falloff
constexpr int kCellsPerNode = 3;         // at least
constexpr double kSmallestNoise = 2e-3;  // of a cell's light: error not included in its noise
constexpr double kStiffness = 0.02;      // of second differences, relative to the weight of a node's cells
constexpr double kRidge = 1e-6;          // pull to 1, on the same scale: for nodes that no cell reaches
constexpr double kMostLeft = 500.0;      // of M over k1..k3: within what a grid can hold, residual included
constexpr double kSmallestCover = 0.8;   // of the frame's cells

using Entries = std::vector<Eigen::Triplet<double>>;

// Nodes around a place and their weights.
struct Bilinear {
    int node[4];
    double share[4];
};

// The weights with which lensprof_gain_grid_eval interpolates the nodes around a cell.
Bilinear bilinear(const lensprof_gain_grid &gain, const CellGrid &grid, const FlatCell &cell) {
    const lp_grid_cell column = lp_grid_cell_at(cell.x, grid.width, gain.columns);
    const lp_grid_cell row = lp_grid_cell_at(cell.y, grid.height, gain.rows);
    const double u = column.fraction, v = row.fraction;
    const int columns = static_cast<int>(gain.columns),
              first = static_cast<int>(row.node) * columns + static_cast<int>(column.node);
    return {{first, first + 1, first + columns, first + columns + 1},
            {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

// Adds the squared second differences of nodes in one direction.
void add_stiffness(const lensprof_gain_grid &gain, bool across, double weight, Entries &entries) {
    const int columns = static_cast<int>(gain.columns), rows = static_cast<int>(gain.rows);
    const int step = across ? 1 : columns;
    for (int row = across ? 0 : 1; row < (across ? rows : rows - 1); row++)
        for (int column = across ? 1 : 0; column < (across ? columns - 1 : columns); column++) {
            const int middle = row * columns + column, node[3] = {middle - step, middle, middle + step};
            const double coefficient[3] = {1.0, -2.0, 1.0};
            for (int a = 0; a < 3; a++)
                for (int b = 0; b < 3; b++)
                    entries.emplace_back(node[a], node[b], weight * coefficient[a] * coefficient[b]);
        }
}

// The model's falloff over k1..k3 at every node.
void set_falloff_left(const FlatFit &fit, int channel, lensprof_gain_grid &gain) {
    const uint32_t nodes = gain.columns * gain.rows;
    for (uint32_t i = 0; i < nodes; i++) {
        const double x = (i % gain.columns) * (fit.grid.width - 1.0) / (gain.columns - 1.0);
        const double y = (i / gain.columns) * (fit.grid.height - 1.0) / (gain.rows - 1.0);
        const double left = std::clamp(1.0 / held_ratio(fit, channel, x, y), 1.0 / kMostLeft, kMostLeft);
        gain.attenuation[static_cast<uint32_t>(channel) * nodes + i] = static_cast<float>(left);
    }
}

// Between nodes that are exact, a straight line lies above what curves up: lowers the nodes that have others around
// them until the errors of the cells about them have the mean 0. The error of a cell's middle is 3/2 of its mean.
void balance(const FlatFit &fit, int channel, lensprof_gain_grid &gain) {
    const lensprof_gain_grid exact = gain;
    const auto c = static_cast<uint32_t>(channel);
    const uint32_t width = fit.grid.width, height = fit.grid.height;
    const double across = (width - 1.0) / (gain.columns - 1.0), down = (height - 1.0) / (gain.rows - 1.0);
    for (uint32_t row = 1; row + 1 < gain.rows; row++)
        for (uint32_t column = 1; column + 1 < gain.columns; column++) {
            double error = 0.0;
            for (uint32_t corner = 0; corner < 4; corner++) {
                const double x = (column - 0.5 + (corner & 1)) * across, y = (row - 0.5 + (corner >> 1)) * down;
                error += lensprof_gain_grid_eval(&exact, width, height, x, y, c) * held_ratio(fit, channel, x, y) - 1.0;
            }
            gain.attenuation[(c * gain.rows + row) * gain.columns + column] /= static_cast<float>(1.0 + error / 6.0);
        }
}

// Multiplies the nodes by the residual of the light.
bool fit_channel(const FlatFit &fit, int channel, lensprof_gain_grid &gain) {
    const auto nodes = static_cast<Eigen::Index>(gain.columns * gain.rows);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(nodes);
    Entries entries;
    const FlatLight light(fit.problem.model, fit.estimate.u);
    double total = 0.0;
    for (const FlatCell &cell : fit.problem.cells) {
        const double p = light.at(cell.shot, cell.x, cell.y)[static_cast<size_t>(channel)];
        double weight = 1.0 / (cell.variance[static_cast<size_t>(channel)] / (p * p) + kSmallestNoise * kSmallestNoise);
        Bilinear weights = bilinear(gain, fit.grid, cell);
        total += weight;
        for (int a = 0; a < 4; a++) {
            right[weights.node[a]] += weight * weights.share[a] * (cell.value[static_cast<size_t>(channel)] / p);
            for (int b = 0; b < 4; b++)
                entries.emplace_back(weights.node[a], weights.node[b], weight * weights.share[a] * weights.share[b]);
        }
    }
    double typical = total / static_cast<double>(nodes);
    add_stiffness(gain, true, kStiffness * typical, entries);
    add_stiffness(gain, false, kStiffness * typical, entries);
    for (Eigen::Index i = 0; i < nodes; i++) {
        entries.emplace_back(i, i, kRidge * typical);
        right[i] += kRidge * typical;
    }
    Eigen::SparseMatrix<double> normal(nodes, nodes);
    normal.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
    if (factor.info() != Eigen::Success) return false;
    const Eigen::VectorXd value = factor.solve(right);
    for (Eigen::Index i = 0; i < nodes; i++) gain.attenuation[channel * nodes + i] *= static_cast<float>(value[i]);
    return value.allFinite() && value.minCoeff() > 0.0;
}

}  // namespace

bool fit_gain_grid(const FlatFit &fit, bool residual, lensprof_gain_grid &gain) {
    std::vector<bool> covered(static_cast<size_t>(fit.grid.count()));
    for (const FlatCell &cell : fit.problem.cells) covered[static_cast<size_t>(cell.cell)] = true;
    lensprof_gain_grid_init(&gain);
    if (static_cast<double>(std::count(covered.begin(), covered.end(), true))
        < kSmallestCover * (1.0 - fit.edge.share) * fit.grid.count())
        return false;
    const int longer = std::max(fit.grid.columns, fit.grid.rows);
    const double nodes = fit.held.is_whole ? std::max(2, std::min(kNodes, longer / kCellsPerNode)) : kFineNodes;
    auto side = [&](int cells) { return static_cast<uint32_t>(std::max(2L, std::lround(nodes * cells / longer))); };
    gain.columns = side(fit.grid.columns);
    gain.rows = side(fit.grid.rows);
    gain.channels = fit.problem.model.channels == 3 ? 3 : 1;
    bool good = true;
    for (int c = 0; c < fit.problem.model.channels; c++) {
        set_falloff_left(fit, c, gain);
        if (!fit.held.is_whole) balance(fit, c, gain);
        good = good && (!residual || fit_channel(fit, c, gain));
    }
    good = good && lensprof_gain_grid_validate(&gain) == LENSPROF_OK;
    if (!good) lensprof_gain_grid_init(&gain);
    return good;
}

void normalise_gain_grid(const FlatFit &fit, lensprof_gain_grid &gain) {
    const lensprof_vignetting &v = fit.held.curve[0];
    double half = lensprof_half_diagonal(fit.grid.width, fit.grid.height);
    double x = 0.5 * (fit.grid.width - 1.0) + half * v.center[0];
    double y = 0.5 * (fit.grid.height - 1.0) + half * v.center[1];
    for (uint32_t c = 0; c < gain.channels; c++) {
        float *node = gain.attenuation + c * gain.rows * gain.columns;
        auto at_center = static_cast<float>(lensprof_gain_grid_eval(&gain, fit.grid.width, fit.grid.height, x, y, c));
        for (uint32_t i = 0; i < gain.rows * gain.columns; i++) node[i] /= at_center;
    }
}

}  // namespace lensprof
