#include "formats/any/detect.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr size_t kHead = 8192;  // bytes that tell

constexpr lensprof_format_info kFormats[] = {
    {LENSPROF_FORMAT_LENSFUN, LENSPROF_HOLDS_PROFILES, 1, 1, "lensfun", "Lensfun database (.xml): falloffs of lenses"},
    {LENSPROF_FORMAT_LCP, LENSPROF_HOLDS_PROFILES, 1, 1, "lcp", "Adobe lens profile (.lcp): falloffs of one lens"},
    {LENSPROF_FORMAT_JSON, LENSPROF_HOLDS_PROFILES, 1, 1, "json", "lensprof's JSON (.json): complete profiles"},
    {LENSPROF_FORMAT_BLOB, LENSPROF_HOLDS_PROFILES, 1, 0, "blob", "lensprof's blob for firmware (.blob): one profile"},
    {LENSPROF_FORMAT_DNG_OPCODES, LENSPROF_HOLDS_FALLOFF, 1, 0, "opcodes",
     "DNG opcodes in a DNG or TIFF (.dng): falloff"},
    {LENSPROF_FORMAT_DRONE_XMP, LENSPROF_HOLDS_FALLOFF, 0, 0, "xmp",
     "XMP of MicaSense, Parrot, DJI, in a picture or separate (.xmp): falloff"},
    {LENSPROF_FORMAT_ALSC, LENSPROF_HOLDS_FALLOFF, 1, 0, "alsc",
     "Raspberry Pi tuning file (rpi.alsc in .json): falloff"},
    {LENSPROF_FORMAT_MAP, LENSPROF_HOLDS_FALLOFF, 1, 0, "map",
     "map as picture: vignette.png, gain image (.tif): falloff"},
    {LENSPROF_FORMAT_PCALIB, LENSPROF_HOLDS_RESPONSE, 1, 0, "pcalib", "pcalib.txt of visual odometry (.txt): response"},
    {LENSPROF_FORMAT_CURVES, LENSPROF_HOLDS_RESPONSE, 1, 0, "curves",
     "table of OpenCV, AliceVision, pfstools (.csv, .m): response"},
    {LENSPROF_FORMAT_RADICAL_RESPONSE, LENSPROF_HOLDS_RESPONSE, 1, 0, "crf", "radical (.crf): response"},
    {LENSPROF_FORMAT_RADICAL_VIGNETTING, LENSPROF_HOLDS_FALLOFF, 1, 0, "vgn", "radical (.vgn): falloff"},
    {LENSPROF_FORMAT_CUBE, LENSPROF_HOLDS_RESPONSE, 1, 0, "cube",
     "one-dimensional table of Adobe, Resolve, FFmpeg (.cube): response"},
    {LENSPROF_FORMAT_GLSL, LENSPROF_HOLDS_PROFILES, 2, 0, "glsl", "functions for OpenGL, WebGL (.glsl): one profile"},
    {LENSPROF_FORMAT_WGSL, LENSPROF_HOLDS_PROFILES, 2, 0, "wgsl", "functions for WebGPU (.wgsl): one profile"},
    {LENSPROF_FORMAT_C, LENSPROF_HOLDS_PROFILES, 2, 0, "c",
     "header of C for firmware, with the blob (.h): one profile"}};

struct Ending {
    std::string_view end;
    uint32_t format;
};
constexpr Ending kEndings[] = {{"xml", LENSPROF_FORMAT_LENSFUN},
                               {"lcp", LENSPROF_FORMAT_LCP},
                               {"json", LENSPROF_FORMAT_JSON},
                               {"blob", LENSPROF_FORMAT_BLOB},
                               {"dng", LENSPROF_FORMAT_DNG_OPCODES},
                               {"xmp", LENSPROF_FORMAT_DRONE_XMP},
                               {"png", LENSPROF_FORMAT_MAP},
                               {"tif", LENSPROF_FORMAT_MAP},
                               {"tiff", LENSPROF_FORMAT_MAP},
                               {"txt", LENSPROF_FORMAT_PCALIB},
                               {"csv", LENSPROF_FORMAT_CURVES},
                               {"m", LENSPROF_FORMAT_CURVES},
                               {"crf", LENSPROF_FORMAT_RADICAL_RESPONSE},
                               {"vgn", LENSPROF_FORMAT_RADICAL_VIGNETTING},
                               {"cube", LENSPROF_FORMAT_CUBE},
                               {"glsl", LENSPROF_FORMAT_GLSL},
                               {"wgsl", LENSPROF_FORMAT_WGSL},
                               {"h", LENSPROF_FORMAT_C}};

