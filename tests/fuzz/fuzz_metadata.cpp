// Fuzzing EXIF, XMP packets and opcode tags of picture files. Invariant for any bytes: each is read, or a Failure gives
// the reason; a key that is read is valid.
#include "fuzz_file.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/opcode_tag.hpp"

namespace {

using namespace lensprof;

const char *const kTarget = "fuzz_metadata";
const std::vector<std::string> kWords = {
    std::string(4, '\0'), "\xFF\xFF\xFF\xFF", "\xFF\xE1", "Exif",     "II*",      "MM",
    "\x9A\x82",           "\x9D\x82",         "\x27\x88", "\x69\x87", "\x4A\x01", "\x41\xC7",
    "\x4E\xC7",           "<x:xmpmeta",       "&#0;",     "W5M0Mp",   "\x80",     "\x7F"};

bool try_bytes(const std::vector<char> &bytes) {
    const MemoryFile file(bytes);
    const bool read = is_read([&] {
        const PictureMetadata metadata = read_metadata(file.path());
        demand(lensprof_profile_key_validate(&metadata.key) == LENSPROF_OK || !metadata.key.camera_model[0],
               "an invalid key");
    });
    is_read([&] { read_xmp_packet(file.path()); });
    is_read([&] { read_opcode_lists(file.path()); });
    return read;
}

}  // namespace
