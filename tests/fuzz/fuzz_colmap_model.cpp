// Fuzzing COLMAP's sparse models, binary and text. Invariant for any bytes: consistent tracks are read, or a Failure
// gives the reason.
#include "fuzz_scene.hpp"

namespace {

using namespace lensprof;

const char *const kTarget = "fuzz_colmap_model";
const std::vector<std::string> kWords = {
    std::string(4, '\0'),  "\xFF\xFF\xFF\xFF", "\x7F", "\x80", kNextFile, "-1", "nan", "1e99", "\n", " ",
    "18446744073709551615"};

bool try_bytes(const std::vector<char> &bytes) {
    static const Folder folders[2];
    const bool is_text = !bytes.empty() && bytes[0] == '#';
    const std::string end = is_text ? ".txt" : ".bin";
    folders[is_text].write_parts(bytes, {"cameras" + end, "images" + end, "points3D" + end});
    if (!is_colmap_model(folders[is_text].path())) return false;
    return try_scene([&] { return read_colmap_model(folders[is_text].path()); });
}

}  // namespace