std::string ending_of(std::string_view name) {
    const size_t dot = name.rfind('.'), slash = name.rfind('/');
    if (dot == std::string_view::npos || (slash != std::string_view::npos && dot < slash)) return "";
    std::string end(name.substr(dot + 1));
    for (char &c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return end;
}

bool begins(std::string_view data, std::string_view with) { return data.substr(0, with.size()) == with; }
bool has(std::string_view data, std::string_view part) { return data.find(part) != std::string_view::npos; }

// A line that begins with a word.
bool has_line(std::string_view data, std::string_view word) {
    LineReader lines(data);
    while (lines.next())
        if (begins(lines.line, word)) return true;
    return false;
}

bool is_tiff(std::string_view data) {
    using namespace std::string_view_literals;
    return begins(data, "II*\0"sv) || begins(data, "MM\0*"sv);
}
bool is_png(std::string_view data) { return begins(data, "\x89PNG"); }
bool is_jpeg(std::string_view data) { return begins(data, "\xFF\xD8"); }

// What the first bytes tell for sure; AUTO where they leave it to the name.
uint32_t format_of_content(std::string_view head, std::string_view name) {
    if (begins(head, "LPRF")) return LENSPROF_FORMAT_BLOB;
    if (begins(head, "\xEF\xBB\xBF")) head.remove_prefix(3);  // byte order mark of UTF-8
    // Before words are looked for: a text within JSON may hold any of them.
    const size_t first = head.find_first_not_of(" \t\r\n");
    if (first != std::string_view::npos && head[first] == '{')
        return has(head, "\"luminance_lut\"") || has(head, "\"rpi.") ? LENSPROF_FORMAT_ALSC : LENSPROF_FORMAT_JSON;
    if (has(head, "<lensdatabase")) return LENSPROF_FORMAT_LENSFUN;
    if (has(head, "CameraProfiles")) return LENSPROF_FORMAT_LCP;
    if (has(head, "VignettingModel")) return LENSPROF_FORMAT_RADICAL_VIGNETTING;
    if (is_png(head)) return LENSPROF_FORMAT_MAP;
    if (is_tiff(head)) return ending_of(name) == "dng" ? LENSPROF_FORMAT_DNG_OPCODES : LENSPROF_FORMAT_MAP;
    if (ending_of(name) == "lcp") return LENSPROF_FORMAT_LCP;
    if (is_jpeg(head) || has(head, "<x:xmpmeta") || has(head, "<?xpacket")) return LENSPROF_FORMAT_DRONE_XMP;
    if (has_line(head, "LUT_1D_SIZE") || has_line(head, "LUT_3D_SIZE")) return LENSPROF_FORMAT_CUBE;
    return has(head, "# name:") ? LENSPROF_FORMAT_CURVES : LENSPROF_FORMAT_AUTO;
}

}  // namespace

uint32_t format_of_name(std::string_view name) {
    const std::string end = ending_of(name);
    const auto found =
        std::find_if(std::begin(kEndings), std::end(kEndings), [&](const Ending &ending) { return ending.end == end; });
    return found == std::end(kEndings) ? static_cast<uint32_t>(LENSPROF_FORMAT_AUTO) : found->format;
}

uint32_t detect_format(std::string_view data, std::string_view name) {
    const uint32_t format = format_of_content(data.substr(0, kHead), name);
    return format ? format : format_of_name(name);
}

bool is_picture(std::string_view data) { return is_png(data) || is_jpeg(data) || is_tiff(data); }

bool is_read_only(std::string_view name) { return ending_of(name) == "m"; }

}  // namespace lensprof

using namespace lensprof;

const lensprof_format_info *lensprof_format_get_info(uint32_t format) {
    return format && format <= std::size(kFormats) ? &kFormats[format - 1] : nullptr;
}

uint32_t lensprof_format_detect(const void *data, size_t size, const char *name) {
    try {
        return detect_format(view_of(data, data ? size : 0), name ? name : "");
    } catch (const std::bad_alloc &) {
        return LENSPROF_FORMAT_AUTO;
    }
}
