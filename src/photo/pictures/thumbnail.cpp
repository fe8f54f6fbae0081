#include "photo/pictures/thumbnail.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lensprof {
namespace {

double full_scale(uint8_t) { return 255.0; }
double full_scale(uint16_t) { return 65535.0; }
double full_scale(float) { return 1.0; }

// Adds the samples of a row to the sums of the boxes between `edges`.
template <class Sample>
void add_row(const Sample *row, uint32_t layout, const std::vector<uint32_t> &edges, std::vector<double> &sums) {
    const uint32_t samples = lensprof_layout_samples(layout), next = lensprof_layout_channels(layout) == 1 ? 0 : 1;
    for (size_t box = 0; box + 1 < edges.size(); box++) {
        double *sum = &sums[box * 3];
        const Sample *end = row + size_t(edges[box + 1]) * samples;
        for (const Sample *p = row + size_t(edges[box]) * samples; p < end; p += samples)
            for (uint32_t c = 0; c < 3; c++) sum[c] += p[c * next] / full_scale(Sample());
    }
}

// The first row or column of a box of a copy with `count` boxes along `length` pixels.
uint32_t edge_of(uint32_t box, uint32_t length, uint32_t count) {
    return static_cast<uint32_t>(uint64_t(box) * length / count);
}

// EXIF's orientation: where the pixel (x, y) of the upright picture is in the stored one of w x h.
std::pair<uint32_t, uint32_t> stored_place(uint16_t orientation, uint32_t w, uint32_t h, uint32_t x, uint32_t y) {
    switch (orientation) {
    case 2: return {w - 1 - x, y};
    case 3: return {w - 1 - x, h - 1 - y};
    case 4: return {x, h - 1 - y};
    case 5: return {y, x};
    case 6: return {y, h - 1 - x};
    case 7: return {w - 1 - y, h - 1 - x};
    case 8: return {w - 1 - y, x};
    default: return {x, y};
    }
}

}  // namespace

Thumbnail::Thumbnail(uint32_t picture_width, uint32_t picture_height, uint32_t side) : picture_height_(picture_height) {
    const uint32_t longer = std::max(picture_width, picture_height);
    const auto reduced = [=](uint32_t length) {
        return longer <= side ? length : std::max(1u, static_cast<uint32_t>(uint64_t(length) * side / longer));
    };
    width_ = reduced(picture_width), height_ = reduced(picture_height);
    for (uint32_t box = 0; box <= width_; box++) edges_.push_back(edge_of(box, picture_width, width_));
    rgb_.reserve(static_cast<size_t>(width_) * height_ * 3);
    sums_.assign(static_cast<size_t>(width_) * 3, 0.0);
}

void Thumbnail::add(const lensprof_image &rows) {
    for (uint32_t y = 0; y < rows.height; y++) {
        const auto *row = static_cast<const uint8_t *>(rows.data) + static_cast<ptrdiff_t>(y) * rows.row_bytes;
        if (rows.sample == LENSPROF_SAMPLE_U8)
            add_row(row, rows.layout, edges_, sums_);
        else if (rows.sample == LENSPROF_SAMPLE_U16)
            add_row(reinterpret_cast<const uint16_t *>(row), rows.layout, edges_, sums_);
        else
            add_row(reinterpret_cast<const float *>(row), rows.layout, edges_, sums_);
        next_row_++;
        const auto done = static_cast<uint32_t>(rgb_.size() / 3 / std::max(width_, 1u));
        if (next_row_ == edge_of(done + 1, picture_height_, height_)) end_boxes();
    }
}

void Thumbnail::end_boxes() {
    const auto row = static_cast<uint32_t>(rgb_.size() / 3 / width_);
    const uint32_t rows = next_row_ - edge_of(row, picture_height_, height_);
    for (uint32_t x = 0; x < width_; x++)
        for (uint32_t c = 0; c < 3; c++) {
            const double count = static_cast<double>(rows) * (edges_[x + 1] - edges_[x]);
            const double mean = std::clamp(sums_[size_t(x) * 3 + c] / count, 0.0, 1.0);
            rgb_.push_back(static_cast<uint8_t>(std::lround(mean * 255.0)));
        }
    std::fill(sums_.begin(), sums_.end(), 0.0);
}

Picture Thumbnail::upright(uint16_t orientation) const {
    Picture copy;
    copy.width = width_, copy.height = height_;
    if (orientation >= 5 && orientation <= 8) std::swap(copy.width, copy.height);
    copy.frame_width = copy.width, copy.frame_height = copy.height;
    copy.row_bytes = size_t(3) * copy.width;
    copy.pixels.resize(copy.row_bytes * copy.height);
    for (uint32_t y = 0; y < copy.height; y++)
        for (uint32_t x = 0; x < copy.width; x++) {
            const auto [u, v] = stored_place(orientation, width_, height_, x, y);
            std::copy_n(&rgb_[(size_t(v) * width_ + u) * 3], 3, &copy.pixels[y * copy.row_bytes + size_t(x) * 3]);
        }
    return copy;
}

Picture upright_copy(const Picture &stored, uint16_t orientation, uint32_t side) {
    Thumbnail thumbnail(stored.width, stored.height, side);
    thumbnail.add(stored.view());
    return thumbnail.upright(orientation);
}

}  // namespace lensprof
