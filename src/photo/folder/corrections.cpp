#include "photo/folder/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "photo/base/databases.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/base/shell_word.hpp"
#include "photo/correct/picture_model.hpp"
#include "photo/correct/scene_copies.hpp"
#include "photo/folder/attempt.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {
namespace {

std::string copy_key(const InputPicture &picture, const std::string &model) {
    return digest_of_text(std::string(lensprof_version()) + "\n" + picture.identity + "\n" + model);
}

Correction job_of(const InputPicture &picture) {
    Correction job = copy_of_picture({picture.file, picture.target});
    job.pixels = uint64_t(picture.metadata.size.width) * picture.metadata.size.height;
    return job;
}

// A command of the caller, if it has one, with words for a shell.
std::string with_words(std::string command, const std::vector<std::string> &words) {
    for (const std::string &word : words)
        if (!command.empty()) command += " " + shell_word(word);
    return command;
}

using ByFile = std::map<std::string, CorrectedPicture>;

using Reasons = std::map<std::string, std::string>;  // by file

// Uses the project and finds its images by file, because somebody may have edited it.
void plan_by_project(const Panorama &panorama, ByFile &corrected, Reasons &reasons) {
    const std::string text = read_text(panorama.project, max_text_bytes) + panorama.exposures;
    const Scene scene = panorama.corrected_scene();
    const SceneCorrection correction(scene, LENSPROF_COPY_EXPOSURE_MEAN,
                                     std::filesystem::path(panorama.project).filename().string());
    for (const InputPicture *picture : panorama.pictures) {
        const auto image = correction.find(picture->file);
        if (!image || correction.is_left_out(*image)) {
            reasons[picture->file] = picture->file
                                     + (image ? ": disagrees with the other pictures of panorama " + panorama.name
                                              : ": is not in " + panorama.project);
            continue;
        }
        Correction job = job_of(*picture);
        correction.put_into(*image, job);
        job.command = with_words(advice("apply_project"), {panorama.project});
        const double ev = job.exposure.ev - job.target_exposure.ev;
        corrected.emplace(picture->file, CorrectedPicture{picture, panorama.name, ev, copy_key(*picture, text), job});
    }
}

// For the pictures of a panorama; those missing from its result get a reason.
void plan_panorama(const Panorama &panorama, ByFile &corrected, Reasons &reasons) {
    std::string failure;
    if (panorama.equalizes()) {
        failure = failure_of([&] { plan_by_project(panorama, corrected, reasons); });
    } else {
        const Json &result = panorama.summary["result"];
        failure = result.is_object() ? first_text(result) : panorama.summary["not_stored"].get<std::string>();
    }
    if (failure.empty()) return;
    for (const InputPicture *picture : panorama.pictures)
        reasons[picture->file] = picture->file + ": panorama " + panorama.name + " cannot be corrected: " + failure;
}

// Uses a profile of the databases; returns the reason on failure, else "".
std::string plan_by_profile(const FolderOptions &o, const PictureModels &models, const InputPicture &picture,
                            ByFile &corrected) {
    if (!models.are_used()) return "no profile database exists yet";
    CorrectedPicture corrected_picture{&picture, "", std::nullopt, "", job_of(picture)};
    corrected_picture.job.command = with_words(advice("apply"), {picture.file});
    for (const std::string &db : o.store.dbs)
        corrected_picture.job.command += with_words(advice("apply_database"), {db});
    try {
        models.choose(picture.metadata, corrected_picture.job);
    } catch (const NotThisOne &failure) {
        const std::string text = failure.what(), start = picture.file + ": ";
        return text.compare(0, start.size(), start) == 0 ? text.substr(start.size()) : text;
    }
    Json model = profile_json(0, *corrected_picture.job.model);
    model.erase("provenance");
    corrected_picture.key = copy_key(picture, model.dump(-1, ' ', true, Json::error_handler_t::replace));
    corrected.emplace(picture.file, std::move(corrected_picture));
    return {};
}

}  // namespace

CorrectedPictures plan_corrections(const FolderOptions &o, const Inputs &inputs, const Panoramas &panoramas) {
    ByFile corrected;
    Reasons reasons = panoramas.unjoined;
    for (const Panorama &panorama : panoramas.list) plan_panorama(panorama, corrected, reasons);
    ModelOptions options;
    options.dbs = existing(o.store.dbs);  // one is created when the first profile is stored
    const PictureModels models(options, o.store.dbs.empty() || !options.dbs.empty());
    CorrectedPictures pictures;
    for (const InputPicture &picture : inputs.pictures) {
        if (const auto copy = panoramas.copies.find(picture.file); copy != panoramas.copies.end()) {
            pictures.left_out.push_back({picture.file, copy->second});
            continue;
        }
        if (!corrected.count(picture.file)) {
            const std::string failure = plan_by_profile(o, models, picture, corrected);
            const auto reason = reasons.find(picture.file);
            if (!failure.empty())
                pictures.left_out.push_back(
                    {picture.file, (reason == reasons.end() ? picture.file : reason->second) + "; " + failure});
        }
        const auto found = corrected.find(picture.file);
        if (found != corrected.end()) pictures.list.push_back(std::move(found->second));
    }
    return pictures;
}

// Enough for what is drawn of them: views of a page, cells of a sheet and parts of a mosaic. At most 0.7 GB.
static uint32_t small_side(size_t pictures) { return pictures <= 24 ? 960 : 500; }
static constexpr uint32_t most_small_copies = 450;

SmallCopies small_copies_of(const CorrectedPicture &picture, size_t pictures) {
    if (picture.small.before.width) return picture.small;
    return small_copies_of(picture.job, CorrectionKind(), small_side(pictures));
}

void write_corrections(const FolderOptions &o, CorrectedPictures &pictures, Ledger &ledger, Events &events) {
    std::vector<Correction> jobs;
    std::vector<CorrectedPicture *> of_job;
    for (CorrectedPicture &entry : pictures.list) {
        if (ledger.is_current(entry.picture->target, entry.key)) continue;
        jobs.push_back(entry.job);
        of_job.push_back(&entry);
        ledger.begin(entry.picture->target, entry.key);
    }
    ledger.save();
    CorrectionKind kind;
    kind.threads = o.threads;
    const CopySink sink{small_side(pictures.list.size()), [&](uint32_t i, SmallCopies small) {
                            if (i < most_small_copies) of_job[i]->small = std::move(small);
                        }};
    const Corrected corrected = write_corrected(jobs, kind, &sink, events);
    std::map<std::string, std::string> damaged;
    for (const FailedPicture &picture : corrected.failed) damaged[picture.file] = picture.failure.what();
    for (const Correction &job : jobs)
        damaged.count(job.source) ? ledger.abandon(job.target) : ledger.finish(job.target);
    pictures.written += static_cast<uint32_t>(jobs.size() - damaged.size());
    ledger.save();
    const auto is_damaged = [&](const CorrectedPicture &entry) { return damaged.count(entry.picture->file) != 0; };
    pictures.list.erase(std::remove_if(pictures.list.begin(), pictures.list.end(), is_damaged), pictures.list.end());
    for (const auto &[file, failure_text] : damaged) pictures.left_out.push_back({file, failure_text});
}

}  // namespace lensprof
