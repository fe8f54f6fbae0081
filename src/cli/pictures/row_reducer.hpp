// A picture gathered from its rows, reduced as ReadOptions says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cli/pictures/picture.hpp"

namespace lensprof {

namespace codec {

// Takes a picture row by row from the top and keeps it in picture.pixels, reduced as ReadOptions says. The rows may
// already be halved in both directions (`done` = 2). Memory grows with the rows, so that a damaged header does not
// claim it.
class RowReducer {
public:
    RowReducer(Picture &picture, uint32_t source_width, uint32_t done = 1);

    uint8_t *row();  // where the next row of the source is to be put, source_width pixels
    void accept();   // it is there

private:
    struct Pick {
        uint32_t x, column;  // pixel of the picture, block that it takes
    };

    void halve_rows();
    void choose_blocks();
    void pick_from_row();

    Picture &picture_;
    bool halves_;      // blocks of 2 x 2 pixels become one here
    uint32_t blocks_;  // along the side of a held pixel's square
    size_t pixel_bytes_, scratch_row_;
    bool direct_;             // rows are put straight into the picture
    bool lower_ = false;      // the next row is the lower one of blocks
    uint32_t block_row_ = 0;  // rows of blocks since the last row of the picture
    uint32_t emitted_ = 0;    // rows of the picture
    std::vector<uint8_t> scratch_;
    std::vector<std::vector<Pick>> picks_;  // of the picture's next row, for every row of blocks
};

}  // namespace codec

}  // namespace lensprof
