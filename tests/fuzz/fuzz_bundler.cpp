// Fuzzing Bundler's .out and its list of images. Invariant for any bytes: consistent tracks are read, or a Failure
// gives the reason.
#include "fuzz_scene.hpp"

namespace {

using namespace lensprof;

const char *const kTarget = "fuzz_bundler";
const std::vector<std::string> kWords = {" ",   "\n", "-1", "nan", "4294967295", "1e999",   "1e300",
                                         "0 0", "\t", "#",  "\r",  " 0 ",        kNextFile, "\xFF"};

bool try_bytes(const std::vector<char> &bytes) {
    static const Folder folder;
    folder.write_parts(bytes, {"bundle.out", "list.txt"});
    is_bundler(folder.path("bundle.out"));
    return try_scene([&] { return read_bundler(folder.path("bundle.out")); });
}

}  // namespace
