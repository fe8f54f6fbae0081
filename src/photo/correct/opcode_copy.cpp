#include "photo/correct/opcode_copy.hpp"

#include <cstdint>
#include <vector>

#include "photo/base/library.hpp"
#include "photo/pictures/opcode_tag.hpp"

namespace lensprof {
namespace {

// Whether a list has an opcode for which `is_match` is true.
template <typename Is>
bool has_opcode(const std::vector<uint8_t> &list, const Is &is_match) {
    const auto word = [&](size_t offset) {
        uint32_t value = 0;
        for (size_t i = 0; i < 4; i++) value = value << 8 | (offset + i < list.size() ? list[offset + i] : 0);
        return value;
    };
    for (size_t offset = 4; offset + 16 <= list.size(); offset += 16 + size_t(word(offset + 12)))
        if (is_match(word(offset))) return true;
    return false;
}

bool is_gain(uint32_t id) { return id == 3 || id == 9; }  // FixVignetteRadial, GainMap

// Other opcodes of a picture must stay, and a falloff must not be corrected twice.
void require_no_other_opcodes(const std::string &path, const OpcodeLists &lists) {
    if (has_opcode(lists.list2, is_gain))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": its OpcodeList2 already corrects the falloff; give another picture");
    if (has_opcode(lists.list3, [](uint32_t id) { return !is_gain(id); }))
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": its OpcodeList3 has other corrections (such as distortion), which "
                                              "would be lost; give a picture without them");
}

}  // namespace

// From one picture to another, or in place.
void write_opcodes_as(const std::string &path, const std::string &path_out, lensprof_export_options options,
                      const lensprof_profile &profile) {
    const OpcodeLists lists = read_opcode_lists(path);
    require_no_other_opcodes(path, lists);
    // after demosaicing there are three channels; linear raw images and plain TIFF have three from the start
    if (lists.layout == LENSPROF_LAYOUT_GREY) options.layout = lists.layout;
    options.width = lists.width, options.height = lists.height;
    const std::string bytes = exported(path, {&profile}, options);
    write_opcode_list(path, path_out, tag_opcode_list3, {bytes.begin(), bytes.end()});
}

bool has_falloff_opcode(const std::string &path) {
    const OpcodeLists lists = read_opcode_lists(path);
    return has_opcode(lists.list2, is_gain) || has_opcode(lists.list3, is_gain);
}

void write_opcodes(const std::string &path_in, const std::string &path_out, const lensprof_profile &profile) {
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = LENSPROF_FORMAT_DNG_OPCODES;
    write_opcodes_as(path_in, path_out, options, profile);
}

}  // namespace lensprof
