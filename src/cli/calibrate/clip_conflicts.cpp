#include "cli/calibrate/clip_conflicts.hpp"

#include "cli/calibrate/clip_files.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/clip/transforms_file.hpp"

namespace lensprof {
namespace {

// Whether a path is that of a file, or would be in it if it were a folder.
bool is_at_or_in(const std::string &path, const std::string &file) {
    return (canonical_path(path) + "/").rfind(canonical_path(file) + "/", 0) == 0;
}

// The levelled frames and the files of the output folder exclude each other.
void check_levelled_place(const ClipCommand &o, const std::vector<std::string> &files) {
    bool is_conflict = is_video_output(o.levelled) && is_at_or_in(o.output, o.levelled);
    for (const std::string &file : files) is_conflict = is_conflict || is_at_or_in(o.levelled, file);
    if (is_conflict)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      o.levelled + ": another output has this name; give the levelled frames another one");
}

}  // namespace

void check_conflicts(const ClipCommand &o, const std::vector<std::string> &inputs) {
    const std::vector<std::string> files = clip_files(o.output);
    std::vector<std::string> reserved = inputs;
    if (!o.store.no_store) reserved.push_back(store_path(o.store.db));
    for (const std::string &file : files) check_not_reserved(file, "output folder", reserved);
    if (!o.report.empty()) {
        check_not_reserved(o.report, "report", inputs);
        check_not_reserved(o.report, "report", files);
        if (!o.levelled.empty() && is_at_or_in(o.levelled, o.report))
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          o.report + ": the levelled frames have this name; give the report another one");
    }
    if (!o.levelled.empty()) {
        if (is_same_file(o.input, o.levelled))
            throw Failure(LENSPROF_ERROR_ARGUMENT, o.levelled + ": is the input; give the output another name");
        check_levelled_place(o, files);
        if (has_transforms(o.input)) check_not_reserved(transforms_path(o.levelled), "folder of the frames", reserved);
    }
    if (o.overwrite || has_clip_files(o.output)) return;
    for (const std::string &file : files)
        if (path_exists(file))
            throw Failure(LENSPROF_ERROR_ARGUMENT, file
                                                       + ": exists, and no earlier run wrote it; give the output folder "
                                                         "another name, or replace it with --overwrite");
}

}  // namespace lensprof
