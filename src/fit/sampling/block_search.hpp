// The similarity of a block with all blocks around a place.
#pragma once

#include <array>
#include <vector>

#include "fit/sampling/blocks.hpp"

namespace lensprof {

// Shifts of whole level pixels: from middle - reach to middle + reach across and down, `step` apart, row by row.
struct Shifts {
    std::array<int, 2> middle;
    int reach, step;  // reach is a multiple of step

    size_t side() const { return static_cast<size_t>(2 * reach / step + 1); }
    size_t count() const { return side() * side(); }
    std::array<int, 2> at(size_t number) const {
        return {middle[0] - reach + static_cast<int>(number % side()) * step,
                middle[1] - reach + static_cast<int>(number / side()) * step};
    }
};

constexpr double kOutside = -2.0;  // instead of the correlation with a block that is not entirely within the frame

// Correlations of `block` with the blocks (as by cut_flat) at every shift from the place and with the map of `sight`.
// `pixel`: of the block's level.
std::vector<double> correlations_around(const Block<4> &block, const GreyLevels::Level &level, const Sight &sight,
                                        double pixel, const Shifts &shifts);

}  // namespace lensprof
