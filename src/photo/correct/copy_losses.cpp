#include "photo/correct/copy_losses.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "photo/base/events.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

constexpr uint32_t row_step = 8;
constexpr double largest_lift_ev = 2.0, largest_clipped = 0.01;  // share of the pixels

template <class Sample>
uint64_t count_clipped(const lensprof_image &rows, uint32_t y) {
    const auto *row = reinterpret_cast<const Sample *>(static_cast<const uint8_t *>(rows.data)
                                                       + static_cast<ptrdiff_t>(y) * rows.row_bytes);
    const uint32_t samples = lensprof_layout_samples(rows.layout), channels = lensprof_layout_channels(rows.layout);
    uint64_t count = 0;
    for (uint32_t x = 0; x < rows.width; x++) {
        bool is_clipped = false;
        for (uint32_t c = 0; c < channels; c++)
            is_clipped |= row[size_t(x) * samples + c] == std::numeric_limits<Sample>::max();
        count += is_clipped;
    }
    return count;
}

// EV; of crops, the largest.
double lift_of(const Correction &job) {
    double lift = job.target_exposure.ev - job.exposure.ev;
    for (const CropCorrection &crop : job.crops) lift = std::max(lift, crop.target_exposure.ev - crop.exposure.ev);
    return lift;
}

std::string with_others(const std::string &file, size_t count) {
    return count > 1 ? file + format(" and %zu more", count - 1) : file;
}

std::string command_with(const Correction &job, const std::string &option) {
    const std::string program = job.command.empty() ? advice("apply") : job.command;
    if (program.empty()) return option_name(option);
    return "`" + program + " " + option_name(option) + (job.command.empty() ? "`" : " -o FOLDER`");
}

}  // namespace

void ClippedPixels::add(const lensprof_image &rows, uint32_t first_row) {
    if (rows.sample != LENSPROF_SAMPLE_U8 && rows.sample != LENSPROF_SAMPLE_U16) return;
    for (uint32_t y = (row_step - first_row % row_step) % row_step; y < rows.height; y += row_step) {
        clipped_ +=
            rows.sample == LENSPROF_SAMPLE_U8 ? count_clipped<uint8_t>(rows, y) : count_clipped<uint16_t>(rows, y);
        pixels_ += rows.width;
    }
}

void CopyLosses::Worst::add(const Correction &other, double of_other, double limit) {
    if (!(of_other > limit)) return;
    count++;
    if (of_other > value) job = &other, value = of_other;
}

bool lacks_offset_of_counts(const Correction &job) {
    if (!job.model || job.levels) return false;
    const double *black = job.model->levels.black;
    return std::strcmp(job.model->provenance.method, "fields") == 0
           || std::any_of(black, black + 3, [](double level) { return level != 0.0; });
}

bool has_samples_above_one(const lensprof_image &rows) {
    const uint32_t samples = rows.width * lensprof_layout_samples(rows.layout);
    for (uint32_t y = 0; y < rows.height; y++) {
        const auto *row = reinterpret_cast<const float *>(static_cast<const uint8_t *>(rows.data)
                                                          + static_cast<ptrdiff_t>(y) * rows.row_bytes);
        if (std::any_of(row, row + samples, [](float sample) { return sample > 1.0f; })) return true;
    }
    return false;
}

void CopyLosses::add(const Correction &job, double more_clipped, bool keeps_offset) {
    offset_.add(job, keeps_offset, 0.5);
    lifted_.add(job, lift_of(job), largest_lift_ev);
    clipped_.add(job, more_clipped, largest_clipped);
}

std::vector<std::string> CopyLosses::warnings() const {
    std::vector<std::string> lines;
    if (lifted_.count)
        lines.push_back(with_others(lifted_.job->source, lifted_.count)
                        + format(": lifted by %s%.1f EV, which shows the noise; use ",
                                 lifted_.count > 1 ? "up to " : "", lifted_.value)
                        + command_with(*lifted_.job, "exposure_keep") + ", or pictures of 16 bits");
    if (clipped_.count)
        lines.push_back(with_others(clipped_.job->source, clipped_.count)
                        + format(": the correction clips %s%.1f %% more of the pixels; use ",
                                 clipped_.count > 1 ? "up to " : "", 100.0 * clipped_.value)
                        + command_with(*clipped_.job, "linear") + ", which clips none");
    if (offset_.count)
        lines.push_back(with_others(offset_.job->source, offset_.count)
                        + ": has float samples above 1, and the profile holds no offset of such samples, but shares of "
                          "full scale; divide them by their count at saturation, or subtract their offset, first");
    return lines;
}

}  // namespace lensprof
