// Replaces the reader of JPEG XL if the program is built without libjxl.
#include "photo/pictures/coded_file.hpp"

namespace lensprof {

namespace codec {

namespace {

[[noreturn]] void fail_without_jxl(const std::string &path) {
    fail_unsupported(path,
                     "is a JPEG XL picture, and this lensprof was built without libjxl; install libjxl-dev and "
                     "rebuild lensprof, or convert the file to PNG, for instance with djxl");
}

}  // namespace

std::unique_ptr<RowSource> open_jxl(const ReadRequest &request) { fail_without_jxl(request.path); }

CodedMetadata jxl_metadata(const std::string &path) { fail_without_jxl(path); }

}  // namespace codec

bool can_read_jxl() { return false; }

}  // namespace lensprof
