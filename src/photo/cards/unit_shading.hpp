// The shading of units of one type: of each at places of the frame, and what all have in common.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "photo/cards/lens_cards.hpp"

namespace lensprof {

// Places of a frame of a shape: with the corners, or in the middles of equal cells.
struct Lattice {
    double aspect;  // width over height
    uint32_t columns, rows;
    bool of_cells;

    static constexpr double longer_side = 4000.0;  // px; so many that the outermost pixels are in the corners

    uint32_t width() const;
    uint32_t height() const;
    uint32_t size() const { return columns * rows; }
    std::array<double, 2> place(uint32_t index) const;  // px of the frame
    std::array<uint32_t, 4> corners() const { return {0, columns - 1, size() - columns, size() - 1}; }
};

// A lattice whose cells are nearly squares.
Lattice lattice_of(double aspect, uint32_t longer_count, bool of_cells);

// The light at each place of a lattice relative to the middle of the frame, which is not the centre of the falloff;
// NAN outside of an image circle. Three channels, of which all are alike for one curve.
struct Shading {
    std::array<std::vector<double>, 3> light, sigma;  // sigma: standard error, relative; NAN: unknown
};

Shading shading_of(const lensprof_profile &profile, const Lattice &lattice);

bool has_colours(const lensprof_profile &profile);

// Median and standard deviation by 1.4826 times the median of the deviations, of the values that are finite; NAN if
// fewer than half of them are.
struct Middle {
    double median, scatter;
    double sigma;  // standard error of the median: 1.2533 scatter / sqrt(n), exact for a normal distribution
};
Middle middle_of(std::vector<double> values);

// The profile of the type: see the comment on the definition.
std::shared_ptr<lensprof_profile> mean_profile(const std::vector<const CardFit *> &units, double aspect);

}  // namespace lensprof
