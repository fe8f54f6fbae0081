// Files of any format, read.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/sized.h"
#include "falloff/rise.hpp"
#include "formats/any/detect.hpp"
#include "formats/drone_xmp.hpp"
#include "formats/each_format.h"
#include "formats/falloff/import.hpp"
#include "formats/responses.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr size_t kFirstImport = LP_END_OF(lensprof_import_options, key);
constexpr size_t kMaxBytes = size_t{64} << 20;

// A file whose format is known.
struct Input {
    const void *data;
    size_t size;
    lensprof_import_options options;
};

// A profile of a response or a falloff.
struct Part {
    lensprof_profile profile;
    uint32_t usable = 1;
    Repair repair;
};

// Takes the falloff of an entry, its doubt, and the texts of its key that are not known yet.
lensprof_status take_falloff(void *user, const lensprof_import_entry *entry) {
    Part &part = *static_cast<Part *>(user);
    lensprof_profile &profile = part.profile;
    const lensprof_profile &found = *entry->profile;
    part.usable = entry->usable;
    profile.vignettings = found.vignettings;
    std::copy_n(found.vignetting, 3, profile.vignetting);
    profile.grid = found.grid;
    profile.image_circle = found.image_circle;
    std::copy_n(found.provenance.doubt, sizeof profile.provenance.doubt, profile.provenance.doubt);
    if (!*profile.key.camera_maker)
        std::copy_n(found.key.camera_maker, sizeof profile.key.camera_maker, profile.key.camera_maker);
    if (!*profile.key.camera_model)
        std::copy_n(found.key.camera_model, sizeof profile.key.camera_model, profile.key.camera_model);
    return LENSPROF_OK;
}

void demand_frame(const lensprof_import_options &o) {
    if (!o.width || !o.height)
        throw FormatFailure{LENSPROF_ERROR_SIZE,
                            "the file does not contain the size of the pictures; give width and height of the frame"};
}

// Throws; a curve that was off by over kLargestDip is doubtful.
void read_response(const Input &in, Part &part) {
    constexpr double kLargestDip = 1.0;  // levels
    lensprof_profile &profile = part.profile;
    const std::string_view data = view_of(in.data, in.size);
    part.repair.is_allowed = !in.options.strict;
    switch (in.options.format) {
    case LENSPROF_FORMAT_PCALIB: profile.response[0] = read_pcalib(data, part.repair); break;
    case LENSPROF_FORMAT_CURVES:
        if (in.options.curve > LENSPROF_CURVE_FORWARD)
            throw FormatFailure{LENSPROF_ERROR_ARGUMENT, "the kind of curve is unknown; see lensprof_curve"};
        profile.responses = read_curves(data, in.options.curve, part.repair, profile.response);
        break;
    case LENSPROF_FORMAT_CUBE:
        profile.responses = read_cube(data, in.options.curve, part.repair, profile.response);
        break;
    default: profile.responses = 3; read_radical_responses(data, part.repair, profile.response);
    }
    char text[sizeof profile.provenance.doubt];
    std::snprintf(text, sizeof text, "the response decreased; made increasing by up to %.1f levels",
                  part.repair.change);
    if (part.repair.change > kLargestDip) put_text(profile.provenance.doubt, sizeof profile.provenance.doubt, text);
}

lensprof_status read_falloff(const Input &in, Part &part, lensprof_error *error) {
    const lensprof_import_options &o = in.options;
    double worst = 0.0;
    lensprof_status status = LENSPROF_OK;
    if (o.format != LENSPROF_FORMAT_RADICAL_VIGNETTING && !o.map) demand_frame(o);
    switch (o.format) {
    case LENSPROF_FORMAT_DNG_OPCODES:
        return lp_dng_opcodes_read(in.data, in.size, o.width, o.height, o.layout, nullptr, take_falloff, &part, error);
    case LENSPROF_FORMAT_DRONE_XMP:
        return read_drone_packet({in.data, in.size, o.width, o.height, nullptr, part.profile.key.camera_maker},
                                 take_falloff, &part, error);
    case LENSPROF_FORMAT_MAP:
        status = lp_map_read(o.map, o.width ? o.width : o.map->columns, o.height ? o.height : o.map->rows,
                             &part.profile, &worst, error);
        break;
    case LENSPROF_FORMAT_RADICAL_VIGNETTING:
        status = lp_radical_vignetting_read(in.data, in.size, &part.profile, &worst, error);
        break;
    default:
        status = lp_alsc_read(in.data, in.size, o.color_temperature_k, o.columns, o.rows, o.width, o.height,
                              &part.profile, &worst, error);
    }
    put_text(part.profile.provenance.doubt, sizeof part.profile.provenance.doubt, refit_remark(worst));
    return status;
}

