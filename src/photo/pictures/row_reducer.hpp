// Builds a picture from its rows, reduced according to ReadOptions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "photo/pictures/picture.hpp"

namespace lensprof {

namespace codec {

// Takes a picture row by row from the top and stores it in picture.pixels, reduced according to ReadOptions. The rows
// may already be halved in both directions (`done` = 2). Memory grows with the rows, so that a damaged header cannot
// claim it.
class RowReducer {
public:
    RowReducer(Picture &picture, uint32_t source_width, uint32_t done = 1);

    uint8_t *row();  // buffer for the next source row, source_width pixels
    void accept();   // the buffer is filled

private:
    struct Pick {
        uint32_t x, column;  // picture pixel and the block it uses
    };

    void halve_rows();
    void choose_blocks();
    void pick_from_row();

    Picture &picture_;
    bool halves_;      // 2 x 2 blocks are averaged here
    uint32_t blocks_;  // along the side of a stored pixel's square
    size_t pixel_bytes_, scratch_row_;
    bool direct_;             // rows are written directly into the picture
    bool lower_ = false;      // the next row is the lower one of blocks
    uint32_t block_row_ = 0;  // rows of blocks since the last row of the picture
    uint32_t emitted_ = 0;    // rows of the picture
    std::vector<uint8_t> scratch_;
    std::vector<std::vector<Pick>> picks_;  // for the picture's next row, per row of blocks
};

}  // namespace codec

}  // namespace lensprof
