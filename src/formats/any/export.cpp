// Files of any format, written.
#include <algorithm>
#include <string>

#include "core/sized.h"
#include "formats/any/detect.hpp"
#include "formats/each_format.h"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr size_t kFirstExport = LP_END_OF(lensprof_export_options, name);
constexpr size_t kMaxBytes = size_t{64} << 20;  // as lensprof_import
constexpr double kNearEnough = 0.005;           // error of a radial opcode that is taken
constexpr uint32_t kColumns = 16, kRows = 12, kCurveRows = 256, kCubeRows = 1024;

// Where a file goes.
struct Output {
    void *data;
    size_t capacity;
    size_t *count;
    lensprof_error *error;
};

// One opcode of a radial falloff where that comes near enough, else a map.
lensprof_status write_opcodes(const lensprof_profile &profile, const lensprof_export_options &o, const Output &out) {
    const auto write = [&](uint32_t form, void *data, size_t capacity, size_t *count, double *worst) {
        return lp_dng_opcodes_write(&profile, o.width, o.height, o.layout, form, data, capacity, count, worst,
                                    out.error);
    };
    uint32_t form = o.dng_form;
    if (form == LENSPROF_DNG_AUTO) {
        double worst = 0.0;
        const lensprof_status radial = write(LENSPROF_DNG_RADIAL, nullptr, 0, nullptr, &worst);
        const bool is_radial = radial == LENSPROF_OK && worst <= kNearEnough;
        form = is_radial ? LENSPROF_DNG_RADIAL : LENSPROF_DNG_GAIN_MAP;
    }
    return write(form, out.data, out.capacity, out.count, nullptr);
}

lensprof_status write_blob(const lensprof_profile &profile, const lensprof_export_options &o, const Output &out) {
    set_error(out.error, "");
    const lensprof_status status = lensprof_profile_pack(&profile, o.pack, out.data, out.capacity, out.count);
    if (status == LENSPROF_ERROR_CAPACITY)
        set_error(out.error, "the buffer is too small; call with capacity 0 to get the size, then call again");
    else if (status != LENSPROF_OK)
        set_error(out.error, "the profile or the flags of the blob are invalid; see lensprof_profile_validate");
    return status;
}

lensprof_status write_one(const lensprof_profile &p, const lensprof_export_options &o, const Output &out) {
    switch (o.format) {
    case LENSPROF_FORMAT_BLOB: return write_blob(p, o, out);
    case LENSPROF_FORMAT_DNG_OPCODES: return write_opcodes(p, o, out);
    case LENSPROF_FORMAT_PCALIB:  // one curve: green's of three
        return lp_pcalib_write(&p.response[p.responses / 2], out.data, out.capacity, out.count, out.error);
    case LENSPROF_FORMAT_CURVES:
        return lp_curves_write(p.response, p.responses, o.curve, o.rows ? o.rows : kCurveRows, out.data, out.capacity,
                               out.count, out.error);
    case LENSPROF_FORMAT_CUBE:
        return lp_cube_write(&p, o.curve, o.rows ? o.rows : kCubeRows, out.data, out.capacity, out.count, out.error);
    case LENSPROF_FORMAT_GLSL:
    case LENSPROF_FORMAT_WGSL: return lp_shader_write(&p, o.format, out.data, out.capacity, out.count, out.error);
    case LENSPROF_FORMAT_C: return lp_c_header_write(&p, out.data, out.capacity, out.count, out.error);
    case LENSPROF_FORMAT_RADICAL_RESPONSE:
        return lp_radical_response_write(p.response, p.responses, out.data, out.capacity, out.count, out.error);
    case LENSPROF_FORMAT_RADICAL_VIGNETTING:
        return lp_radical_vignetting_write(&p, o.width, o.height, out.data, out.capacity, out.count, out.error);
    default:
        return lp_alsc_write(&p, o.color_temperature_k, o.columns ? o.columns : kColumns, o.rows ? o.rows : kRows,
                             o.width, o.height, out.data, out.capacity, out.count, out.error);
    }
}

