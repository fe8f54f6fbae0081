#include "photo/pictures/row_reducer.hpp"

#include <algorithm>
#include <cstring>

#include "photo/pictures/codec.hpp"

namespace lensprof {

namespace codec {

namespace {

// For every 2 x 2 block in two rows of `row_samples` each, the mean of the middle two values; written to the start of
// the upper row. Values that are not finite stay so.
template <class Sample, class Sum>
void reduce_blocks(uint8_t *rows, size_t row_samples, size_t pixel, size_t count) {
    Sample *to = reinterpret_cast<Sample *>(rows);
    const Sample *upper = to, *lower = to + row_samples;
    const Sum half = std::is_floating_point<Sum>::value ? Sum(0) : Sum(1);
    for (size_t i = 0; i < count; ++i, upper += 2 * pixel, lower += 2 * pixel)
        for (size_t c = 0; c < pixel; ++c) {
            const Sample v[4] = {upper[c], upper[c + pixel], lower[c], lower[c + pixel]};
            const Sum least = std::min(std::min(v[0], v[1]), std::min(v[2], v[3]));
            const Sum largest = std::max(std::max(v[0], v[1]), std::max(v[2], v[3]));
            *to++ = static_cast<Sample>((Sum(v[0]) + v[1] + v[2] + v[3] - least - largest + half) / 2);
        }
}

// Index below `count` for a fraction of 2^32.
uint32_t place(uint32_t fraction, uint32_t count) { return static_cast<uint32_t>(uint64_t(fraction) * count >> 32); }

}  // namespace

RowReducer::RowReducer(Picture &picture, uint32_t source_width, uint32_t done)
    : picture_(picture),
      halves_(picture.reduction > 1 && done == 1),
      blocks_(std::max(picture.reduction / 2, 1u)),
      pixel_bytes_(static_cast<size_t>(pixel_bytes(picture))),
      scratch_row_(source_width * pixel_bytes_),
      direct_(!halves_ && blocks_ == 1 && source_width == picture.width) {
    picture_.pixels.clear();
    picture_.pixels.reserve(picture_.row_bytes * picture_.height);
    if (direct_) return;
    scratch_.resize(scratch_row_ * (halves_ ? 2 : 1));
    picks_.resize(blocks_);
}

uint8_t *RowReducer::row() {
    if (!direct_) return scratch_.data() + (lower_ ? scratch_row_ : 0);
    picture_.pixels.resize((emitted_ + size_t(1)) * picture_.row_bytes);
    return picture_.pixels.data() + emitted_ * picture_.row_bytes;
}

void RowReducer::accept() {
    if (emitted_ == picture_.height) return;
    if (direct_) {
        ++emitted_;
        return;
    }
    if (halves_) {
        lower_ = !lower_;
        if (lower_) return;
        halve_rows();
    }
    pick_from_row();
}

void RowReducer::halve_rows() {
    const size_t pixel = lensprof_layout_samples(picture_.layout), count = size_t(picture_.width) * blocks_;
    const size_t row_samples = scratch_row_ / lensprof_sample_type_bytes(picture_.sample);
    if (picture_.sample == LENSPROF_SAMPLE_U8)
        reduce_blocks<uint8_t, int32_t>(scratch_.data(), row_samples, pixel, count);
    else if (picture_.sample == LENSPROF_SAMPLE_U16)
        reduce_blocks<uint16_t, int32_t>(scratch_.data(), row_samples, pixel, count);
    else
        reduce_blocks<float, double>(scratch_.data(), row_samples, pixel, count);
}

// Multiples of the generalised golden ratio of the plane (Roberts' R2 sequence) and of the golden ratio, as fractions
// of 2^32, select the block, so that the blocks of any few neighbouring pixels are spread evenly about the centres of
// their squares.
void RowReducer::choose_blocks() {
    for (auto &picks : picks_) picks.clear();
    for (uint32_t x = 0; x < picture_.width; ++x) {
        const uint32_t down = place(0xc13fa9a9u * x + 0x91e10da6u * emitted_, blocks_);
        picks_[down].push_back({x, x * blocks_ + place(0x9e3779b9u * x + 0x80000000u * emitted_, blocks_)});
    }
}

void RowReducer::pick_from_row() {
    if (block_row_ == 0) {
        picture_.pixels.resize((emitted_ + size_t(1)) * picture_.row_bytes);
        choose_blocks();
    }
    uint8_t *to = picture_.pixels.data() + emitted_ * picture_.row_bytes;
    const uint8_t *from = scratch_.data();
    for (const Pick &pick : picks_[block_row_]) {
        if (pixel_bytes_ == 3)  // the usual size, known at compile time
            std::memcpy(to + pick.x * size_t(3), from + pick.column * size_t(3), 3);
        else
            std::memcpy(to + pick.x * pixel_bytes_, from + pick.column * pixel_bytes_, pixel_bytes_);
    }
    if (++block_row_ == blocks_) {
        block_row_ = 0;
        ++emitted_;
    }
}

}  // namespace codec

}  // namespace lensprof
