// Replaces the reader of maker notes if the program is built without Exiv2.
#include "photo/pictures/maker_notes.hpp"

namespace lensprof {

MakerNotes read_maker_notes(const std::string &, const PictureBlocks &) { return {}; }

std::string lens_of_number(const std::string &, const std::string &, const std::string &,
                           const std::optional<FocalRange> &) {
    return {};
}

std::optional<PictureBlocks> read_other_blocks(const std::string &) { return std::nullopt; }

}  // namespace lensprof
