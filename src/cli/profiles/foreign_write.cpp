// Files of other programs, written.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "cli/profiles/foreign_file.hpp"
#include "photo/base/library.hpp"
#include "photo/correct/opcode_copy.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

constexpr uint64_t max_map_values = 80000000;  // of all channels; each needs 12 bytes of memory

void require_single_profile(const std::string &path, const ForeignRule &rule, size_t profiles) {
    if (profiles != 1)
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": " + rule.name + " holds one profile, and "
                                                   + std::to_string(profiles) + " were chosen; give one id");
}

void require_frame(const std::string &path, const ForeignRule &rule, const ForeignOptions &o) {
    if (!o.width || !o.height)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": " + rule.name + " is for pictures of one size; give --encoding frame=WIDTHxHEIGHT");
}

// A map as a picture: attenuation of the mean of the channels as PNG (DSO's vignette.png), gains per channel as float
// TIFF.
void write_map(const std::string &path, const ForeignOptions &o, const lensprof_profile &profile) {
    const bool is_tiff = format_of_name(path) == FileFormat::tiff;
    const bool is_gain = o.sense.empty() ? is_tiff : o.sense == "gain";
    if (format_of_name(path) == FileFormat::jpeg)
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": JPEG is lossy; use a name ending in .png or .tif for a map");
    if (!is_tiff && is_gain)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": gains exceed 1 and need a float TIFF; use a name ending in .tif");
    const bool has_channels = profile.vignettings == 3 || profile.grid.channels == 3;
    const uint32_t channels = is_tiff && has_channels ? 3 : 1;
    const uint32_t columns = o.columns ? o.columns : o.width, rows = o.rows ? o.rows : o.height;
    if (uint64_t(columns) * rows * channels > max_map_values)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": the map would have more than 80 million values; give a smaller --encoding grid");
    std::vector<float> values(size_t(columns) * rows * channels);
    lensprof_error error{};
    check(lensprof_map_write(&profile, o.width, o.height, columns, rows, channels,
                             is_gain ? LENSPROF_MAP_GAIN : LENSPROF_MAP_ATTENUATION, values.data(), &error),
          path, &error);
    Picture picture;
    picture.width = picture.frame_width = columns, picture.height = picture.frame_height = rows;
    picture.layout = channels == 3 ? LENSPROF_LAYOUT_RGB : LENSPROF_LAYOUT_GREY;
    picture.sample = is_tiff ? LENSPROF_SAMPLE_F32 : o.depth == 8 ? LENSPROF_SAMPLE_U8 : LENSPROF_SAMPLE_U16;
    const size_t size = lensprof_sample_type_bytes(picture.sample);
    picture.row_bytes = size_t(columns) * channels * size;
    picture.pixels.resize(picture.row_bytes * rows);
    for (size_t i = 0; i < values.size(); i++) {  // 0 would mean unknown
        const double full = o.depth == 8 ? 255.0 : 65535.0;
        const auto word = static_cast<uint16_t>(std::clamp(std::lround(full * values[i]), 1l, std::lround(full)));
        if (is_tiff)
            std::memcpy(&picture.pixels[i * size], &values[i], size);
        else if (size == 2)
            std::memcpy(&picture.pixels[i * size], &word, size);
        else
            picture.pixels[i] = static_cast<uint8_t>(word);
    }
    write_picture(path, picture);
}

lensprof_export_options export_options_of(const ForeignRule &rule, const ForeignOptions &o) {
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = rule.format;
    options.width = o.width, options.height = o.height;
    options.columns = o.columns, options.rows = o.rows;
    options.curve = o.curve;
    options.dng_form = o.opcode;
    options.color_temperature_k = o.color_temperature_k;
    return options;
}

}  // namespace

std::string foreign_bytes(const ForeignRule &rule, const std::string &path, const ForeignOptions &o,
                          const std::vector<const lensprof_profile *> &profiles,
                          const std::vector<std::string> &names) {
    const uint32_t format = rule.format;
    if (format == LENSPROF_FORMAT_MAP || format == LENSPROF_FORMAT_DNG_OPCODES)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": " + rule.name + " is written into a picture; export one profile with -o FILE");
    if (!rule.is_many) require_single_profile(path, rule, profiles.size());
    if (format == LENSPROF_FORMAT_RADICAL_VIGNETTING || format == LENSPROF_FORMAT_ALSC) require_frame(path, rule, o);
    return exported(path, profiles, export_options_of(rule, o), names);
}

void write_foreign(const ForeignRule &rule, const std::string &path, const ForeignOptions &o,
                   const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &names) {
    const bool is_map = rule.format == LENSPROF_FORMAT_MAP;
    if (is_map || rule.format == LENSPROF_FORMAT_DNG_OPCODES) {
        require_single_profile(path, rule, profiles.size());
        if (is_map) require_frame(path, rule, o);
        return is_map ? write_map(path, o, *profiles[0])
                      : write_opcodes_as(path, path, export_options_of(rule, o), *profiles[0]);
    }
    const std::string text = foreign_bytes(rule, path, o, profiles, names);
    write_file(path, text.data(), text.size());
}

}  // namespace lensprof
