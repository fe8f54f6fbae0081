// What a correction loses: pixels that it clips, pictures that it lifts out of the dark, and offsets that no profile
// holds.
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

// Whether a correction lacks the offset of counts in float samples: the levels of a profile are shares of full scale,
// and no profile holds that of fields in counts.
bool lacks_offset_of_counts(const Correction &job);

// Whether a float sample exceeds 1: it is a count.
bool has_samples_above_one(const lensprof_image &rows);

// The copies of one run that are lifted by more than 2 EV, or clip more than 1 % more of their pixels than before.
class CopyLosses {
public:
    // `job` must live as long as this. `keeps_offset`: it has counts in float samples, and its model no offset.
    void add(const Correction &job, double more_clipped, bool keeps_offset = false);

    // At most three lines, each with the worst copy and the number of others.
    std::vector<std::string> warnings() const;

private:
    struct Worst {
        const Correction *job = nullptr;
        double value = 0.0;
        size_t count = 0;
        void add(const Correction &other, double of_other, double limit);
    };
    Worst lifted_, clipped_, offset_;
};

}  // namespace lensprof
