// An overview picture: each picture before and, below it, after correction.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/pictures/picture.hpp"

namespace lensprof {

// A small copy (box means, 8 bit RGB), built from a picture's rows.
class Thumbnail {
public:
    Thumbnail() = default;
    Thumbnail(uint32_t picture_width, uint32_t picture_height);

    // Adds the picture's next rows.
    void add(const lensprof_image &rows);

    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;

private:
    void end_boxes();

    uint32_t picture_width_ = 0, picture_height_ = 0, step_ = 1, row_ = 0;
    std::vector<double> sums_;  // sums of the boxes of the current row_
};

class ContactSheet {
public:
    // Sets the number of pictures; call before adding any.
    void reserve(size_t pictures);

    // Threads: different threads may add different pictures.
    void put(size_t picture, Thumbnail before, Thumbnail after);

    // The sheet as PNG.
    void write(const std::string &path) const;

private:
    std::vector<Thumbnail> before_, after_;
};

}  // namespace lensprof
