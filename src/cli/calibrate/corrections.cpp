#include "cli/calibrate/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "cli/calibrate/attempt.hpp"
#include "cli/correct/picture_model.hpp"
#include "cli/correct/project_model.hpp"
#include "cli/pictures/picture.hpp"
#include "cli/program/input_file.hpp"
#include "cli/program/output_file.hpp"
#include "cli/program/paths.hpp"

namespace lensprof {
namespace {

std::string copy_key(const InputPicture &picture, const std::string &model) {
    return digest_of_text(std::string(lensprof_version()) + "\n" + picture.identity + "\n" + model);
}

Correction job_of(const InputPicture &picture) {
    Correction job;
    job.source = picture.file, job.target = picture.target;
    lensprof_exposure_init(&job.own);
    lensprof_exposure_init(&job.wanted);
    job.pixels = uint64_t(picture.metadata.size.width) * picture.metadata.size.height;
    return job;
}

using ByFile = std::map<std::string, CorrectedPicture>;

using Reasons = std::map<std::string, std::string>;  // by file

// Uses the project and finds its images by file, because somebody may have edited it.
void take_project(const Panorama &panorama, ByFile &corrected, Reasons &reasons) {
    const std::string text = read_text(panorama.project, largest_text);
    const Project project = read_project(panorama.project);
    const ImagesByFile images(project);
    const std::vector<lensprof_exposure> exposures = relative_to_joined(project);
    const lensprof_exposure mean = mean_exposure(joined_exposures(project, exposures));
    const auto encoding = common_encoding(project);
    for (const InputPicture *picture : panorama.pictures) {
        const auto image = images.find(picture->file);
        if (!image || project.images[*image].left_out) {
            reasons[picture->file] = picture->file
                                     + (image ? ": disagrees with the other pictures of panorama " + panorama.name
                                              : ": is not in " + panorama.project);
            continue;
        }
        CorrectedPicture one{picture, panorama.name, exposures[*image].ev - mean.ev, copy_key(*picture, text),
                             job_of(*picture)};
        one.job.model = model_of_project(project, *image);
        one.job.own = exposures[*image], one.job.wanted = mean, one.job.encoding = encoding;
        one.job.model_name = std::filesystem::path(panorama.project).filename().string();
        corrected.emplace(picture->file, std::move(one));
    }
}

// For the pictures of a panorama; those missing from its result get a reason.
void take_panorama(const Panorama &panorama, ByFile &corrected, Reasons &reasons) {
    std::string why;
    if (panorama.evens()) {
        why = why_not([&] { take_project(panorama, corrected, reasons); });
    } else {
        const Json &result = panorama.summary["result"];
        why = (result.is_object() ? result["reason"] : panorama.summary["not_stored"]).get<std::string>();
    }
    if (why.empty()) return;
    for (const InputPicture *picture : panorama.pictures)
        reasons[picture->file] = picture->file + ": panorama " + panorama.name + " cannot be corrected: " + why;
}

// Uses a profile of the databases; returns the reason on failure, else "".
std::string take_profile(const PictureModels &models, const InputPicture &picture, ByFile &corrected) {
    if (!models.are_used()) return "no profile database exists yet";
    CorrectedPicture one{&picture, "", std::nullopt, "", job_of(picture)};
    try {
        models.choose(picture.metadata, one.job);
    } catch (const NotThisOne &failure) {
        const std::string text = failure.what(), start = picture.file + ": ";
        return text.compare(0, start.size(), start) == 0 ? text.substr(start.size()) : text;
    }
    Json model = profile_json(0, *one.job.model);
    model.erase("provenance");
    one.key = copy_key(picture, model.dump(-1, ' ', true, Json::error_handler_t::replace));
    corrected.emplace(picture.file, std::move(one));
    return {};
}

}  // namespace

CorrectedPictures plan_corrections(const CalibrateOptions &o, const Inputs &inputs, const Panoramas &panoramas) {
    ByFile corrected;
    Reasons reasons = panoramas.unjoined;
    for (const Panorama &panorama : panoramas.list) take_panorama(panorama, corrected, reasons);
    ModelOptions options;
    options.dbs = o.store.dbs;
    if (!options.dbs.empty())  // created when the first profile is stored
        options.dbs.erase(std::remove_if(options.dbs.begin(), options.dbs.end(),
                                         [](const std::string &db) { return !path_exists(db); }),
                          options.dbs.end());
    const PictureModels models(options, o.store.dbs.empty() || !options.dbs.empty());
    CorrectedPictures pictures;
    for (const InputPicture &picture : inputs.pictures) {
        if (!corrected.count(picture.file)) {
            const std::string why = take_profile(models, picture, corrected);
            const auto reason = reasons.find(picture.file);
            if (!why.empty())
                pictures.left_out.push_back(
                    {picture.file, (reason == reasons.end() ? picture.file : reason->second) + "; " + why});
        }
        const auto one = corrected.find(picture.file);
        if (one != corrected.end()) pictures.list.push_back(std::move(one->second));
    }
    return pictures;
}

void write_corrections(const CalibrateOptions &o, CorrectedPictures &pictures, Ledger &ledger, Progress &progress) {
    std::vector<Correction> jobs;
    for (const CorrectedPicture &one : pictures.list) {
        if (ledger.is_current(one.picture->target, one.key)) continue;
        jobs.push_back(one.job);
        ledger.begin(one.picture->target, one.key);
    }
    ledger.save();
    CorrectionKind kind;
    kind.threads = o.threads;
    std::map<std::string, std::string> damaged;
    while (!jobs.empty()) {
        std::string why;
        try {
            write_corrected(jobs, kind, nullptr, progress);
        } catch (const Failure &failure) {
            if (!is_of_pictures(failure)) throw;
            why = failure.what();
        }
        // Pictures are processed in this order, so the count of written ones gives the index of the one that cannot be
        // read.
        const auto next = std::find_if(jobs.begin(), jobs.end(),
                                       [&](const Correction &job) { return !ledger.is_written(job.target); });
        pictures.written += static_cast<uint32_t>(next - jobs.begin());
        std::for_each(jobs.begin(), next, [&](const Correction &job) { ledger.finish(job.target); });
        if (next != jobs.end()) {
            damaged[next->source] = why;
            ledger.abandon(next->target);
        }
        jobs.erase(jobs.begin(), next == jobs.end() ? next : next + 1);
        ledger.save();
    }
    const auto is_damaged = [&](const CorrectedPicture &one) { return damaged.count(one.picture->file) != 0; };
    pictures.list.erase(std::remove_if(pictures.list.begin(), pictures.list.end(), is_damaged), pictures.list.end());
    for (const auto &[file, why] : damaged) pictures.left_out.push_back({file, why});
}

}  // namespace lensprof
