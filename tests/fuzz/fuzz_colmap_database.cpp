// Fuzzing COLMAP's database.db. Invariant for any bytes: consistent tracks are read, or a Failure gives the reason.
#include "fuzz_scene.hpp"

namespace {

using namespace lensprof;

const char *const kTarget = "fuzz_colmap_database";
const std::vector<std::string> kWords = {std::string(4, '\0'),
                                         "\xFF\xFF\xFF\xFF",
                                         "\x7F",
                                         "\x80",
                                         "cameras",
                                         "images",
                                         "keypoints",
                                         "two_view_geometries",
                                         "name",
                                         "NOT NULL",
                                         "BLOB",
                                         "rows",
                                         "CREATE",
                                         "VIEW",
                                         "\x08",
                                         "\x01\x02"};

bool try_bytes(const std::vector<char> &bytes) {
    static const Folder folder;
    folder.write("database.db", std::string(bytes.begin(), bytes.end()));
    const std::string path = folder.path("database.db");
    is_colmap_database(path);
    Reconstruction model;
    model.images.push_back({"im0.png", 0, false, {}});
    model.observations.emplace_back();
    is_done([&] { take_shapes(path, model); });
    return try_scene([&] { return read_colmap_database(path); });
}

}  // namespace
