// Which files are videos, and which names those of videos to write.
#include <algorithm>
#include <iterator>

#include "photo/base/failure.hpp"
#include "photo/base/file_kind.hpp"
#include "photo/base/paths.hpp"
#include "photo/video/video_writer.hpp"

namespace lensprof {
namespace {

constexpr const char *other_suffixes[] = {"avi",  "m4v", "mpg", "mpeg", "ts",  "mts",
                                          "m2ts", "wmv", "flv", "3gp",  "ogv", "mxf"};

bool is_written(const std::string &suffix) {
    return suffix == "mp4" || suffix == "mov" || suffix == "mkv" || suffix == "webm";
}

}  // namespace

bool is_video(const std::string &path) {
    const auto kind = other_pictures(path);
    return kind && kind->kind.rfind("a video (", 0) == 0 && kind->kind != "a video (SER)";
}

bool has_video_suffix(const std::string &path) {
    const std::string suffix = lowercase_extension(path);
    return is_written(suffix)
           || std::any_of(std::begin(other_suffixes), std::end(other_suffixes),
                          [&](const char *other) { return suffix == other; });
}

bool is_video_name(const std::string &path) {
    if (is_written(lowercase_extension(path))) return true;
    if (has_video_suffix(path))
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": videos are written as .mp4, .mov, .mkv or .webm; give a name "
                                                      "with one of these");
    return false;
}

}  // namespace lensprof
