// A profile as constants of a C99 header, for firmware: its blob and the numbers of its falloff.
#include <cstdio>

#include "formats/each_format.h"

#include "formats/code/code_text.hpp"
#include "formats/falloff/export.hpp"

namespace lensprof {
namespace {

std::vector<uint8_t> blob_of(const lensprof_profile &profile) {
    size_t bytes = 0;
    lensprof_status status = lensprof_profile_pack(&profile, 0, nullptr, 0, &bytes);
    std::vector<uint8_t> blob(bytes);
    if (status == LENSPROF_OK) status = lensprof_profile_pack(&profile, 0, blob.data(), bytes, &bytes);
    demand_of_profile(status == LENSPROF_OK, 0,
                      std::string("is invalid (") + lensprof_status_name(status) + "); see lensprof_profile_validate",
                      status);
    return blob;
}

// The CRC-32 of a blob, its last four bytes.
std::string crc_of(const std::vector<uint8_t> &blob) {
    char text[9];
    const uint8_t *end = blob.data() + blob.size();
    std::snprintf(text, sizeof text, "%02X%02X%02X%02X", end[-1], end[-2], end[-3], end[-4]);
    return text;
}

std::string blob_text(const std::vector<uint8_t> &blob) {
    const std::string bytes = std::to_string(blob.size());
    std::string text = "static const uint8_t lensprof_profile_blob[" + bytes + "] = {";
    for (size_t i = 0; i < blob.size(); i++)
        text += (i % 24 ? " " : "\n    ") + std::to_string(blob[i]) + (i + 1 < blob.size() ? "," : "};\n");
    return text;
}

std::string comment_of(const lensprof_profile &profile) {
    std::vector<std::string> lines = head_lines(profile, "profile of a camera and lens");
    lines.insert(
        lines.end(),
        {"lensprof_profile_blob: for lensprof_apply_options.blob, at any address.",
         "Falloff, of red, green and blue: M = 1 + k1 r^2 + k2 r^4 + k3 r^6; a correction divides linear light",
         "by M. r: half diagonals of the frame, from the centre; centre: half diagonals to the right of and below",
         "the middle of the frame."});
    if (profile.grid.columns)
        lines.emplace_back("The falloff is multiplied by a gain grid, which only the blob holds.");
    if (profile.image_circle.radius != 0.0)
        lines.emplace_back("The lens lights up a circle, which only the blob holds; M counts inside of it.");
    std::string text = "/* ";
    for (size_t i = 0; i < lines.size(); i++) text += (i ? "\n * " : "") + lines[i];
    return text + " */\n";
}

std::string falloff_text(const lensprof_profile &profile) {
    const double *center = profile.vignetting[0].center;
    std::string text = "static const float lensprof_profile_center[2] = {" + float_text(center[0]) + "f, "
                       + float_text(center[1]) + "f};\n";
    for (int n = 0; n < 3; n++) {
        text += "static const float lensprof_profile_k" + std::to_string(n + 1) + "[3] = {";
        for (uint32_t c = 0; c < 3; c++)
            text += float_text(profile.vignetting[profile.vignettings == 3 ? c : 0].k[n]) + (c < 2 ? "f, " : "f};\n");
    }
    return text;
}

// The guard has the checksum: the headers of two profiles are not taken for one.
std::string header_text(const lensprof_profile &profile) {
    const std::vector<uint8_t> blob = blob_of(profile);
    const std::string guard = "LENSPROF_PROFILE_" + crc_of(blob) + "_H";
    return comment_of(profile) + "#ifndef " + guard + "\n#define " + guard + "\n\n#include <stdint.h>\n\n"
           + "#define LENSPROF_PROFILE_BLOB_BYTES " + std::to_string(blob.size()) + "\n" + blob_text(blob) + "\n"
           + falloff_text(profile) + "\n#endif\n";
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_c_header_write(const lensprof_profile *profile, void *data, size_t capacity, size_t *count,
                                  lensprof_error *error) {
    if (!profile || (!data && capacity)) {
        set_error(error, "lensprof_export: profile or data is NULL; pass a profile and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] { return header_text(*profile); });
}
