#include "photo/cards/dark_frames.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/base/quantile.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/cards/count_samples.hpp"
#include "photo/pictures/picture_stack.hpp"
#include "photo/scene/scene_pictures.hpp"

namespace lensprof {
namespace {

constexpr uint32_t blocks = 16;       // along each side
constexpr double largest_dark = 0.1;  // of full scale: no pedestal is as high
// Of the level over the frame: light that falls on it varies by more. Shares of the level, or of the scale near 0.
constexpr double clear_spread = 0.01, largest_spread = 0.05, least_spread = 0.0001, least_light = 0.0005;
constexpr double far_sigmas = 4.0, least_reach = 1.5 / 255.0;  // from the median of a block; more than a step of 8 bit

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

struct DarkPage {
    std::string file, name;
    uint32_t page;
    uint64_t offset;
};

// Every page of every file; those of one channel of stacks that have several.
std::vector<DarkPage> pages_of(const std::vector<std::string> &files, uint32_t channel) {
    std::vector<DarkPage> pages;
    for (const std::string &file : files) {
        const PictureStack stack = picture_stack(file);
        if (stack.is_damaged) throw Failure(LENSPROF_ERROR_READ, file + ": is truncated or damaged; copy it again");
        for (size_t i = 0; i < stack.pages.size(); i++) {
            if (channel && stack.channel_count > 1 && stack.channels[i] != channel - 1) continue;
            pages.push_back({file, stack.pages.size() > 1 ? format("%s, page %zu", file.c_str(), i + 1) : file,
                             stack.pages[i], stack.offsets[i]});
        }
    }
    return pages;
}

// Levels of frames, and of their blocks, per channel.
struct DarkValues {
    std::array<std::vector<double>, 3> of_blocks, of_frames;

    void add(const Picture &picture) {
        for (uint32_t c = 0; c < lensprof_layout_channels(picture.layout); c++) {
            std::vector<double> own;
            for (uint32_t block = 0; block < blocks * blocks; block++)
                if (const auto mean = block_mean(picture, block, c)) own.push_back(*mean);
            of_blocks[c].insert(of_blocks[c].end(), own.begin(), own.end());
            of_frames[c].push_back(median(own));
        }
    }

    void summarise(DarkLevel &dark) {
        const uint32_t channels = lensprof_layout_channels(dark.form.layout);
        for (uint32_t c = 0; c < channels; c++) {
            const double spread = deviation(of_blocks[c]), frames = deviation(of_frames[c]);
            dark.black[c] = median(of_blocks[c]);
            const auto brightest = std::max_element(of_frames[c].begin(), of_frames[c].end());
            if (*brightest > dark.brightest || dark.brightest_file.empty())
                dark.brightest = *brightest,
                dark.brightest_file = dark.names[static_cast<size_t>(brightest - of_frames[c].begin())];
            dark.spread = std::max(dark.spread, spread);
            dark.sigma =
                std::max(dark.sigma, median_error
                                         * std::hypot(spread / std::sqrt(static_cast<double>(of_blocks[c].size())),
                                                      frames / std::sqrt(static_cast<double>(of_frames[c].size()))));
        }
        if (channels == 1) dark.black.fill(dark.black[0]);
    }
};

// Failure if one of frames and pictures are counts, and the other shares of 1. Frames of counts have noise: a level
// below 1 does not keep their samples below 1.
void require_unit(const DarkLevel &dark, const DarkScale &scale, const std::string &file) {
    const double level = *std::max_element(dark.black.begin(), dark.black.end());
    if (scale.has_counts && level > 0.0 && level < 1.0 && dark.reach <= 1.0)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      dark.file
                          + format(": its level is %.3g, of samples from 0 to 1, but those of %s are counts: give dark "
                                   "frames in counts as well, or the count without light with %s",
                                   level, file.c_str(), option_name("black").c_str()));
    if (scale.is_saturation && dark.brightest > most_exposed * scale.brightest)
        throw Failure(
            LENSPROF_ERROR_ARGUMENT,
            dark.brightest_file
                + format(": its level is %.6g, but full scale of %s is %g: give dark frames in the unit of the "
                         "pictures, or, if all are counts, the one at saturation with %s",
                         dark.brightest, file.c_str(), scale.brightest, option_name("white_level").c_str()));
}

// Failure if light fell on the frames.
void require_dark(const DarkLevel &dark, const DarkScale &scale, Events &events) {
    const double level = *std::max_element(dark.black.begin(), dark.black.end()), unit = scale.brightest;
    if (scale.is_saturation && !(dark.brightest <= largest_dark * unit))
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      dark.brightest_file
                          + format(": is not dark, its level is %.0f %% of full scale; cover the lens",
                                   100.0 * dark.brightest / unit));
    const std::string spread = format("%.3g %% of %s", 100.0 * dark.spread / unit,
                                      scale.is_saturation ? "full scale" : "the brightness of the pictures");
    if (dark.spread > std::max(largest_spread * level, least_light * unit))
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      dark.file + ": is not dark, it varies by " + spread + " over the frame; cover the lens");
    if (dark.spread > std::max(clear_spread * level, least_spread * unit))
        events.note(dark.file, "the dark frames vary by " + spread
                                   + " over the frame; one level per channel leaves that in the corners");
}

}  // namespace

