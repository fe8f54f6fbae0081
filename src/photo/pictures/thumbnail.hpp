// Small copies of pictures, rotated as EXIF's orientation states.
#pragma once

#include <cstdint>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

// A small copy, built from a picture's rows: means over boxes of pixels, of the stored values.
class Thumbnail {
public:
    Thumbnail() = default;
    // Its longer side has at most `side` pixels, and no more than the picture's.
    Thumbnail(uint32_t picture_width, uint32_t picture_height, uint32_t side);

    // Adds the picture's next rows, of any sample type and layout.
    void add(const lensprof_image &rows);

    // 8 bit RGB without gaps, rotated as EXIF's orientation states.
    Picture upright(uint16_t orientation) const;

private:
    void end_boxes();

    uint32_t width_ = 0, height_ = 0, picture_height_ = 0, next_row_ = 0;
    std::vector<uint32_t> edges_;  // first column of each box, and the picture's width
    std::vector<double> sums_;     // sums of the boxes of the current row
    std::vector<uint8_t> rgb_;
};

// A small copy of a picture.
Picture upright_copy(const Picture &stored, uint16_t orientation, uint32_t side);

}  // namespace lensprof