// An attenuation that rises is seldom one: a gain may have been taken for it.
void doubt_rise(lensprof_profile &profile) {
    double highest = 1.0;
    for (uint32_t c = 0; c < profile.vignettings; c++)
        highest = std::max(highest, course_of(profile.vignetting[c]).highest.m);
    char text[sizeof profile.provenance.doubt];
    std::snprintf(text, sizeof text, "M rises to %.2f: is it a gain?", highest);
    if (highest > kLargestRise) put_text(profile.provenance.doubt, sizeof profile.provenance.doubt, text);
}

lensprof_profile_key key_of(const lensprof_import_options &o, bool is_response) {
    if (o.key) {
        const lensprof_status status = lensprof_profile_key_validate(o.key);
        if (status != LENSPROF_OK) throw FormatFailure{status, "the key is invalid; see lensprof_profile_key_validate"};
        return *o.key;
    }
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    if (!is_response) key.processing = LENSPROF_PROCESSING_RAW;
    return key;
}

// The one profile that a response or a falloff becomes.
lensprof_status import_part(const Input &in, uint32_t holds, lensprof_import_visitor visit, void *user,
                            lensprof_error *error) {
    const bool is_response = holds == LENSPROF_HOLDS_RESPONSE;
    lensprof_status done = LENSPROF_OK;
    const lensprof_status status = at_boundary(error, [&] {
        const auto part = std::make_unique<Part>();
        lensprof_profile &profile = part->profile;
        lensprof_profile_init(&profile);
        profile.key = key_of(in.options, is_response);
        set_import_provenance(profile, in.options.name, "");
        if (is_response)
            read_response(in, *part);
        else
            done = read_falloff(in, *part, error);
        if (done != LENSPROF_OK) return;
        if (!is_response && part->usable && !profile.provenance.doubt[0]) doubt_rise(profile);
        const lensprof_import_entry entry = {&profile, part->usable, holds, part->repair.change};
        done = visit(user, &entry);
    });
    return status == LENSPROF_OK ? done : status;
}

// A blob's samples are in single precision: they are no more the curve of its coefficients, but a table of their own,
// and a covariance of coefficients is of nothing.
void keep_samples(lensprof_profile &profile) {
    for (uint32_t c = 0; c < profile.responses; c++) {
        lensprof_response &response = profile.response[c];
        if (response.kind == LENSPROF_RESPONSE_LINEAR) continue;
        if (response.kind == LENSPROF_RESPONSE_EMOR) {
            profile.covariance_size = 0;
            std::fill(std::begin(profile.covariance), std::end(profile.covariance), 0.0);
        }
        const std::string wrong = "a response of the blob is invalid; write the blob again";
        const std::vector<double> samples(response.table, response.table + LENSPROF_RESPONSE_SAMPLES);
        const lensprof_status status =
            lensprof_response_set_table(&response, samples.data(), LENSPROF_RESPONSE_SAMPLES);
        if (status != LENSPROF_OK) throw FormatFailure{status, wrong};
    }
}

lensprof_status import_blob(const Input &in, lensprof_import_visitor visit, void *user, lensprof_error *error) {
    lensprof_status visited = LENSPROF_OK;
    const lensprof_status status = at_boundary(error, [&] {
        const auto profile = std::make_unique<lensprof_profile>();
        lensprof_profile_init(profile.get());
        const lensprof_status read = lensprof_profile_unpack(in.data, in.size, profile.get());
        if (read == LENSPROF_ERROR_LAYOUT)
            throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED, "is a blob of a newer lensprof; read it with that version"};
        if (read != LENSPROF_OK)
            throw FormatFailure{LENSPROF_ERROR_SYNTAX,
                                "is not a profile blob, or is damaged; copy it again, or write it again"};
        keep_samples(*profile);
        const lensprof_import_entry entry = {profile.get(), 1, LENSPROF_HOLDS_PROFILES, 0.0};
        visited = visit(user, &entry);
    });
    return status == LENSPROF_OK ? visited : status;
}

