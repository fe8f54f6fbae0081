// Files of other programs, read.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "cli/profiles/foreign_file.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/opcode_tag.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

std::string name_of(const std::string &path) {
    const size_t slash = path.rfind('/');
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

// A profile that receives a response and a falloff from two files.
struct Parts {
    lensprof_profile &profile;
    double change = 0.0;
};

// Adds a text to one that may have others.
template <size_t size>
void add_text(char (&text)[size], const char *added) {
    const std::string all = std::string(text) + (*text && *added ? "; " : "") + added;
    set_text(text, size, all);
}

// Takes the response or falloff of an entry, with its doubt, source and key.
lensprof_status take_part(void *user, const lensprof_import_entry *entry) {
    Parts &parts = *static_cast<Parts *>(user);
    lensprof_profile &profile = parts.profile;
    const lensprof_profile &found = *entry->profile;
    profile.key = found.key;
    parts.change = std::max(parts.change, entry->change);
    add_text(profile.provenance.doubt, found.provenance.doubt);
    add_text(profile.provenance.source, found.provenance.source);
    if (entry->holds == LENSPROF_HOLDS_RESPONSE) {
        profile.responses = found.responses;
        std::copy_n(found.response, 3, profile.response);
        return LENSPROF_OK;
    }
    profile.vignettings = found.vignettings;
    std::copy_n(found.vignetting, 3, profile.vignetting);
    profile.grid = found.grid;
    profile.image_circle = found.image_circle;
    return LENSPROF_OK;
}

// The library's options for a file.
lensprof_import_options options_of(const ForeignRule &rule, const ForeignOptions &o) {
    lensprof_import_options options;
    lensprof_import_options_init(&options);
    options.format = rule.format;
    options.width = o.width, options.height = o.height;
    options.columns = o.columns, options.rows = o.rows;
    options.curve = o.curve;
    options.color_temperature_k = o.color_temperature_k;
    options.strict = o.strict;
    return options;
}

void import(const std::string &path, const std::string &bytes, const lensprof_import_options &options,
            lensprof_import_visitor visit, void *user) {
    lensprof_error error{};
    check(lensprof_import(bytes.data(), bytes.size(), &options, visit, user, &error), path, &error);
}

// Width and height of the frame, which some files do not state.
void require_frame(const std::string &path, const ForeignOptions &o) {
    if (!o.width || !o.height)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": does not state the size of the pictures; give --encoding frame=WIDTHxHEIGHT");
}

// A picture's values as floats, without alpha.
std::vector<float> values_of(Picture &picture, uint32_t channels) {
    const uint32_t samples = lensprof_layout_samples(picture.layout);
    std::vector<float> values;
    values.reserve(size_t(picture.width) * picture.height * channels);
    for (uint32_t y = 0; y < picture.height; y++) {
        const uint8_t *row = picture.pixels.data() + y * picture.row_bytes;
        for (uint32_t x = 0; x < picture.width; x++)
            for (uint32_t c = 0; c < channels; c++) {
                const size_t i = size_t(x) * samples + c;
                float value = 0.0f;
                uint16_t word = 0;
                if (picture.sample == LENSPROF_SAMPLE_U8)
                    value = row[i];
                else if (picture.sample == LENSPROF_SAMPLE_U16)
                    std::memcpy(&word, row + 2 * i, 2), value = word;
                else
                    std::memcpy(&value, row + 4 * i, 4);
                values.push_back(value);
            }
    }
    return values;
}

// A picture of attenuations or gains.
void read_map(const std::string &path, const ForeignOptions &o, lensprof_import_options &options, Parts &parts) {
    Picture picture = read_picture(path);
    const uint32_t channels = lensprof_layout_channels(picture.layout) == 3 ? 3 : 1;
    const std::vector<float> values = values_of(picture, channels);
    const bool is_gain = o.sense.empty() ? picture.sample == LENSPROF_SAMPLE_F32 : o.sense == "gain";
    const double shape = double(picture.width) / picture.height,
                 frame_shape = o.width ? double(o.width) / o.height : shape;
    if (std::fabs(shape / frame_shape - 1.0) > 0.01)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": its aspect ratio differs from that of --encoding frame; give the size of the pictures that it "
                             "is for");
    const lensprof_map map = {picture.width, picture.height, channels,
                              is_gain ? LENSPROF_MAP_GAIN : LENSPROF_MAP_ATTENUATION, values.data()};
    options.map = &map;
    import(path, "", options, take_part, &parts);
}

