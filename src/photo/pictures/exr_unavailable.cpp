// Replaces the OpenEXR writer if the program is built without that library.
#include "photo/pictures/codec.hpp"

namespace lensprof {

namespace codec {

std::unique_ptr<RowSink> create_exr(const std::string &path, const Picture &, const std::string &) {
    fail_to_hold(path, "this lensprof was built without OpenEXR; give a name ending in .tif");
}

}  // namespace codec

bool can_write_exr() { return false; }

std::string exr_xmp_of(const std::string &) { return {}; }

}  // namespace lensprof
