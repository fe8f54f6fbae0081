// Files of other programs, read.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "cli/pictures/metadata.hpp"
#include "cli/pictures/opcode_tag.hpp"
#include "cli/pictures/picture.hpp"
#include "cli/profiles/foreign_file.hpp"
#include "cli/profiles/profile_blob.hpp"
#include "cli/program/format.hpp"
#include "cli/program/input_file.hpp"
#include "cli/program/library.hpp"
#include "cli/report/report.hpp"

namespace lensprof {
namespace {

std::string name_of(const std::string &path) {
    const size_t slash = path.rfind('/');
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

// Takes the falloff of an entry, what it doubts, and the texts of its key that are not known yet.
lensprof_status take_falloff(void *user, const lensprof_import_entry *entry) {
    lensprof_profile &profile = *static_cast<lensprof_profile *>(user);
    const lensprof_profile &found = *entry->profile;
    profile.vignettings = found.vignettings;
    std::memcpy(profile.vignetting, found.vignetting, sizeof profile.vignetting);
    profile.grid = found.grid;
    std::memcpy(profile.provenance.doubt, found.provenance.doubt, sizeof profile.provenance.doubt);
    const auto fill = [](char *own, const char *theirs, size_t size) {
        if (!*own) std::memcpy(own, theirs, size);
    };
    fill(profile.key.camera_maker, found.key.camera_maker, sizeof profile.key.camera_maker);
    fill(profile.key.camera_model, found.key.camera_model, sizeof profile.key.camera_model);
    return LENSPROF_OK;
}

void set_responses(const lensprof_response *responses, uint32_t count, lensprof_profile &profile) {
    profile.responses = count;
    for (uint32_t c = 0; c < count; c++) profile.response[c] = responses[c];
}

// A refit that is not exact is said with the profile.
void set_worst(double worst, lensprof_profile &profile) {
    constexpr double mentioned = 0.01;
    if (worst > mentioned && !*profile.provenance.doubt)
        set_text(profile.provenance.doubt, sizeof profile.provenance.doubt,
                 "its refit is off by up to " + std::to_string(std::lround(100.0 * worst)) + " %");
}

// An attenuation that rises is seldom one: a gain may have been taken for it.
void set_rise(lensprof_profile &profile) {
    constexpr double risen = 1.05;
    double highest = 1.0;
    for (uint32_t c = 0; c < profile.vignettings; c++)
        for (int i = 1; i <= 20; i++)
            highest = std::max(highest, lensprof_vignetting_eval(&profile.vignetting[c], i / 20.0, nullptr));
    if (highest > risen)
        set_text(profile.provenance.doubt, sizeof profile.provenance.doubt,
                 "M rises to " + format("%.2f", highest) + ": is it a gain?");
}

// Width and height of the frame, which some files do not say.
void demand_frame(const std::string &path, const ForeignOptions &o) {
    if (!o.width || !o.height)
        throw Failure(ExitCode::usage, path + ": does not say how large the pictures are; give --frame WIDTHxHEIGHT");
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

void read_map(const std::string &path, const ForeignOptions &o, lensprof_profile &profile) {
    Picture picture = read_picture(path);
    const uint32_t channels = lensprof_layout_channels(picture.layout) == 3 ? 3 : 1;
    const std::vector<float> values = values_of(picture, channels);
    const bool is_gain = o.sense.empty() ? picture.sample == LENSPROF_SAMPLE_F32 : o.sense == "gain";
    const double shape = double(picture.width) / picture.height, wanted = o.width ? double(o.width) / o.height : shape;
    if (std::fabs(shape / wanted - 1.0) > 0.01)
        throw Failure(ExitCode::usage,
                      path + ": has another shape than --frame; give the size of the pictures that it is for");
    const lensprof_map map = {picture.width, picture.height, channels,
                              is_gain ? LENSPROF_MAP_GAIN : LENSPROF_MAP_ATTENUATION, values.data()};
    double worst = 0.0;
    lensprof_error error{};
    check(lensprof_map_read(&map, o.width ? o.width : picture.width, o.height ? o.height : picture.height, &profile,
                            &worst, &error),
          path, &error);
    set_worst(worst, profile);
}

void read_opcodes(const std::string &path, lensprof_profile &profile) {
    const OpcodeLists lists = read_opcode_lists(path);
    const std::vector<uint8_t> &list = lists.list3.empty() ? lists.list2 : lists.list3;
    if (list.empty())
        throw Failure(ExitCode::unreadable, path + ": has no opcode list of DNG; give a picture that has one");
    const bool of_mosaic = lists.list3.empty();
    if (of_mosaic && lists.layout == UINT32_MAX)
        throw Failure(ExitCode::unreadable,
                      path + ": its mosaic is none of red, green, green and blue; give another picture");
    const uint32_t layout =
        of_mosaic || lists.layout == LENSPROF_LAYOUT_GREY ? lists.layout : uint32_t(LENSPROF_LAYOUT_RGB);
    lensprof_error error{};
    check(lensprof_dng_opcodes_read(list.data(), list.size(), lists.width, lists.height, layout, nullptr, take_falloff,
                                    &profile, &error),
          path, &error);
}

void read_xmp(const std::string &path, const ForeignOptions &o, lensprof_profile &profile) {
    const bool is_packet = path.size() > 4 && path.compare(path.size() - 4, 4, ".xmp") == 0;
    if (is_packet) demand_frame(path, o);
    const std::string packet = is_packet ? read_text(path, largest_text) : read_xmp_packet(path);
    if (packet.empty())
        throw Failure(ExitCode::unreadable, path + ": has no XMP, in which drones' cameras describe their falloff");
    const PictureSize size = is_packet || o.width ? PictureSize{o.width, o.height} : read_size(path);
    lensprof_error error{};
    check(lensprof_drone_xmp_read(packet.data(), packet.size(), size.width, size.height, nullptr, take_falloff,
                                  &profile, &error),
          path, &error);
}

// A blob's samples are in single precision: they are no more the curve of its coefficients, but a table of their own,
// and a covariance of coefficients is of nothing.
void keep_samples(lensprof_profile &profile) {
    for (uint32_t c = 0; c < profile.responses; c++) {
        if (profile.response[c].kind == LENSPROF_RESPONSE_LINEAR) continue;
        if (profile.response[c].kind == LENSPROF_RESPONSE_EMOR) {
            profile.covariance_size = 0;
            std::memset(profile.covariance, 0, sizeof profile.covariance);
        }
        const std::vector<double> samples(profile.response[c].table,
                                          profile.response[c].table + LENSPROF_RESPONSE_SAMPLES);
        check(lensprof_response_set_table(&profile.response[c], samples.data(), LENSPROF_RESPONSE_SAMPLES), "response");
    }
}

}  // namespace

void read_profiles(const ForeignRule &rule, const std::string &path, lensprof_import_visitor visit, void *user) {
    lensprof_error error{};
    if (rule.format == ForeignFormat::blob) {
        BlobStamp stamp{};
        const auto profile = read_blob(path, stamp);
        keep_samples(*profile);
        const lensprof_import_entry entry = {profile.get(), 1, 0};
        check(visit(user, &entry), path, &error);
        return;
    }
    const std::string text = read_text(path, largest_text), name = name_of(path);
    const auto read = rule.format == ForeignFormat::lensfun ? lensprof_lensfun_read
                      : rule.format == ForeignFormat::lcp   ? lensprof_lcp_read
                                                            : lensprof_json_read;
    check(read(text.data(), text.size(), name.c_str(), visit, user, &error), path, &error);
}

namespace {

void read_any_part(const ForeignRule &rule, const std::string &path, const ForeignOptions &o,
                   lensprof_profile &profile) {
    if (rule.format == ForeignFormat::map) return read_map(path, o, profile);
    if (rule.format == ForeignFormat::opcodes) return read_opcodes(path, profile);
    if (rule.format == ForeignFormat::xmp) return read_xmp(path, o, profile);
    if (rule.format == ForeignFormat::alsc) demand_frame(path, o);
    const std::string text = read_text(path, largest_text);
    const auto responses = std::make_unique<lensprof_response[]>(3);
    uint32_t count = 1;
    double worst = 0.0;
    lensprof_error error{};
    lensprof_status status = LENSPROF_OK;
    switch (rule.format) {
    case ForeignFormat::pcalib: status = lensprof_pcalib_read(text.data(), text.size(), responses.get(), &error); break;
    case ForeignFormat::curves:
        status = lensprof_curves_read(text.data(), text.size(), o.curve, responses.get(), &count, &error);
        break;
    case ForeignFormat::crf:
        count = 3;
        status = lensprof_radical_response_read(text.data(), text.size(), responses.get(), &error);
        break;
    case ForeignFormat::vgn:
        status = lensprof_radical_vignetting_read(text.data(), text.size(), &profile, &worst, &error);
        break;
    default:
        status = lensprof_alsc_read(text.data(), text.size(), o.color_temperature_k, o.columns, o.rows, o.width,
                                    o.height, &profile, &worst, &error);
    }
    check(status, path, &error);
    if (rule.part == ForeignPart::response)
        set_responses(responses.get(), count, profile);
    else
        set_worst(worst, profile);
}

}  // namespace

void read_part(const ForeignRule &rule, const std::string &path, const ForeignOptions &o, lensprof_profile &profile) {
    read_any_part(rule, path, o, profile);
    if (rule.part == ForeignPart::falloff) set_rise(profile);
}

}  // namespace lensprof