// The bytes of the tag, and what they apply to.
std::string opcodes_of(const std::string &path, lensprof_import_options &options) {
    const OpcodeLists lists = read_opcode_lists(path);
    const std::vector<uint8_t> &list = lists.list3.empty() ? lists.list2 : lists.list3;
    if (list.empty())
        throw Failure(LENSPROF_ERROR_READ, path + ": has no DNG opcode list; give a picture that has one");
    const bool of_mosaic = lists.list3.empty();
    if (of_mosaic && lists.layout == UINT32_MAX)
        throw Failure(LENSPROF_ERROR_READ,
                      path + ": its mosaic is not red, green, green and blue; give another picture");
    if (of_mosaic || lists.layout == LENSPROF_LAYOUT_GREY) options.layout = lists.layout;
    options.width = lists.width, options.height = lists.height;
    return {list.begin(), list.end()};
}

bool is_packet_alone(const std::string &path) {
    return path.size() > 4 && path.compare(path.size() - 4, 4, ".xmp") == 0;
}

// The XMP packet of a picture, or of a standalone file.
std::string packet_of(const std::string &path, const ForeignOptions &o, lensprof_import_options &options) {
    const bool is_packet = is_packet_alone(path);
    if (is_packet) require_frame(path, o);
    const std::string packet = is_packet ? read_text(path, max_text_bytes) : read_xmp_packet(path);
    if (packet.empty())
        throw Failure(LENSPROF_ERROR_READ, path + ": has no XMP, where drone cameras describe their falloff; give "
                                                   "the original picture");
    if (is_packet || o.width) return packet;
    const PictureSize size = read_size(path);
    options.width = size.width, options.height = size.height;
    return packet;
}

// Completes camera, lens and setting from the picture's EXIF. A standalone packet has no EXIF.
void complete_key(lensprof_profile_key &key, const std::string &path) {
    const lensprof_profile_key exif = read_metadata(path).key;
    const auto fill_text = [](auto &target, const auto &source) {
        if (!*target) std::copy(std::begin(source), std::end(source), target);
    };
    const auto fill = [](double &target, double source) {
        if (target == LENSPROF_UNKNOWN) target = source;
    };
    if (!*key.camera_model) fill_text(key.camera_maker, exif.camera_maker);
    fill_text(key.camera_model, exif.camera_model);
    fill_text(key.lens, exif.lens);
    fill(key.crop_factor, exif.crop_factor);
    fill(key.focal_mm, exif.focal_mm);
    fill(key.aperture, exif.aperture);
    fill(key.distance_m, exif.distance_m);
}

}  // namespace

void read_profiles(const ForeignRule &rule, const std::string &path, lensprof_import_visitor visit, void *user) {
    lensprof_import_options options = options_of(rule, {});
    const std::string text = read_text(path, max_text_bytes), name = name_of(path);
    options.name = name.c_str();
    import(path, text, options, visit, user);
}

void read_cameras(const std::string &path, lensprof_camera_visitor visit, void *user) {
    lensprof_error error{};
    const std::string text = read_text(path, max_text_bytes);
    check(lensprof_lensfun_read_cameras(text.data(), text.size(), name_of(path).c_str(), visit, user, &error), path,
          &error);
}

double read_part(const ForeignRule &rule, const std::string &path, const ForeignOptions &o, lensprof_profile &profile) {
    Parts parts{profile};
    lensprof_import_options options = options_of(rule, o);
    const std::string name = name_of(path);
    options.name = name.c_str();
    lensprof_profile_key key = profile.key;
    const bool is_picture = rule.format == LENSPROF_FORMAT_DNG_OPCODES
                            || (rule.format == LENSPROF_FORMAT_DRONE_XMP && !is_packet_alone(path));
    if (is_picture) complete_key(key, path);
    options.key = &key;
    if (rule.format == LENSPROF_FORMAT_MAP) {
        read_map(path, o, options, parts);
        return 0.0;
    }
    if (rule.format == LENSPROF_FORMAT_ALSC) require_frame(path, o);
    const std::string bytes = rule.format == LENSPROF_FORMAT_DNG_OPCODES ? opcodes_of(path, options)
                              : rule.format == LENSPROF_FORMAT_DRONE_XMP ? packet_of(path, o, options)
                                                                         : read_text(path, max_text_bytes);
    import(path, bytes, options, take_part, &parts);
    return parts.change;
}

}  // namespace lensprof