void leave_out_dark_frames(const std::vector<std::string> &dark_files, std::vector<NamedPicture> &pictures,
                           Events &events) {
    const auto is_lit = [&](const NamedPicture &picture) {
        return std::none_of(dark_files.begin(), dark_files.end(),
                            [&](const std::string &file) { return is_same_file(picture.file, file); });
    };
    const auto dark = std::stable_partition(pictures.begin(), pictures.end(), is_lit);
    const std::string stated = "is a dark frame, as " + option_name("dark") + " states";
    if (dark == pictures.begin() && dark != pictures.end())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      dark->file + ": " + stated + ", and no other picture is given; give pictures with light as well");
    for (auto picture = dark; picture != pictures.end(); ++picture)
        if (!picture->in_folder) events.note(picture->file, stated + ", and not used as a picture with light");
    pictures.erase(dark, pictures.end());
}

DarkLevel dark_level(const std::vector<std::string> &files, uint32_t max_side, uint32_t channel, Events &events) {
    DarkLevel dark;
    dark.files = files;
    DarkValues values;
    for (const DarkPage &page : pages_of(files, channel)) {
        ReadOptions read;
        read.max_side = max_side, read.page = page.page, read.page_offset = page.offset;
        const Picture picture = read_picture(page.file, read);
        check_finite(picture.view(), 0, picture.reduction, page.name);
        if (dark.file.empty()) dark.file = page.name, dark.form = picture, dark.form.pixels.clear();
        if (!is_like(picture, dark.form))
            throw Failure(LENSPROF_ERROR_ARGUMENT, page.name + ": is " + form_of(picture) + ", not "
                                                       + form_of(dark.form) + " as " + dark.file
                                                       + "; give dark frames of one camera");
        values.add(picture);
        if (picture.sample == LENSPROF_SAMPLE_F32) dark.reach = std::max(dark.reach, bright_sample(picture));
        dark.names.push_back(page.name);
    }
    if (dark.names.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      files.front() + format(": has no page of channel %u; give dark frames of it", channel));
    values.summarise(dark);
    if (dark.form.sample != LENSPROF_SAMPLE_F32) require_dark(dark, {}, events);
    return dark;
}

DarkLevel dark_level_for(const DarkLevel &dark, const DarkScale &scale, const Picture &picture, const std::string &file,
                         Events &events) {
    if (!is_like(picture, dark.form))
        throw Failure(LENSPROF_ERROR_ARGUMENT, dark.file + ": is " + form_of(dark.form) + ", not " + form_of(picture)
                                                   + " as " + file + "; give dark frames of the same camera");
    if (dark.form.sample != LENSPROF_SAMPLE_F32) return dark;
    require_unit(dark, scale, file);
    require_dark(dark, scale, events);
    DarkLevel level = dark;
    if (!scale.is_saturation) return level;
    for (double &black : level.black) black /= scale.brightest;
    level.sigma /= scale.brightest, level.spread /= scale.brightest;
    return level;
}

}  // namespace lensprof
