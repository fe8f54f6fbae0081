// The ratio of two frames of one scene, from the cells that did not change.
#pragma once

#include <array>
#include <vector>

#include "fit/deflicker/cells.hpp"

namespace lensprof {

using CellShift = std::array<double, 2>;  // of the scene, right and down, cells

// log2 of the irradiance of a frame relative to an earlier one.
struct FrameRatio {
    std::array<double, 3> ev{};  // per channel
    double sigma = 0.0;          // standard error, EV
    double spread = 0.0;         // of the cells that agree, EV
    double agreeing = 0.0;       // share of the cells that both frames show
    double common = 0.0;         // share of all cells that both frames show
    CellShift shift{};

    bool is_valid() const;
};

// `steadiness`: weight per cell, or empty.
FrameRatio compare_frames(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                          const std::vector<float> &steadiness, const CellShift &shift);

// Searches for the shift from a first guess.
FrameRatio register_frames(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                           const std::vector<float> &steadiness, const CellShift &guess);

// The logarithm of a frame's cell at a position, bilinear; NaN beyond the frame and next to cells without information.
float cell_at(const FrameGrid &grid, const std::vector<float> &cells, double column, double row);

// Which channel determines the ratio: green, or grey.
inline uint32_t main_channel(const FrameGrid &grid) { return grid.channels == 3 ? 1 : 0; }

constexpr size_t kFewestCells = 24;  // of a ratio
constexpr double kAgreement = 0.06;  // EV, largest residual of a cell that agrees

}  // namespace lensprof
