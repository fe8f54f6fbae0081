// Fuzzing AliceVision's .sfm and OpenMVG's sfm_data.json. Invariant for any bytes: consistent tracks are read, or a
// Failure gives the reason.
#include "fuzz_scene.hpp"

namespace {

using namespace lensprof;

const char *const kTarget = "fuzz_sfm_json";
const std::vector<std::string> kWords = {
    "null", "[]", "{}",      "\"\"", "-1", "1e999", "\"nan\"", "\"x\"",
    "[[[[", ":",  "\\u0000", "true", ",",  "\"X\"", "\xFF",    "99999999999999999999"};

bool try_bytes(const std::vector<char> &bytes) {
    static const Folder folder;
    const std::string text(bytes.begin(), bytes.end());
    folder.write("cameras.sfm", text), folder.write("sfm_data.json", text);
    is_alicevision(folder.path("cameras.sfm")), is_openmvg(folder.path("sfm_data.json"));
    const bool is_one = try_scene([&] { return read_alicevision(folder.path("cameras.sfm")); });
    return try_scene([&] { return read_openmvg(folder.path("sfm_data.json")); }) || is_one;
}

}  // namespace