lensprof_status write_many(const lensprof_profile *const *profiles, uint32_t profile_count,
                           const lensprof_export_options &o, const Output &out) {
    size_t size = 0;
    const auto write = [&](void *data, size_t capacity, size_t *count) {
        if (o.format == LENSPROF_FORMAT_LENSFUN)
            return lp_lensfun_write(profiles, profile_count, &o, data, capacity, count, out.error);
        if (o.format == LENSPROF_FORMAT_LCP)
            return lp_lcp_write(profiles, profile_count, o.width, o.height, data, capacity, count, out.error);
        return lp_json_write(profiles, profile_count, data, capacity, count, out.error);
    };
    const lensprof_status status = write(out.data, std::min(out.capacity, kMaxBytes), &size);
    if (status != LENSPROF_OK && status != LENSPROF_ERROR_CAPACITY) return status;
    if (size > kMaxBytes) {
        set_error(out.error, "would be larger than 64 MiB, the limit for reading; write fewer profiles");
        return LENSPROF_ERROR_SIZE;
    }
    if (out.count) *out.count = size;
    return status;
}

// What is wrong before anything is written; OK sets the format.
lensprof_status check_output(uint32_t profile_count, lensprof_export_options &o, lensprof_error *error) {
    return at_boundary(error, [&] {
        const std::string_view name = o.name ? o.name : "";
        if (!o.format) {
            o.format = format_of_name(name);
            if (is_read_only(name))
                throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED, "pfstools' tables are read only; write .csv"};
        }
        if (!o.format)
            throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED, "its name does not identify a format; specify the format"};
        const lensprof_format_info *info = lensprof_format_get_info(o.format);
        if (!info) throw FormatFailure{LENSPROF_ERROR_ARGUMENT, "unknown format; pass a lensprof_format"};
        const std::string format = info->name;
        if (!info->is_written)
            throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED, format + " is read only; choose another format"};
        if (o.format == LENSPROF_FORMAT_MAP)
            throw FormatFailure{LENSPROF_ERROR_UNSUPPORTED,
                                "a map is a picture; get its values with lensprof_map_write and encode them"};
        if (!info->is_many && profile_count != 1)
            throw FormatFailure{LENSPROF_ERROR_ARGUMENT,
                                format + " holds one profile, not " + std::to_string(profile_count) + "; pass one"};
    });
}

lensprof_status check_profile(const lensprof_profile *profile, lensprof_error *error) {
    return at_boundary(error, [&] {
        const auto fail = [](const std::string &text, lensprof_status status) {
            throw failure_at(LENSPROF_ITEM_PROFILE, 0, text, status);
        };
        if (!profile) fail("is NULL; pass a profile", LENSPROF_ERROR_ARGUMENT);
        const lensprof_status status = lensprof_profile_validate(profile);
        if (status != LENSPROF_OK)
            fail(std::string("is invalid (") + lensprof_status_name(status) + "); see lensprof_profile_validate",
                 status);
    });
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

void lensprof_export_options_init_sized(lensprof_export_options *options, size_t size) {
    if (!lp_sized_begin(options, size, kFirstExport)) return;
    options->layout = LENSPROF_LAYOUT_RGB;
    options->dng_form = LENSPROF_DNG_AUTO;
    options->color_temperature_k = LENSPROF_UNKNOWN;
}

lensprof_status lensprof_export(const lensprof_profile *const *profiles, uint32_t profile_count,
                                const lensprof_export_options *options, void *data, size_t capacity, size_t *count,
                                lensprof_error *error) {
    if ((!profiles && profile_count) || !options || (!data && capacity)) {
        set_error(error, "lensprof_export: profiles, options or data is NULL; pass profiles, options and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    lensprof_export_options local_options;
    lensprof_export_options_init(&local_options);
    if (const char *wrong = lp_sized_take(&local_options, options, kFirstExport)) {
        set_error(error, wrong);
        return LENSPROF_ERROR_STRUCT_SIZE;
    }
    const lensprof_status status = check_output(profile_count, local_options, error);
    if (status != LENSPROF_OK) return status;
    const Output out = {data, capacity, count, error};
    if (lensprof_format_get_info(local_options.format)->is_many)
        return write_many(profiles, profile_count, local_options, out);
    const lensprof_status valid = check_profile(profiles[0], error);
    if (valid != LENSPROF_OK) return valid;
    return write_one(*profiles[0], local_options, out);
}
