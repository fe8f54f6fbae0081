// Replaces the raw reader if the program is built without LibRaw.
#include "photo/pictures/codec.hpp"
#include "photo/pictures/raw_file.hpp"

namespace lensprof {

namespace codec {

namespace {

[[noreturn]] void fail_without_raw(const std::string &path, const std::string &kind) {
    fail_unsupported(path, "camera raw file (" + kind + "), and this lensprof was built without LibRaw; install "
                                                        "libraw-dev and rebuild lensprof, or develop the file to a "
                                                        "linear 16 bit TIFF");
}

}  // namespace

std::unique_ptr<RowSource> open_raw(const ReadRequest &request, const std::string &kind) {
    fail_without_raw(request.path, kind);
}

std::vector<uint8_t> raw_preview_bytes(const std::string &path, const std::string &kind) {
    fail_without_raw(path, kind);
}

}  // namespace codec

bool can_read_raw() { return false; }

}  // namespace lensprof
