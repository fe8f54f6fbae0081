// Replaces the registration if the program is built without OpenCV.
#include "photo/base/failure.hpp"
#include "photo/registration/registration.hpp"

namespace lensprof {

bool can_register() { return false; }

Registration register_pictures(const std::vector<std::string> &files, const std::vector<PictureMetadata> &, bool,
                               Events &) {
    throw Failure(LENSPROF_ERROR_ARGUMENT,
                  (files.empty() ? std::string("pictures") : files[0])
                      + ": this lensprof was built without OpenCV, which is needed to find overlaps; install "
                        "libopencv-dev and rebuild lensprof, or give a Hugin project (docs/hugin.md)");
}

}  // namespace lensprof
