// Frames one after another: which are compared, and the exposures that fit all ratios.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <lensprof/deflicker.h>

#include "fit/base/chained.hpp"
#include "fit/deflicker/ratio.hpp"

namespace lensprof {

// A frame as the chain keeps it.
struct ChainFrame {
    uint32_t state = 0, segment = 0, repeats = 0;
    double seconds = 0, settings_ev = 0, f_number = 0;
    double white_share = 0, dark_share = 0;
    double sigma = 0, agreeing = 0, motion = 0;  // relative to the frame before it; cells
    CellShift shift{};                           // since the first frame of its segment, cells
    std::array<double, 3> ev{};                  // per channel, relative to the first frame of its segment
    std::vector<float> rows{};                   // EV of each row of cells beyond it, summed from frame to frame
};

// How the falloff changed between two neighbouring frames of different apertures: exp2(q1 r^2 + q2 r^4).
struct FalloffStep {
    double from, to;  // f-numbers
    std::array<double, 2> q;
};

// Ratios of tones, which a wrong response makes differ.
struct ToneSums {
    static constexpr size_t kBins = 8;
    double weight[kBins] = {}, error[kBins] = {};

    double error_rms() const;
};

// Takes frames in order, and keeps the cells of a few of them.
class FrameChain {
public:
    FrameChain(const FrameGrid &grid, bool has_rows) : grid_(grid), has_rows_(has_rows) {}

    void add(FrameCells cells, const lensprof_deflicker_facts &facts);

    // Sets the exposures of all frames.
    void solve();

    const std::vector<ChainFrame> &frames() const { return frames_; }
    const FrameGrid &grid() const { return grid_; }
    const std::vector<FalloffStep> &falloff_steps() const { return falloff_steps_; }
    double tone_error() const { return tones_.error_rms(); }

private:
    struct Kept {
        uint32_t frame;
        FrameCells cells;
    };

    bool join(uint32_t frame, const FrameCells &cells);  // to the current segment
    void start_segment(Kept first);
    void append(uint32_t frame, FrameCells cells);
    void link_over(size_t level, uint32_t frame, const FrameCells &cells);
    void note_agreement(size_t level, const FrameCells &cells, const FrameRatio &ratio);
    const std::vector<float> &steadiness(size_t level);
    void note_tones(const FrameCells &cells, const FrameRatio &ratio);

    void note_falloff(const FrameCells &cells, const FrameRatio &ratio, const ChainFrame &frame);

    FrameGrid grid_;
    bool has_rows_;
    std::vector<ChainFrame> frames_;
    std::vector<ChainRatio> links_;
    std::vector<Kept> kept_;  // the last frame, then the last whose number in the segment is a multiple of 4, 16, ...
    std::vector<Kept> waiting_;  // frames that did not agree with the last one
    struct Agreement {
        std::vector<float> agreed;  // decaying count per cell of the ratios that it agreed with
        float ratios = 0.0f;        // of all ratios
    };
    std::vector<Agreement> agreement_;  // per level
    std::vector<float> steadiness_;
    uint32_t segment_frames_ = 0, segment_ = 0;
    ToneSums tones_;
    std::vector<FalloffStep> falloff_steps_;
};

}  // namespace lensprof
