// Replaces the reader of FITS if the program is built without cfitsio.
#include "photo/pictures/coded_file.hpp"

namespace lensprof {

namespace codec {

namespace {

[[noreturn]] void fail_without_fits(const std::string &path) {
    fail_unsupported(
        path,
        "is a FITS picture, and this lensprof was built without cfitsio; install libcfitsio-dev and rebuild "
        "lensprof, or convert the file to a 16 bit or float TIFF");
}

}  // namespace

std::unique_ptr<RowSource> open_fits(const ReadRequest &request) { fail_without_fits(request.path); }

CodedMetadata fits_metadata(const std::string &path) { fail_without_fits(path); }

FitsPlanes fits_planes(const std::string &path) { fail_without_fits(path); }

}  // namespace codec

bool can_read_fits() { return false; }

}  // namespace lensprof
