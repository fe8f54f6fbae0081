// Replaces the reader of WebP if the program is built without libwebp.
#include "photo/pictures/coded_file.hpp"

namespace lensprof {

namespace codec {

namespace {

[[noreturn]] void fail_without_webp(const std::string &path) {
    fail_unsupported(path,
                     "is a WebP picture, and this lensprof was built without libwebp; install libwebp-dev and rebuild "
                     "lensprof, or convert the file to PNG, for instance with dwebp");
}

}  // namespace

std::unique_ptr<RowSource> open_webp(const ReadRequest &request) { fail_without_webp(request.path); }

CodedMetadata webp_metadata(const std::string &path) { fail_without_webp(path); }

}  // namespace codec

bool can_read_webp() { return false; }

}  // namespace lensprof
