// Fuzzing OpenSfM's tracks.csv and reconstruction.json. Invariant for any bytes: consistent tracks are read, or a
// Failure gives the reason.
#include "fuzz_scene.hpp"

namespace {

using namespace lensprof;

const char *const kTarget = "fuzz_opensfm";
const std::vector<std::string> kWords = {"\t",   "\t\t", "\n",     "-1",          "nan",        "1e999",   "_v1",
                                         "null", "[]",   "\"\\u0", "\"cameras\"", "\"points\"", kNextFile, "\xFF"};

bool try_bytes(const std::vector<char> &bytes) {
    static const Folder folder;
    folder.write_parts(bytes, {"tracks.csv", "reconstruction.json"});
    is_opensfm_tracks(folder.path("tracks.csv"));
    return try_scene([&] { return read_opensfm(folder.path("tracks.csv")); });
}

}  // namespace
