// What the coding of a video loses.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photo/video/video.hpp"

namespace lensprof {

// Some rows of a frame.
struct SampledRows {
    uint64_t number;  // of the frame
    uint32_t sample;
    std::vector<uint8_t> bytes;

    size_t count() const { return bytes.size() / (sample == LENSPROF_SAMPLE_U16 ? 2 : 1); }
};

// Some frames as they were written, to compare with those that the finished video shows.
class CodingLoss {
public:
    // `frames`: about how many there are in all.
    void add(const VideoFrame &frame, size_t frames);

    // Mean absolute differences, levels of 255: over all of the frames, and over that which differs most.
    struct Differences {
        double mean = 0.0, largest = 0.0;
    };
    // Decodes the file, which `path` names in messages. Failure (failed) if it has not the frames that were added.
    Differences measured(const std::string &file, const std::string &path) const;

private:
    std::vector<SampledRows> sampled_;
    uint64_t frames_ = 0;
};

}  // namespace lensprof
