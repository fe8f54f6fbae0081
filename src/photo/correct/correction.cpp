#include "photo/correct/correction.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <nlohmann/json.hpp>

#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/metadata.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {

void check_targets(std::vector<Correction> &jobs, const std::vector<std::string> &inputs, const std::string &sheet) {
    std::set<std::string> read, written;
    for (const std::string &file : inputs) read.insert(canonical_path(file));
    for (const Correction &job : jobs) read.insert(canonical_path(job.source));
    for (Correction &job : jobs) {
        if (!job.pixels) {  // unreadable pictures fail before anything is written
            const PictureSize size = read_size(job.source);
            job.pixels = uint64_t(size.width) * size.height;
        }
        const std::string target = canonical_path(job.target);
        if (target == canonical_path(job.source) || is_same_file(job.source, job.target))
            throw Failure(
                LENSPROF_ERROR_ARGUMENT,
                job.source + ": would be overwritten by its correction; give another folder" + advice("output"));
        if (read.count(target))
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          job.target + ": would overwrite an input picture; give another folder" + advice("output"));
        if (!written.insert(target).second)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          job.target + ": two pictures would get this name; correct them one folder at a time");
    }
    if (!sheet.empty() && (read.count(canonical_path(sheet)) || written.count(canonical_path(sheet))))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      sheet + ": the contact sheet would overwrite a picture; give it another name");
}

// Empty: not a picture, or without a mark.
static std::optional<CorrectionMark> mark_of_older(const std::string &file) {
    if (!is_regular_file(file)) return std::nullopt;
    try {
        if (const std::string packet = exr_xmp_of(file); !packet.empty()) return mark_of_packet(packet);
        return read_metadata(file).mark;
    } catch (const Failure &) {
        return std::nullopt;
    }
}

void check_older_outputs(const std::vector<Correction> &jobs, const CorrectionKind &kind, bool replaces_unmarked) {
    for (const Correction &job : jobs) {
        if (kind.overwrite) return;
        const auto mark = mark_of_older(job.target);
        const auto folder_of = [](const std::string &file) {
            return canonical_path(std::filesystem::path(absolute_path(file)).parent_path().string());
        };
        const bool is_same_folder = folder_of(job.target) == folder_of(job.source);  // next to somebody's pictures
        if (!mark && (!replaces_unmarked || is_same_folder) && path_exists(job.target))
            throw Failure(LENSPROF_ERROR_ARGUMENT, job.target + ": exists and was not written by lensprof; give another "
                                                        "folder or another name, or use " + option_name("overwrite"));
        if (!mark || mark->digest.empty() || mark->digest == digest_of(job.source)) continue;
        throw Failure(LENSPROF_ERROR_ARGUMENT, job.target + ": exists and was made from another picture ("
                                                   + mark->source + "); give another folder, or use "
                                                   + option_name("overwrite"));
    }
}

std::string correction_note(const Correction &job) {
    if (job.profile_id) return format("falloff by profile %lld", static_cast<long long>(job.profile_id));
    if (job.lookup) return "falloff predicted by a lookup";
    return job.copies_dng ? "" : format("%+.2f EV", job.exposure.ev - job.target_exposure.ev);
}

void warn_of_written(const Correction &job, bool with_metadata, Events &events) {
    if (!job.copies_dng && format_of_name(job.target) == FileFormat::exr && read_metadata(job.source).orientation > 1)
        events.warn({}, job.target + ": written in sensor orientation, because OpenEXR has no EXIF orientation; rotate "
                                   "it later, or write TIFF");
    if (!with_metadata)
        events.warn({}, job.target + ": written without the metadata of " + job.source
                            + ", which lensprof does not support in BigTIFF; copy them with exiftool");
}

void add_speed(const Corrected &corrected, Json &json) {
    json["seconds"] = corrected.seconds;
    json["megapixels_per_second"] =
        corrected.megapixels > 0.0 ? Json(corrected.megapixels / std::max(corrected.seconds, 1e-6)) : Json();
}

}  // namespace lensprof
