// A Hugin project in memory: its text, and what the reader understood of it.
#pragma once

#include <array>
#include <bitset>
#include <string>
#include <string_view>
#include <vector>

#include <lensprof/hugin.h>

namespace lensprof {

// Numbers of an `i` line that may be links (`=N`).
enum PtoParameter : size_t {
    kHfov,
    kYaw,
    kPitch,
    kRoll,
    kRadialA,
    kRadialB,
    kRadialC,
    kShiftD,
    kShiftE,
    kShearG,
    kShearT,
    kTranslationX,
    kTranslationY,
    kTranslationZ,
    kPlaneYaw,
    kPlanePitch,
    kResponseA,
    kResponseB,
    kResponseC,
    kResponseD,
    kResponseE,
    kExposureValue,
    kRed,
    kBlue,
    kVignettingA,
    kVignettingB,
    kVignettingC,
    kVignettingD,
    kCenterX,
    kCenterY,
    kStack,
    kPtoParameters
};

struct PtoParameterInfo {
    std::string_view name;
    double fallback;  // where the line does not give it
    uint32_t free;    // LENSPROF_FREE_* that a `v` line with this name asks for
};

extern const std::array<PtoParameterInfo, kPtoParameters> kPtoParameterInfo;

// Index of a name, kPtoParameters if it is unknown.
size_t find_pto_parameter(std::string_view name);

// One item of a line: letters, then a number, `=N`, "text" with its quotes, or nothing.
struct PtoToken {
    std::string_view name, value;
    size_t begin;  // of the value in the line
};

// Begins a comment line that names images, by their numbers, of which the result in the project is without.
inline constexpr std::string_view kLeftOutMark = "#-lensprof left_out";
bool is_left_out_mark(std::string_view line);

// Splits a line after its record letter.
std::vector<PtoToken> split_pto_line(std::string_view line, size_t number);

// The first text in quotes of that name, without the quotes; empty if the line has no such text.
std::string_view find_pto_text(const std::vector<PtoToken> &tokens, std::string_view name);

// First token of that name (Hugin reads the first), or NULL.
const PtoToken *find_pto_token(const std::vector<PtoToken> &tokens, std::string_view name);

struct PtoImage {
    size_t line;           // number, from 1
    size_t begin, length;  // of the line in the text, without line end
    std::array<double, kPtoParameters> value;
    std::array<uint32_t, kPtoParameters> root;  // image at the end of the link, itself when not linked
    std::bitset<kPtoParameters> is_variable;    // on `v` lines, for links that end here
    uint32_t vignetting_mode;                   // Vm: 1 radial, 2 flat field, 4 divide
    std::string name;
    std::string renamed;  // the line with another name in it; empty when that of the text holds
    lensprof_pto_image result;
};

enum PtoMaskType : uint32_t {
    kMaskExclude,
    kMaskInclude,
    kMaskExcludeStack,
    kMaskIncludeStack,
    kMaskExcludeLens,
    kMaskTypes
};

struct PtoMask {
    size_t line;
    uint32_t image;
    uint32_t type;
    std::vector<std::array<double, 2>> corners;
};

}  // namespace lensprof

struct lensprof_pto {
    std::string text;
    std::vector<lensprof::PtoImage> images;
    std::vector<lensprof::PtoMask> masks;
};

namespace lensprof {

// Throws FormatFailure.
lensprof_pto parse_pto(std::string text);

// The frame of an image's falloff: the picture, or the crop.
struct PtoFalloffFrame {
    double half_diagonal;  // px
    double scale;          // of it, relative to that of the picture, which is Hugin's r = 1
    double offset[2];      // of its middle from that of the picture, px
};
PtoFalloffFrame falloff_frame(const lensprof_pto_image &image);

inline bool has_image(const lensprof_pto *pto, uint32_t index) { return pto && index < pto->images.size(); }

// ARGUMENT with a text for a call about an image that the project does not have, or with NULL for `message`.
lensprof_status fail_at_image(const lensprof_pto *pto, uint32_t index, const char *message, lensprof_error *error);

}  // namespace lensprof
