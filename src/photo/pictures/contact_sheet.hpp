// An overview picture: each picture before and, below it, after correction, with its name.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

class ContactSheet {
public:
    // Few pictures get large cells: a sheet of up to 400 pictures is at most 1950 pixels wide.
    explicit ContactSheet(size_t pictures);
    static constexpr size_t most_pictures = 20000;

    // The longer side of the small pictures that put() takes, in pixels.
    uint32_t side() const { return side_; }

    struct Cell {
        Picture before, after;   // 8 bit RGB without gaps; empty pictures leave their place empty
        std::string name, note;  // two lines above them; the middle of a line wider than the cell is omitted
    };

    // Threads: different threads may put different pictures.
    void put(size_t picture, Cell cell) { cells_[picture] = std::move(cell); }

    // Writes the sheet as its name states.
    void write(const std::string &path) const;

private:
    uint32_t columns_, side_;
    std::vector<Cell> cells_;
};

}  // namespace lensprof