// Containers, whose bytes are not those of the format.
const char *container_of(uint32_t format, std::string_view data) {
    if (format == LENSPROF_FORMAT_MAP) return "is a picture; decode it and pass its values as a lensprof_map";
    if (!is_picture(data)) return nullptr;
    if (format == LENSPROF_FORMAT_DNG_OPCODES)
        return "is a TIFF or DNG file; pass the bytes of its tag OpcodeList2 or OpcodeList3";
    return format == LENSPROF_FORMAT_DRONE_XMP ? "is a picture; pass the XMP packet in it" : nullptr;
}

// What is wrong before any of the content is read; OK sets the format.
lensprof_status check_input(Input &in, lensprof_error *error) {
    const std::string_view data = view_of(in.data, in.size);
    return at_boundary(error, [&] {
        uint32_t &format = in.options.format;
        if (in.options.map && format == LENSPROF_FORMAT_MAP) return;
        if (in.options.map)
            throw FormatFailure{LENSPROF_ERROR_ARGUMENT, "a map without the format MAP; set both or neither"};
        if (data.empty()) throw FormatFailure{LENSPROF_ERROR_SYNTAX, "is empty; copy it again"};
        if (data.size() > kMaxBytes)
            throw FormatFailure{LENSPROF_ERROR_SIZE, "is larger than 64 MiB; check that it is the right file"};
        if (!format) format = detect_format(data, in.options.name ? in.options.name : "");
        if (!format)
            throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED,
                                "neither its content nor its name identifies its format; specify the format"};
        const lensprof_format_info *info = lensprof_format_get_info(format);
        if (!info) throw FormatFailure{LENSPROF_ERROR_ARGUMENT, "unknown format; pass a lensprof_format"};
        if (info->is_written == kWrittenOnly)
            throw FormatFailure{
                LENSPROF_ERROR_UNSUPPORTED,
                std::string(info->name) + " is written only; export JSON or a blob to read a profile again"};
        if (const char *container = container_of(format, data))
            throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED, container};
    });
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

void lensprof_import_options_init_sized(lensprof_import_options *options, size_t size) {
    if (!lp_sized_begin(options, size, kFirstImport)) return;
    options->layout = LENSPROF_LAYOUT_RGB;
    options->color_temperature_k = LENSPROF_UNKNOWN;
}

lensprof_status lensprof_import(const void *data, size_t size, const lensprof_import_options *options,
                                lensprof_import_visitor visit, void *user, lensprof_error *error) {
    if ((!data && size) || !visit) {
        set_error(error, "lensprof_import: data or visit is NULL; pass a buffer and a function");
        return LENSPROF_ERROR_ARGUMENT;
    }
    Input in = {data, size, {}};
    lensprof_import_options_init(&in.options);
    if (const char *wrong = options ? lp_sized_take(&in.options, options, kFirstImport) : nullptr) {
        set_error(error, wrong);
        return LENSPROF_ERROR_STRUCT_SIZE;
    }
    const lensprof_status status = check_input(in, error);
    if (status != LENSPROF_OK) return status;
    const char *const name = in.options.name;
    switch (in.options.format) {
    case LENSPROF_FORMAT_LENSFUN: return lp_lensfun_read(data, size, name, visit, user, error);
    case LENSPROF_FORMAT_LCP: return lp_lcp_read(data, size, name, visit, user, error);
    case LENSPROF_FORMAT_JSON: return lp_json_read(data, size, name, visit, user, error);
    case LENSPROF_FORMAT_BLOB: return import_blob(in, visit, user, error);
    default: return import_part(in, lensprof_format_get_info(in.options.format)->holds, visit, user, error);
    }
}
