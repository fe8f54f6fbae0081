// Replaces the reader of HEIC and AVIF if the program is built without libheif.
#include "photo/pictures/coded_file.hpp"

namespace lensprof {

namespace codec {

namespace {

[[noreturn]] void fail_without_heif(const std::string &path, const std::string &kind) {
    fail_unsupported(path, "is a picture in " + kind + ", and this lensprof was built without libheif; install "
                                                       "libheif-dev and rebuild lensprof, or convert the file to PNG, "
                                                       "for instance with heif-convert");
}

}  // namespace

std::unique_ptr<RowSource> open_heif(const ReadRequest &request, const std::string &kind) {
    fail_without_heif(request.path, kind);
}

CodedMetadata heif_metadata(const std::string &path, const std::string &kind) { fail_without_heif(path, kind); }

HeifParts heif_parts(const std::string &, const std::string &) { return {}; }

}  // namespace codec

bool can_read_heif() { return false; }

}  // namespace lensprof
