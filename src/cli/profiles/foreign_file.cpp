#include "cli/profiles/foreign_file.hpp"

#include <cctype>

#include "photo/base/file_kind.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/opcode_tag.hpp"

namespace lensprof {
namespace {

std::string extension_of(const std::string &path) {
    const size_t dot = path.rfind('.'), slash = path.rfind('/');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "";
    std::string end = path.substr(dot + 1);
    for (char &c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return end;
}

const ForeignRule &rule_of(uint32_t format) {
    if (const ForeignRule *rule = lensprof_format_get_info(format)) return *rule;
    throw Failure(LENSPROF_ERROR_WRITE, "internal error: a format without a rule; please report this");
}

const ForeignRule &rule_of_word(const std::string &word) {
    for (uint32_t format = 1; const ForeignRule *rule = lensprof_format_get_info(format); format++)
        if (word == rule->name) return *rule;
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  "--format " + word + ": unknown format; see `lensprof profile import --help`");
}

// Identifies a TIFF or DNG by its tags: opcodes, or XMP of a drone camera; AUTO if it has neither.
uint32_t format_of_tags(const std::string &path, const std::string &head) {
    const std::string magic = head.substr(0, 4);
    if (magic != std::string("II*\0", 4) && magic != std::string("MM\0*", 4)) return LENSPROF_FORMAT_AUTO;
    const OpcodeLists lists = read_opcode_lists(path);
    if (lists.raw || !lists.list2.empty() || !lists.list3.empty()) return LENSPROF_FORMAT_DNG_OPCODES;
    const bool has_falloff = read_xmp_packet(path).find("Vignetting") != std::string::npos;
    return has_falloff ? LENSPROF_FORMAT_DRONE_XMP : LENSPROF_FORMAT_AUTO;
}

}  // namespace

bool is_offered(const ForeignRule &rule, bool to_write) {
    constexpr uint32_t written_only = 2;  // lensprof_format_info.is_written
    return to_write ? rule.is_written != 0 : rule.is_written != written_only;
}

std::string about_foreign(bool to_write) {
    std::string text = "Formats:\n";
    for (uint32_t format = 1; const ForeignRule *rule = lensprof_format_get_info(format); format++)
        if (is_offered(*rule, to_write))
            text += "  " + (std::string(rule->name) + std::string(10, ' ')).substr(0, 10) + rule->about + "\n";
    return text;
}

const ForeignRule &format_to_read(const std::string &path, const std::string &format_name) {
    require_regular_file(path);
    if (!format_name.empty()) return rule_of_word(format_name);
    const std::string head = read_head(path, 8192);
    refuse_other_kind(path);
    uint32_t format = format_of_tags(path, head);
    if (!format) format = lensprof_format_detect(head.data(), head.size(), path.c_str());
    if (!format)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": the format cannot be identified from content or name; give it with --format");
    const ForeignRule &rule = rule_of(format);
    if (!is_offered(rule, false))
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": " + rule.name
                                                   + " is supported for export only; export JSON or a blob to read a "
                                                     "profile again");
    return rule;
}

const ForeignRule &format_to_write(const std::string &path, const std::string &format_name) {
    const uint32_t named = lensprof_format_detect(nullptr, 0, path.c_str());
    if (format_name.empty() && !named)
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": the name does not identify a format; give it with --format");
    const ForeignRule *rule = format_name.empty() ? &rule_of(named) : &rule_of_word(format_name);
    if (extension_of(path) == "m" && rule->format == LENSPROF_FORMAT_CURVES)
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": the format of pfstools is supported for import only; use a name "
                                              "ending in .csv");
    if (!rule->is_written)
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": " + rule->name + " is supported for import only; choose another "
                                                                  "--format");
    return *rule;
}

}  // namespace lensprof
