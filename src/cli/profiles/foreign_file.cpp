#include "cli/profiles/foreign_file.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>

#include "cli/pictures/metadata.hpp"
#include "cli/pictures/opcode_tag.hpp"
#include "cli/program/input_file.hpp"
#include "cli/program/library.hpp"

namespace lensprof {
namespace {

std::string extension_of(const std::string &path) {
    const size_t dot = path.rfind('.'), slash = path.rfind('/');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "";
    std::string end = path.substr(dot + 1);
    for (char &c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return end;
}

struct Ending {
    const char *end;
    ForeignFormat format;
};
constexpr Ending endings[] = {
    {"xml", ForeignFormat::lensfun}, {"lcp", ForeignFormat::lcp},     {"json", ForeignFormat::json},
    {"blob", ForeignFormat::blob},   {"dng", ForeignFormat::opcodes}, {"xmp", ForeignFormat::xmp},
    {"png", ForeignFormat::map},     {"tif", ForeignFormat::map},     {"tiff", ForeignFormat::map},
    {"txt", ForeignFormat::pcalib},  {"csv", ForeignFormat::curves},  {"m", ForeignFormat::curves},
    {"crf", ForeignFormat::crf},     {"vgn", ForeignFormat::vgn}};

const ForeignRule *rule_of_name(const std::string &path) {
    const std::string end = extension_of(path);
    for (const Ending &ending : endings)
        if (end == ending.end) return &rule_of(ending.format);
    return nullptr;
}

const ForeignRule &rule_of_word(const std::string &word) {
    for (const ForeignRule &rule : foreign_rules())
        if (word == rule.name) return rule;
    throw Failure(ExitCode::usage, "--format " + word + ": is none; `lensprof profile import --help` lists them");
}

// The beginning of a file; empty where it cannot be read, which its reader will say.
std::string head_of(const std::string &path) {
    std::string head(8192, 0);
    std::ifstream file(path, std::ios::binary);
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<size_t>(std::max<std::streamsize>(file.gcount(), 0)));
    return head;
}

bool has(const std::string &text, const char *part) { return text.find(part) != std::string::npos; }

bool begins(const std::string &text, const char *bytes, size_t count) {
    return text.compare(0, count, bytes, count) == 0;
}

bool is_tiff(const std::string &head) { return begins(head, "II*\0", 4) || begins(head, "MM\0*", 4); }

// What the first bytes say for sure; NULL where they leave it to the name.
const ForeignRule *rule_of_content(const std::string &path, const std::string &head) {
    if (begins(head, "LPRF", 4)) return &rule_of(ForeignFormat::blob);
    if (has(head, "<lensdatabase")) return &rule_of(ForeignFormat::lensfun);
    if (has(head, "CameraProfiles")) return &rule_of(ForeignFormat::lcp);
    if (has(head, "VignettingModel")) return &rule_of(ForeignFormat::vgn);
    if (begins(head, "\x89PNG", 4)) return &rule_of(ForeignFormat::map);
    if (is_tiff(head)) {
        const OpcodeLists lists = read_opcode_lists(path);
        if (lists.raw || !lists.list2.empty() || !lists.list3.empty()) return &rule_of(ForeignFormat::opcodes);
        return has(read_xmp_packet(path), "Vignetting") ? &rule_of(ForeignFormat::xmp) : nullptr;
    }
    if (extension_of(path) == "lcp") return &rule_of(ForeignFormat::lcp);
    if (begins(head, "\xFF\xD8", 2) || has(head, "<x:xmpmeta") || has(head, "<?xpacket"))
        return &rule_of(ForeignFormat::xmp);
    const size_t first = head.find_first_not_of(" \t\r\n");
    if (first != std::string::npos && head[first] == '{')
        return &rule_of(has(head, "luminance_lut") || has(head, "rpi.") ? ForeignFormat::alsc : ForeignFormat::json);
    if (has(head, "# name:")) return &rule_of(ForeignFormat::curves);
    return nullptr;
}

}  // namespace

const std::vector<ForeignRule> &foreign_rules() {
    static const std::vector<ForeignRule> rules = {
        {ForeignFormat::lensfun, "lensfun", "Lensfun database (.xml): falloffs of lenses", ForeignPart::profiles, true},
        {ForeignFormat::lcp, "lcp", "Adobe lens profile (.lcp): falloffs of one lens", ForeignPart::profiles, true},
        {ForeignFormat::json, "json", "lensprof's JSON (.json): all of the profiles", ForeignPart::profiles, true},
        {ForeignFormat::blob, "blob", "lensprof's blob for firmware (.blob): one profile", ForeignPart::profiles, true},
        {ForeignFormat::opcodes, "opcodes", "DNG opcodes in a DNG or TIFF (.dng): falloff", ForeignPart::falloff, true},
        {ForeignFormat::xmp, "xmp", "XMP of MicaSense, Parrot, DJI, in a picture or alone (.xmp): falloff",
         ForeignPart::falloff, false},
        {ForeignFormat::alsc, "alsc", "Raspberry Pi tuning file (rpi.alsc in .json): falloff", ForeignPart::falloff,
         true},
        {ForeignFormat::map, "map", "map as picture: vignette.png, gain image (.tif): falloff", ForeignPart::falloff,
         true},
        {ForeignFormat::pcalib, "pcalib", "pcalib.txt of visual odometry (.txt): response", ForeignPart::response,
         true},
        {ForeignFormat::curves, "curves", "table of OpenCV, AliceVision, pfstools (.csv, .m): response",
         ForeignPart::response, true},
        {ForeignFormat::crf, "crf", "radical (.crf): response", ForeignPart::response, true},
        {ForeignFormat::vgn, "vgn", "radical (.vgn): falloff", ForeignPart::falloff, true}};
    return rules;
}

const ForeignRule &rule_of(ForeignFormat format) {
    for (const ForeignRule &rule : foreign_rules())
        if (rule.format == format) return rule;
    throw Failure(ExitCode::failed, "a format without a rule; please report it");
}

std::vector<std::string> foreign_names(bool written_only) {
    std::vector<std::string> names;
    for (const ForeignRule &rule : foreign_rules())
        if (rule.is_written || !written_only) names.push_back(rule.name);
    return names;
}

std::string about_foreign(bool written_only) {
    std::string text = "Formats:\n";
    for (const ForeignRule &rule : foreign_rules())
        if (rule.is_written || !written_only)
            text += "  " + (std::string(rule.name) + std::string(10, ' ')).substr(0, 10) + rule.about + "\n";
    return text;
}

const ForeignRule &format_to_read(const std::string &path, const std::string &wanted) {
    demand_ordinary(path);
    if (!wanted.empty()) return rule_of_word(wanted);
    const std::string head = head_of(path);
    if (const ForeignRule *rule = rule_of_content(path, head)) return *rule;
    if (const ForeignRule *rule = rule_of_name(path)) return *rule;
    read_text(path, 1 << 16);  // a missing file is said to be missing
    throw Failure(ExitCode::usage, path + ": neither its content nor its name tells its format; name it with --format");
}

const ForeignRule &format_to_write(const std::string &path, const std::string &wanted) {
    const ForeignRule *rule = wanted.empty() ? rule_of_name(path) : &rule_of_word(wanted);
    if (!rule) throw Failure(ExitCode::usage, path + ": its name does not tell a format; name it with --format");
    if (extension_of(path) == "m" && rule->format == ForeignFormat::curves)
        throw Failure(ExitCode::usage, path + ": pfstools' tables are read only; give it the ending .csv");
    if (!rule->is_written)
        throw Failure(ExitCode::usage, path + ": " + rule->name + " is read only; choose another --format");
    return *rule;
}

}  // namespace lensprof
