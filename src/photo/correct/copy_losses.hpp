// What a correction loses: pixels that it clips, and pictures that it lifts out of the dark.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photo/correct/correction.hpp"

namespace lensprof {

// Counts the pixels at the upper limit in any channel, in every 8th row of the frame; none in float pictures.
class ClippedPixels {
public:
    // `rows`: part of the frame from row `first_row`.
    void add(const lensprof_image &rows, uint32_t first_row);
    double share() const { return pixels_ ? static_cast<double>(clipped_) / static_cast<double>(pixels_) : 0.0; }

private:
    uint64_t clipped_ = 0, pixels_ = 0;
};

// The copies of one run that are lifted by more than 2 EV, or clip more than 1 % more of their pixels than before.
class CopyLosses {
public:
    // `job` must live as long as this.
    void add(const Correction &job, double more_clipped);

    // At most two lines, each with the worst copy and the number of others.
    std::vector<std::string> warnings() const;

private:
    struct Worst {
        const Correction *job = nullptr;
        double value = 0.0;
        size_t count = 0;
        void add(const Correction &other, double of_other, double limit);
    };
    Worst lifted_, clipped_;
};

}  // namespace lensprof
