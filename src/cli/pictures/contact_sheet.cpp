#include "cli/pictures/contact_sheet.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace {

constexpr uint32_t kThumbnailSide = 320, kGap = 8, kPerRow = 6;
constexpr uint8_t kBackground = 40;

double full_scale(uint8_t) { return 255.0; }
double full_scale(uint16_t) { return 65535.0; }
double full_scale(float) { return 1.0; }

// Adds the samples of a row to the sums of the boxes, `step` wide, that they are in.
template <class Sample>
void add_row(const Sample *row, uint32_t layout, uint32_t picture_width, uint32_t step, std::vector<double> &sums) {
    uint32_t samples = lensprof_layout_samples(layout), next = lensprof_layout_channels(layout) == 1 ? 0 : 1;
    for (size_t x = 0; x < sums.size() / 3; x++) {
        double *sum = &sums[x * 3];
        const Sample *end = row + std::min(picture_width, static_cast<uint32_t>(x + 1) * step) * size_t(samples);
        for (const Sample *p = row + x * step * samples; p < end; p += samples)
            for (uint32_t c = 0; c < 3; c++) sum[c] += p[c * next] / full_scale(Sample());
    }
}

}  // namespace

Thumbnail::Thumbnail(uint32_t picture_width, uint32_t picture_height)
    : picture_width_(picture_width),
      picture_height_(picture_height),
      step_(std::max(1u, (std::max(picture_width, picture_height) + kThumbnailSide - 1) / kThumbnailSide)) {
    width = std::max(1u, picture_width / step_);
    height = std::max(1u, picture_height / step_);
    rgb.resize(static_cast<size_t>(width) * height * 3);
    sums_.assign(static_cast<size_t>(width) * 3, 0.0);
}

void Thumbnail::add(const lensprof_image &rows) {
    for (uint32_t y = 0; y < rows.height && row_ < height * step_; y++) {
        const auto *row = static_cast<const uint8_t *>(rows.data) + static_cast<ptrdiff_t>(y) * rows.row_bytes;
        if (rows.sample == LENSPROF_SAMPLE_U8)
            add_row(row, rows.layout, picture_width_, step_, sums_);
        else if (rows.sample == LENSPROF_SAMPLE_U16)
            add_row(reinterpret_cast<const uint16_t *>(row), rows.layout, picture_width_, step_, sums_);
        else
            add_row(reinterpret_cast<const float *>(row), rows.layout, picture_width_, step_, sums_);
        row_++;
        if (row_ % step_ == 0 || row_ == picture_height_) end_boxes();
    }
}

void Thumbnail::end_boxes() {
    uint32_t y = (row_ - 1) / step_, high = row_ - y * step_;
    for (uint32_t x = 0; x < width; x++)
        for (uint32_t c = 0; c < 3; c++) {
            uint32_t count = high * (std::min(picture_width_, (x + 1) * step_) - x * step_);
            double mean = std::clamp(sums_[x * size_t(3) + c] / count, 0.0, 1.0);
            rgb[(static_cast<size_t>(y) * width + x) * 3 + c] = static_cast<uint8_t>(std::lround(mean * 255.0));
        }
    std::fill(sums_.begin(), sums_.end(), 0.0);
}

void ContactSheet::reserve(size_t pictures) {
    before_.resize(pictures);
    after_.resize(pictures);
}

void ContactSheet::put(size_t picture, Thumbnail before, Thumbnail after) {
    before_[picture] = std::move(before);
    after_[picture] = std::move(after);
}

void ContactSheet::write(const std::string &path) const {
    uint32_t cell_w = 1, cell_h = 1;
    for (const auto *row : {&before_, &after_})
        for (const auto &t : *row) cell_w = std::max(cell_w, t.width), cell_h = std::max(cell_h, t.height);
    auto count = static_cast<uint32_t>(before_.size());
    uint32_t columns = std::max(1u, std::min(count, kPerRow)), bands = std::max(1u, (count + columns - 1) / columns);
    Picture sheet;
    sheet.width = sheet.frame_width = columns * (cell_w + kGap) + kGap;
    sheet.height = sheet.frame_height = bands * (2 * cell_h + 3 * kGap) + kGap;
    sheet.row_bytes = static_cast<size_t>(sheet.width) * 3;
    sheet.pixels.assign(sheet.row_bytes * sheet.height, kBackground);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t row = 0; row < 2; row++) {
            const Thumbnail &t = row == 0 ? before_[i] : after_[i];
            uint32_t x0 = kGap + (i % columns) * (cell_w + kGap);
            uint32_t y0 = kGap + (i / columns) * (2 * cell_h + 3 * kGap) + row * (cell_h + kGap);
            for (uint32_t y = 0; y < t.height; y++)
                std::copy_n(&t.rgb[static_cast<size_t>(y) * t.width * 3], t.width * 3,
                            &sheet.pixels[(y0 + y) * sheet.row_bytes + static_cast<size_t>(x0) * 3]);
        }
    write_picture(path, sheet);
}

}  // namespace lensprof
