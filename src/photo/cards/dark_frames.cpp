#include "photo/cards/dark_frames.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/base/quantile.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/cards/count_samples.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

constexpr uint32_t blocks = 16;       // along each side
constexpr double largest_dark = 0.1;  // of full scale: no pedestal is as high
// Of the level over the frame: light that falls on it varies by more. Shares of the level, or of full scale near 0.
constexpr double clear_spread = 0.01, largest_spread = 0.05, least_spread = 0.0001, least_light = 0.0005;
constexpr double far_sigmas = 4.0, least_reach = 1.5 / 255.0;   // from the median of a block; more than a step of 8 bit
constexpr double mad_to_sigma = 1.4826, median_error = 1.2533;  // of normal numbers; relative to that of a mean

// Standard deviation, from the median distance of the median.
double deviation(std::vector<double> values) {
    const double center = median(values);
    for (double &value : values) value = std::abs(value - center);
    return mad_to_sigma * median(values);
}

// Mean of the samples of a block near its median: hot pixels are not part of the level.
std::optional<double> block_mean(const Picture &picture, uint32_t block, uint32_t channel) {
    const uint32_t column = block % blocks, row = block / blocks;
    const uint32_t right = (column + 1) * picture.width / blocks, bottom = (row + 1) * picture.height / blocks;
    const size_t samples = lensprof_layout_samples(picture.layout);
    std::vector<double> values;
    for (uint32_t y = row * picture.height / blocks; y < bottom; y++)
        for (uint32_t x = column * picture.width / blocks; x < right; x++)
            values.push_back(
                sample_value(picture.sample, picture.pixels.data() + y * picture.row_bytes, x * samples + channel));
    if (values.empty()) return std::nullopt;  // a frame of few pixels
    const double center = median(values);
    const double reach = std::max(far_sigmas * deviation(values), least_reach);
    double sum = 0.0, count = 0.0;
    for (const double value : values)
        if (std::abs(value - center) <= reach) sum += value, count += 1.0;
    return sum / count;
}

std::string form_of(const Picture &picture) {
    static const char *const types[] = {"8 bit", "16 bit", "float", "half float"};
    return format("%u x %u px, %s, ", picture.frame_width, picture.frame_height, types[picture.sample])
           + (lensprof_layout_channels(picture.layout) == 1 ? "grey" : "colour");
}

bool is_like(const Picture &a, const Picture &b) {
    return a.frame_width == b.frame_width && a.frame_height == b.frame_height && a.sample == b.sample
           && (a.traits.format == FileFormat::raw) == (b.traits.format == FileFormat::raw)
           && lensprof_layout_channels(a.layout) == lensprof_layout_channels(b.layout);
}

}  // namespace

DarkLevel dark_level(const std::vector<std::string> &files, uint32_t max_side, const StatedLevels *scale,
                     Events &events) {
    DarkLevel dark;
    std::array<std::vector<double>, 3> means;   // of blocks
    std::array<std::vector<double>, 3> levels;  // of frames
    ReadOptions reduced;
    reduced.max_side = max_side;
    uint32_t channels = 0;
    for (const std::string &file : files) {
        Picture picture = read_picture(file, reduced);
        check_finite(picture.view(), 0, picture.reduction, file);
        const auto count = scale ? count_at_white(*scale, {}, picture, file, events) : std::nullopt;
        if (count) divide_samples(*count, picture);
        if (dark.file.empty()) {
            dark.file = file, dark.form = picture, dark.form.pixels.clear();
            channels = lensprof_layout_channels(picture.layout);
        }
        if (!is_like(picture, dark.form))
            throw Failure(LENSPROF_ERROR_ARGUMENT, file + ": is " + form_of(picture) + ", not " + form_of(dark.form)
                                                       + " as " + dark.file + "; give dark frames of one camera");
        for (uint32_t c = 0; c < channels; c++) {
            std::vector<double> own;
            for (uint32_t block = 0; block < blocks * blocks; block++)
                if (const auto mean = block_mean(picture, block, c)) own.push_back(*mean);
            means[c].insert(means[c].end(), own.begin(), own.end());
            levels[c].push_back(median(own));
            const bool has_range = picture.sample != LENSPROF_SAMPLE_F32 || levels[c].back() <= 1.0;  // 0..1
            if (has_range && !(levels[c].back() <= largest_dark))
                throw Failure(LENSPROF_ERROR_NOT_USABLE,
                              file
                                  + format(": is not dark, its level is %.0f %% of full scale; cover the lens",
                                           100.0 * levels[c].back()));
        }
    }
    for (uint32_t c = 0; c < channels; c++) {
        const double spread = deviation(means[c]), frames = deviation(levels[c]);
        dark.black[c] = median(means[c]);
        dark.spread = std::max(dark.spread, spread);
        dark.sigma = std::max(dark.sigma, median_error
                                              * std::hypot(spread / std::sqrt(static_cast<double>(means[c].size())),
                                                           frames / std::sqrt(static_cast<double>(files.size()))));
    }
    if (channels == 1) dark.black.fill(dark.black[0]);
    const double level = *std::max_element(dark.black.begin(), dark.black.end());
    if (dark.spread > std::max(largest_spread * level, least_light))
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      dark.file
                          + format(": is not dark, it varies by %.2f %% of full scale over the frame; cover the "
                                   "lens",
                                   100.0 * dark.spread));
    if (dark.spread > std::max(clear_spread * level, least_spread))
        events.note(dark.file, format("the dark frames vary by %.3f %% of full scale over the frame; one level per "
                                      "channel leaves that in the corners",
                                      100.0 * dark.spread));
    return dark;
}

void check_dark(const DarkLevel &dark, const Picture &picture, const std::string &file) {
    if (!is_like(picture, dark.form))
        throw Failure(LENSPROF_ERROR_ARGUMENT, dark.file + ": is " + form_of(dark.form) + ", not " + form_of(picture)
                                                   + " as " + file + "; give dark frames of the same camera");
}

}  // namespace lensprof
