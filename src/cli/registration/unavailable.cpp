// In place of the registration, where the program is built without OpenCV.
#include "cli/program/error.hpp"
#include "cli/registration/registration.hpp"

namespace lensprof {

bool can_register() { return false; }

Registration register_pictures(const std::vector<std::string> &files, bool, Progress &) {
    throw Failure(ExitCode::usage,
                  (files.empty() ? std::string("pictures") : files[0])
                      + ": this lensprof was built without OpenCV, which finds the overlaps of pictures; install "
                        "libopencv-dev and build it again, or give a Hugin project (docs/hugin.md)");
}

}  // namespace lensprof
