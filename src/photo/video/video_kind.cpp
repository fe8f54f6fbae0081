// Which files are videos, and which names those of videos to write.
#include "photo/base/failure.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/paths.hpp"
#include "photo/video/video_writer.hpp"

namespace lensprof {

bool is_video(const std::string &path) {
    const auto kind = other_pictures(path);
    return kind && kind->kind.rfind("a video (", 0) == 0 && kind->kind != "a video (SER)";
}

bool is_video_name(const std::string &path) {
    const std::string suffix = lowercase_extension(path);
    for (const char *written : {"mp4", "mov", "mkv", "webm"})
        if (suffix == written) return true;
    for (const char *other : {"avi", "m4v", "mpg", "mpeg", "ts", "mts", "m2ts", "wmv", "flv", "3gp", "ogv", "mxf"})
        if (suffix == other)
            throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": videos are written as .mp4, .mov, .mkv or .webm; give a "
                                                          "name with one of these");
    return false;
}

}  // namespace lensprof
