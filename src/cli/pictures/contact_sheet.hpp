// An overview picture: every picture before, and below it after.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/pictures/picture.hpp"

namespace lensprof {

// A small copy (box means, 8 bit RGB), gathered from a picture's rows.
class Thumbnail {
public:
    Thumbnail() = default;
    Thumbnail(uint32_t picture_width, uint32_t picture_height);

    // The picture's next rows.
    void add(const lensprof_image &rows);

    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;

private:
    void end_boxes();

    uint32_t picture_width_ = 0, picture_height_ = 0, step_ = 1, row_ = 0;
    std::vector<double> sums_;  // of the boxes that row_ is in
};

class ContactSheet {
public:
    // Before anything is put in: how many pictures there will be.
    void reserve(size_t pictures);

    // Threads: different pictures may be put in by different threads.
    void put(size_t picture, Thumbnail before, Thumbnail after);

    // PNG.
    void write(const std::string &path) const;

private:
    std::vector<Thumbnail> before_, after_;
};

}  // namespace lensprof
