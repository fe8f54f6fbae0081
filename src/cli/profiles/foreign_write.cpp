// Files of other programs, written.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "cli/pictures/opcode_tag.hpp"
#include "cli/pictures/picture.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/profile_blob.hpp"
#include "cli/program/library.hpp"

namespace lensprof {
namespace {

constexpr uint64_t most_map_values = 100000000;
constexpr size_t most_bytes = size_t(64) << 20;  // of a file of profiles, as read_profiles

// What a writer of the library makes, by asking for the size first: write(buffer, capacity, &needed, &error).
// `names` are those of the profiles.
template <typename Write>
std::string bytes_of(const std::string &path, const std::vector<std::string> &names, const Write &write) {
    size_t needed = 0;
    lensprof_error error{};
    lensprof_status status = write(static_cast<char *>(nullptr), size_t(0), &needed, &error);
    if (status != LENSPROF_ERROR_CAPACITY) check_named(status, path, error, LENSPROF_ITEM_PROFILE, names);
    std::string bytes(needed, 0);
    status = write(bytes.data(), bytes.size(), &needed, &error);
    check_named(status, path, error, LENSPROF_ITEM_PROFILE, names);
    return bytes;
}

void demand_frame(const std::string &path, const ForeignRule &rule, const ForeignOptions &o) {
    if (!o.width || !o.height)
        throw Failure(ExitCode::usage,
                      path + ": " + rule.name + " is for pictures of one size; give --frame WIDTHxHEIGHT");
}

// A map as a picture: attenuation of the mean of the channels as PNG (DSO's vignette.png), gains a channel as float
// TIFF.
void write_map(const std::string &path, const ForeignOptions &o, const lensprof_profile &profile) {
    const bool is_tiff = format_of_name(path) == FileFormat::tiff;
    const bool is_gain = o.sense.empty() ? is_tiff : o.sense == "gain";
    if (format_of_name(path) == FileFormat::jpeg)
        throw Failure(ExitCode::usage, path + ": JPEG is not exact; give a map the ending .png or .tif");
    if (!is_tiff && is_gain)
        throw Failure(ExitCode::usage, path + ": gains go beyond 1 and need a float TIFF; give it the ending .tif");
    const bool has_channels = profile.vignettings == 3 || profile.grid.channels == 3;
    const uint32_t channels = is_tiff && has_channels ? 3 : 1;
    const uint32_t columns = o.columns ? o.columns : o.width, rows = o.rows ? o.rows : o.height;
    if (uint64_t(columns) * rows > most_map_values)
        throw Failure(ExitCode::usage, path + ": a map of over 100 million values; give a smaller --grid");
    std::vector<float> values(size_t(columns) * rows * channels);
    lensprof_error error{};
    check(lensprof_map_write(&profile, o.width, o.height, columns, rows, channels,
                             is_gain ? LENSPROF_MAP_GAIN : LENSPROF_MAP_ATTENUATION, values.data(), &error),
          path, &error);
    Picture picture;
    picture.width = picture.frame_width = columns, picture.height = picture.frame_height = rows;
    picture.layout = channels == 3 ? LENSPROF_LAYOUT_RGB : LENSPROF_LAYOUT_GREY;
    picture.sample = is_tiff ? LENSPROF_SAMPLE_F32 : o.depth == 8 ? LENSPROF_SAMPLE_U8 : LENSPROF_SAMPLE_U16;
    const size_t size = lensprof_sample_bytes(picture.sample);
    picture.row_bytes = size_t(columns) * channels * size;
    picture.pixels.resize(picture.row_bytes * rows);
    for (size_t i = 0; i < values.size(); i++) {  // 0 would be: not known
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

// Whether a list has an opcode that `is_one` is true of.
template <typename Is>
bool has_opcode(const std::vector<uint8_t> &list, const Is &is_one) {
    const auto word = [&](size_t at) {
        uint32_t value = 0;
        for (size_t i = 0; i < 4; i++) value = value << 8 | (at + i < list.size() ? list[at + i] : 0);
        return value;
    };
    for (size_t at = 4; at + 16 <= list.size(); at += 16 + size_t(word(at + 12)))
        if (is_one(word(at))) return true;
    return false;
}

// What else a picture's lists do must stay, and a falloff must not be corrected twice.
void demand_no_others(const std::string &path, const OpcodeLists &lists) {
    const auto is_gain = [](uint32_t id) { return id == 3 || id == 9; };  // FixVignetteRadial, GainMap
    if (has_opcode(lists.list2, is_gain))
        throw Failure(ExitCode::usage, path + ": its OpcodeList2 corrects the falloff already; take another picture");
    if (has_opcode(lists.list3, [&](uint32_t id) { return !is_gain(id); }))
        throw Failure(ExitCode::usage, path + ": its OpcodeList3 does other things, too, which would be lost (as a correction of "
                                              "distortion); take a picture without");
}

// One opcode of a radial falloff where that comes near enough, else a map.
void write_opcodes(const std::string &path, const ForeignOptions &o, const lensprof_profile &profile) {
    constexpr double near_enough = 0.005;
    const OpcodeLists lists = read_opcode_lists(path);
    demand_no_others(path, lists);
    // after demosaicing there are three channels; linear raw images and plain TIFF have them from the start
    const uint32_t layout = lists.layout == LENSPROF_LAYOUT_GREY ? LENSPROF_LAYOUT_GREY : LENSPROF_LAYOUT_RGB;
    const auto written = [&](uint32_t form, double &worst) {
        return bytes_of(path, {}, [&](char *bytes, size_t capacity, size_t *needed, lensprof_error *error) {
            return lensprof_dng_opcodes_write(&profile, lists.width, lists.height, layout, form, bytes, capacity,
                                              needed, &worst, error);
        });
    };
    double worst = 0.0;
    std::string bytes;
    const bool may_be_radial = profile.vignettings == 1 && !profile.grid.columns;
    if (o.opcode == "radial" || (o.opcode == "auto" && may_be_radial)) bytes = written(LENSPROF_DNG_RADIAL, worst);
    if (o.opcode == "map" || bytes.empty() || (o.opcode == "auto" && worst > near_enough))
        bytes = written(LENSPROF_DNG_GAIN_MAP, worst);
    write_opcode_list(path, path, tag_opcode_list3, {bytes.begin(), bytes.end()});
}

std::string text_of(const ForeignRule &rule, const std::string &path, const ForeignOptions &o,
                    const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &names) {
    const lensprof_profile &first = *profiles[0];
    const auto count = static_cast<uint32_t>(profiles.size());
    return bytes_of(path, names, [&](char *bytes, size_t capacity, size_t *needed, lensprof_error *error) {
        switch (rule.format) {
        case ForeignFormat::lensfun:
            return lensprof_lensfun_write(profiles.data(), count, bytes, capacity, needed, error);
        case ForeignFormat::lcp:
            return lensprof_lcp_write(profiles.data(), count, o.width, o.height, bytes, capacity, needed, error);
        case ForeignFormat::json: return lensprof_json_write(profiles.data(), count, bytes, capacity, needed, error);
        case ForeignFormat::pcalib:  // one curve: green's of three
            return lensprof_pcalib_write(&first.response[first.responses / 2], bytes, capacity, needed, error);
        case ForeignFormat::curves:
            return lensprof_curves_write(first.response, first.responses, o.curve, o.rows ? o.rows : 256, bytes,
                                         capacity, needed, error);
        case ForeignFormat::crf:
            return lensprof_radical_response_write(first.response, first.responses, bytes, capacity, needed, error);
        case ForeignFormat::vgn:
            return lensprof_radical_vignetting_write(&first, o.width, o.height, bytes, capacity, needed, error);
        default:
            return lensprof_alsc_write(&first, o.color_temperature_k, o.columns ? o.columns : 16, o.rows ? o.rows : 12,
                                       o.width, o.height, bytes, capacity, needed, error);
        }
    });
}

}  // namespace

void write_foreign(const ForeignRule &rule, const std::string &path, const ForeignOptions &o,
                   const std::vector<const lensprof_profile *> &profiles, const std::vector<std::string> &names) {
    const bool holds_many = rule.format == ForeignFormat::lensfun || rule.format == ForeignFormat::lcp
                            || rule.format == ForeignFormat::json;
    if (!holds_many && profiles.size() != 1)
        throw Failure(ExitCode::usage, path + ": " + rule.name + " holds one profile, and "
                                           + std::to_string(profiles.size()) + " were chosen; give one id");
    const ForeignFormat format = rule.format;
    if (format == ForeignFormat::map || format == ForeignFormat::vgn || format == ForeignFormat::alsc)
        demand_frame(path, rule, o);
    if (format == ForeignFormat::map) return write_map(path, o, *profiles[0]);
    if (format == ForeignFormat::opcodes) return write_opcodes(path, o, *profiles[0]);
    const std::string text = text_of(rule, path, o, profiles, names);
    if (holds_many && text.size() > most_bytes)
        throw Failure(ExitCode::usage, path + ": would be larger than the 64 MiB that are read; export fewer profiles, or use "
                                              "`lensprof profile merge`");
    write_file(path, text.data(), text.size());
}

}  // namespace lensprof
