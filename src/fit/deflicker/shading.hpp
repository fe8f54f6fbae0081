// What differs between frames beyond a common factor: lines, and the falloff.
#pragma once

#include <array>
#include <vector>

#include "fit/deflicker/ratio.hpp"

namespace lensprof {

class FrameChain;

// EV of each row of cells beyond the ratio of the frames; 0 for rows without enough cells.
std::vector<float> row_ratios(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                              const FrameRatio &ratio);

// The frame without these factors of its rows.
FrameCells without_rows(const FrameGrid &grid, FrameCells cells, const std::vector<float> &rows);

// q1, q2 of the factor exp2(q1 r^2 + q2 r^4) between the frames, r in half diagonals of the frame.
std::array<double, 2> falloff_ratio(const FrameGrid &grid, const FrameCells &before, const FrameCells &after,
                                    const FrameRatio &ratio);

// Attenuation of every frame over the frame; an empty grid where nothing was measured.
class FrameShadings {
public:
    explicit FrameShadings(const FrameChain &chain);

    lensprof_gain_grid of(size_t frame) const;

private:
    struct Aperture {
        double f_number;
        std::array<double, 2> q;  // relative to the aperture of most frames
    };

    std::array<double, 2> falloff_at(double f_number) const;

    const FrameChain &chain_;
    std::vector<Aperture> apertures_;
    std::vector<std::vector<float>> rows_;  // per frame, EV; empty: none
};

}  // namespace lensprof
