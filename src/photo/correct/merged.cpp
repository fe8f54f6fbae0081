#include "photo/correct/merged.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "photo/base/events.hpp"
#include "photo/base/paths.hpp"
#include "photo/correct/left_out_parts.hpp"
#include "photo/correct/light_weights.hpp"
#include "photo/correct/picture_plan.hpp"
#include "photo/scene/scene.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

constexpr uint32_t strip_rows = 32;

// One frame, read from the top.
class Frame {
public:
    Frame(const Correction &job, const CorrectionKind &kind)
        : job_(job), reader_(job.source), plan_(options_of(reader_.header(), job, kind), job.source), weights_(job) {
        const Picture &header = reader_.header();
        samples_ = samples_of_light(header, job.source);
    }

    const Picture &header() const { return reader_.header(); }
    size_t samples() const { return samples_; }
    double ev() const { return job_.exposure.ev; }

    // Reads the next rows; `first` is the index of the first.
    void read(uint32_t first, uint32_t rows) {
        const Picture &h = header();
        before_.resize(h.row_bytes * rows);
        light_.resize(size_t(h.width) * rows * samples_);
        const lensprof_target before{before_.data(), static_cast<ptrdiff_t>(h.row_bytes), h.width, rows, h.sample,
                                     h.layout};
        const lensprof_target after{light_.data(),
                                    static_cast<ptrdiff_t>(h.width * samples_ * sizeof(float)),
                                    h.width,
                                    rows,
                                    LENSPROF_SAMPLE_F32,
                                    h.layout};
        reader_.read(before);
        before_rows_ = image_of(before);
        check_finite(before_rows_, first, 1, job_.source);
        check(lensprof_apply(plan_.get(), &before_rows_, &after, 0, first), job_.source);
    }

    const float *light(uint32_t x, uint32_t y) const { return &light_[(size_t(y) * header().width + x) * samples_]; }

    // Irradiance per channel; returns how far the pixel is from clipping.
    double weights(uint32_t x, uint32_t y, double weight[3]) const {
        for (size_t c = 0; c < samples_; c++)
            weight[c] = weights_.at(c, grey_at(before_rows_, y, size_t(x) * samples_ + c));
        return trust_of(largest_grey(before_rows_, x, y));
    }

    bool is_white(uint32_t x, uint32_t y) const { return lensprof::is_white(largest_grey(before_rows_, x, y)); }

private:
    const Correction &job_;
    PictureReader reader_;
    const Plan plan_;
    size_t samples_;
    const LightWeights weights_;
    std::vector<uint8_t> before_;
    std::vector<float> light_;
    lensprof_image before_rows_{};
};

using Frames = std::vector<std::unique_ptr<Frame>>;

// One pixel of all frames, the darkest frame first.
void merge_pixel(const Frames &frames, uint32_t x, uint32_t y, float *merged) {
    const size_t samples = frames[0]->samples();
    double sum[3] = {}, all[3] = {}, weight[3];
    for (const auto &frame : frames) {
        const double certain = frame->weights(x, y, weight);
        if (certain == 0.0) continue;
        const float *light = frame->light(x, y);
        for (size_t c = 0; c < samples; c++) {
            all[c] += certain * weight[c];
            sum[c] += certain * weight[c] * static_cast<double>(light[c]);
        }
    }
    // If no frame is unclipped in a channel: the brightest frame that is not white there, or the darkest of all.
    size_t other = frames.size() - 1;
    while (other > 0 && frames[other]->is_white(x, y)) other--;
    for (size_t c = 0; c < samples; c++)
        merged[c] = all[c] > 0.0 ? static_cast<float>(sum[c] / all[c]) : frames[other]->light(x, y)[c];
}

}  // namespace

void check_merged_name(const std::string &target) {
    const FileFormat format = format_of_name(target);
    if (format != FileFormat::tiff && format != FileFormat::exr)
        throw Failure(LENSPROF_ERROR_ARGUMENT, target + ": HDR is written only as TIFF or OpenEXR; give a name ending in .tif "
                                                "or .exr");
}

void write_merged(const std::vector<Correction> &jobs, size_t reference, const std::string &target, Events &events) {
    CorrectionKind kind;
    kind.linear = true;
    Frames frames;
    for (const Correction &job : jobs) frames.push_back(std::make_unique<Frame>(job, kind));
    for (const auto &frame : frames)
        if (frame->samples() != frames[0]->samples())
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          jobs[0].source + ": some frames are grey and others in colour; give frames of one kind");
    const Picture header = header_of_result(frames[reference]->header(), LENSPROF_SAMPLE_F32);
    PictureWriter writer(target, header, write_options(jobs[reference], kind));
    std::stable_sort(frames.begin(), frames.end(), [](const auto &a, const auto &b) { return a->ev() < b->ev(); });
    std::vector<float> merged;
    for (uint32_t first = 0; first < header.height; first += strip_rows) {
        stop_if_cancelled();
        const uint32_t rows = std::min(strip_rows, header.height - first);
        for (const auto &frame : frames) frame->read(first, rows);
        merged.resize(size_t(header.width) * rows * frames[0]->samples());
        for (uint32_t y = 0; y < rows; y++)
            for (uint32_t x = 0; x < header.width; x++)
                merge_pixel(frames, x, y, &merged[(size_t(y) * header.width + x) * frames[0]->samples()]);
        writer.write({merged.data(), static_cast<ptrdiff_t>(header.row_bytes), header.width, rows, header.sample,
                      header.layout});
        events.update("merging", static_cast<double>(first + rows) / header.height);
    }
    Correction merged_job = jobs[reference];
    merged_job.target = target;
    const bool with_metadata = writer.finish();
    writer.commit();
    warn_of_written(merged_job, with_metadata, events);
    LeftOutParts parts;
    parts.add(merged_job.source, target);
    parts.warn(events);
}

}  // namespace lensprof
