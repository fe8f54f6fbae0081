// Which files are videos.
#include "photo/base/file_kind.hpp"
#include "photo/video/video.hpp"

namespace lensprof {

bool is_video(const std::string &path) {
    const auto kind = other_pictures(path);
    return kind && kind->kind.rfind("a video (", 0) == 0 && kind->kind != "a video (SER)";
}

}  // namespace lensprof
