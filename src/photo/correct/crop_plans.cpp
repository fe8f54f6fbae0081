#include "photo/correct/crop_plans.hpp"

#include <algorithm>
#include <cmath>

namespace lensprof {
namespace {

// Columns of a crop in a row of a picture, [0] up to but without [1]; empty if they are equal.
std::pair<uint32_t, uint32_t> columns_of(const CropCorrection &part, uint32_t width, uint32_t row) {
    const int32_t *crop = part.crop;
    if (int64_t(row) < crop[1] || int64_t(row) >= crop[3]) return {0, 0};
    double begin = crop[0], end = crop[2];
    if (part.is_circular) {
        const double x = 0.5 * (crop[0] + crop[2]), dy = row + 0.5 - 0.5 * (crop[1] + crop[3]),
                     radius = 0.5 * std::min(crop[2] - crop[0], crop[3] - crop[1]), half2 = radius * radius - dy * dy;
        if (!(half2 > 0.0)) return {0, 0};
        begin = std::max(begin, std::ceil(x - std::sqrt(half2))), end = std::min(end, std::floor(x + std::sqrt(half2)));
    }
    const auto column = [&](double x) { return static_cast<uint32_t>(std::clamp(x, 0.0, double(width))); };
    return {column(begin), std::max(column(begin), column(end))};
}

// Columns [begin, end) of a row of an image or a target, whose bytes are of type Byte.
template <class Byte, class View>
View tile_of(const View &view, uint32_t row, uint32_t begin, uint32_t end) {
    const size_t pixel = size_t(lensprof_layout_samples(view.layout)) * lensprof_sample_type_bytes(view.sample);
    View tile = view;
    tile.data = static_cast<Byte *>(view.data) + static_cast<ptrdiff_t>(row) * view.row_bytes + begin * pixel;
    tile.width = end - begin, tile.height = 1;
    return tile;
}

}  // namespace

CropPlans::CropPlans(const Picture &source, const Correction &job, const CorrectionKind &kind) : job_(job) {
    for (const CropCorrection &crop : job.crops) {
        Correction of_crop = job;
        of_crop.model = crop.model;
        of_crop.exposure = crop.exposure, of_crop.target_exposure = crop.target_exposure;
        lensprof_apply_options options = options_of(source, of_crop, kind);
        options.frame_width = static_cast<uint32_t>(crop.crop[2] - crop.crop[0]);
        options.frame_height = static_cast<uint32_t>(crop.crop[3] - crop.crop[1]);
        parts_.push_back({&crop, std::make_unique<Plan>(options, job.source)});
    }
}

std::vector<CropPlans::Span> CropPlans::spans_of(uint32_t width, uint32_t row) const {
    std::vector<Span> spans;
    for (const Part &part : parts_) {
        const auto [begin, end] = columns_of(*part.correction, width, row);
        if (begin < end) spans.push_back({begin, end, &part});
    }
    std::sort(spans.begin(), spans.end(),
              [](const Span &a, const Span &b) { return a.begin + a.end < b.begin + b.end; });
    for (size_t i = 1; i < spans.size(); i++) {
        if (spans[i].begin >= spans[i - 1].end) continue;
        const uint32_t between = (spans[i].begin + spans[i - 1].end) / 2;
        spans[i - 1].end = std::max(between, spans[i - 1].begin), spans[i].begin = std::min(between, spans[i].end);
    }
    return spans;
}

void CropPlans::apply(const Plan &rest, const lensprof_image &source, const lensprof_target &target,
                      uint32_t first_row) const {
    for (uint32_t y = 0; y < source.height; y++) {
        const uint32_t row = first_row + y;
        const auto correct = [&](const Plan &plan, uint32_t begin, uint32_t end, uint32_t x0, uint32_t y0) {
            if (begin >= end) return;
            const auto from = tile_of<const uint8_t>(source, y, begin, end);
            const auto to = tile_of<uint8_t>(target, y, begin, end);
            check(lensprof_apply(plan.get(), &from, &to, x0, y0), job_.source);
        };
        uint32_t done = 0;
        for (const Span &span : spans_of(source.width, row)) {
            const int32_t *crop = span.part->correction->crop;
            correct(rest, done, span.begin, done, row);
            correct(*span.part->plan, span.begin, span.end, static_cast<uint32_t>(int64_t(span.begin) - crop[0]),
                    static_cast<uint32_t>(int64_t(row) - crop[1]));
            done = std::max(done, span.end);
        }
        correct(rest, done, source.width, done, row);
    }
}

}  // namespace lensprof
