// `lensprof align`: converts the frames of a sequence to one exposure and white balance (Kim & Pollefeys 2004, section
// 3).
#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "cli/correct/exposure_limits.hpp"
#include "cli/correct/model_options.hpp"
#include "cli/fitting/fitting.hpp"
#include "cli/program/commands.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/options.hpp"
#include "cli/report/findings.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/profile_store.hpp"
#include "photo/calibration/sequence_fit.hpp"
#include "photo/correct/correction.hpp"
#include "photo/correct/merged.hpp"
#include "photo/deflicker/long_sequence.hpp"
#include "photo/pictures/clipping.hpp"
#include "photo/pictures/coded_kind.hpp"
#include "photo/pictures/named_pictures.hpp"
#include "photo/pictures/other_parts.hpp"
#include "photo/pictures/raw_kind.hpp"
#include "photo/report/falloff.hpp"
#include "photo/scene/exposures.hpp"
#include "photo/scene/hugin_project.hpp"
#include "photo/scene/scene.hpp"
#include "photo/scene/scene_pictures.hpp"
#include "photo/scene/static_camera.hpp"

namespace lensprof {
namespace {

// The target exposure and white balance.
enum class Target {
    first,
    last,
    brightest,
    mean
};

const Choices<Target> targets = {
    {"first", Target::first}, {"last", Target::last}, {"brightest", Target::brightest}, {"mean", Target::mean}};

struct Options {
    FitOptions fit;
    Target to = Target::mean;
    std::string output, pto, merge;

    std::string folder() const { return output.empty() ? "aligned" : output; }
    CorrectionKind kind;
    SamplingOptions pixels;
    bool json = false, progress = false;
    std::vector<std::string> files;
};

void declare(Command &command, Options &o) {
    command.files("FILE", o.files, "pictures of one camera, in order; with --project default all of its pictures");
    command.choice("--to", o.to, targets,
                   "frame whose exposure and white balance all frames get: first, last, brightest, or mean (default: "
                   "geometric mean of all)");
    command.folder("-o,--output", o.output, "folder for the frames; default aligned");
    command.file(
        "--merge", o.merge,
        "write one picture merged from all frames (HDR, 32 bit float, .tif or .exr) instead; needs a stationary "
        "camera");
    command.file("--project", o.pto,
                 "Hugin project with the orientations of the camera; the falloff is then estimated and corrected too; "
                 "default none: a stationary camera");
    Keys keys = declare_fit(command, o.fit, {false});
    declare_sampling(keys, o.pixels, "10000 per frame; with --project 300 per frame, at least 2000");
    declare_writing(command, o.kind);
    declare_json(command, o.json);
    declare_progress(command, o.progress);
}

// The project with the orientations. A sequence is aligned from its pictures alone: everything is free, except the
// falloff, which a stationary camera does not show.
Scene sequence(const Options &o) {
    Scene scene = o.pto.empty() ? static_scene(o.files, true) : read_hugin_project(o.pto);
    refuse_crops(scene, "align");
    if (scene.images.size() < 2)
        throw Failure(
            LENSPROF_ERROR_NOT_USABLE,
            (o.pto.empty() ? scene.files[0] : o.pto) + ": a single frame cannot be aligned; give at least two",
            LENSPROF_REASON_FEW_PAIRS);
    require_one_kind(scene.files);
    scene.reference = 0;
    for (uint32_t i = 0; i < scene.images.size(); i++) {
        auto &image = scene.images[i];
        image.free =
            LENSPROF_FREE_IMAGE | (o.pto.empty() ? static_cast<uint32_t>(LENSPROF_FREE_RESPONSE) : LENSPROF_FREE_LENS);
        image.ev_of = image.red_of = image.blue_of = i;
        lensprof_exposure_init(&image.exposure);
    }
    return scene;
}

// The frames to write, as indices of the project's images.
std::vector<uint32_t> frames_of(const Options &o, const Scene &scene) {
    std::vector<uint32_t> frames;
    for (uint32_t i = 0; i < scene.files.size() && (o.files.empty() || o.pto.empty()); i++) frames.push_back(i);
    if (!frames.empty()) return frames;
    const ImagesByFile images(scene);
    for (const std::string &file : o.files) frames.push_back(images.at(file, "--project"));
    return frames;
}

// A sequence, and the share of each of its pictures that is white.
struct FittedSequence {
    Fitted fitted;
    std::vector<std::string> names;    // of the pictures that findings name
    std::vector<double> white_shares;  // per picture
};

FittedSequence fit_frames(const Options &o, const Scene &scene, Progress &progress) {
    if (!scene.document && scene.files.size() > long_sequence_frames) {
        LongSequence found = fit_long_sequence(scene.files, o.fit, o.pixels, progress);
        return {std::move(found.fitted), std::move(found.names), std::move(found.white_shares)};
    }
    std::vector<SamplePicture> pictures;
    FittedSequence found{fit_sequence(scene, o.fit, o.pixels, progress, &pictures), scene.names, {}};
    for (const SamplePicture &picture : pictures) found.white_shares.push_back(white_share(picture.picture));
    return found;
}

lensprof_exposure wanted_exposure(const Options &o, const std::vector<lensprof_exposure> &exposures) {
    auto darker = [](const lensprof_exposure &a, const lensprof_exposure &b) { return a.ev < b.ev; };
    if (o.to == Target::first) return exposures.front();
    if (o.to == Target::last) return exposures.back();
    if (o.to == Target::brightest) return *std::max_element(exposures.begin(), exposures.end(), darker);
    return mean_exposure(exposures);
}

// The merged picture has no frame of its own.
void check_merge(const Options &o, const Scene &scene) {
    check_merged_name(o.merge);
    const std::string folder = std::filesystem::path(absolute_path(o.merge)).parent_path().string();
    if (!is_folder(folder))
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      o.merge + ": its folder does not exist; create it, or give another name");
    check_output_file(o.merge);
    std::vector<Correction> job(1);
    job[0].source = scene.files[0], job[0].target = o.merge;
    check_targets(job, scene.files, "");
    check_older_outputs(job, o.kind, false);
}

// The frame whose metadata the merged picture gets: the one with its exposure.
size_t frame_like(const std::vector<lensprof_exposure> &exposures, const lensprof_exposure &wanted) {
    for (size_t i = 0; i < exposures.size(); i++)
        if (exposures[i].ev == wanted.ev) return i;
    return 0;
}

// Outputs next to the frames they come from.
std::vector<Correction> make_jobs(const Options &o, const Scene &scene, const std::vector<uint32_t> &frames) {
    std::vector<Correction> jobs;
    for (uint32_t i : frames) {
        const SeveralPictures several = several_pictures(scene.files[i]);
        if (!several.what.empty())
            throw Failure(LENSPROF_ERROR_READ, scene.files[i] + ": " + several.what
                                                   + ", but only the first would be written; " + several.next_step);
        std::filesystem::path name = std::filesystem::path(scene.files[i]).filename();
        if (raw_kind(scene.files[i]) || is_read_alone(scene.files[i])) name.replace_extension(".tif");
        Correction job;
        job.source = scene.files[i];
        job.target = (std::filesystem::path(o.folder()) / name).string();
        job.model_name = "frames of " + std::filesystem::path(scene.files[0]).filename().string() + " on";
        jobs.push_back(std::move(job));
    }
    if (!o.merge.empty()) {
        check_merge(o, scene);
        return jobs;
    }
    check_targets(jobs, scene.files, "");
    check_older_outputs(jobs, o.kind, true);
    return jobs;
}

// Writes the frames, or the merged picture.
Corrected write_all(const Options &o, const std::vector<Correction> &jobs,
                    const std::vector<lensprof_exposure> &exposures, Progress &progress) {
    if (o.merge.empty()) {
        make_folder(o.folder());
        Corrected corrected = write_corrected(jobs, o.kind, nullptr, progress);
        if (!corrected.failed.empty()) throw Failure(corrected.failed[0].failure);
        return corrected;
    }
    write_merged(jobs, frame_like(exposures, jobs[0].target_exposure), o.merge, progress);
    Corrected corrected;
    for (const Correction &job : jobs) corrected.pictures.push_back({{"file", job.source}, {"output", o.merge}});
    return corrected;
}

Json report(const Options &o, const lensprof_fit_result &r, const Verdict &verdict,
            const std::vector<lensprof_exposure> &exposures, const Corrected &corrected) {
    Json written = corrected.pictures;
    for (size_t i = 0; i < written.size(); i++) {
        const auto &w = exposures[i].white_balance;
        written[i]["ev"] = exposures[i].ev;
        written[i]["white_balance"] = {w[0], w[1], w[2]};
    }
    auto known = [](double value) { return value == LENSPROF_UNKNOWN ? Json() : Json(value); };
    Json json = {{"schema", json_schema}, {"usable", r.usable != 0}, {"equalizes", r.equalizes != 0}};
    add_verdict(verdict, json);
    json["to"] = targets[static_cast<size_t>(o.to)].first;
    json["frames"] = written;
    json["residual"] = {{"before_rms", known(r.before_rms)},
                        {"heldout_rms", known(r.heldout_rms)},
                        {"heldout_median", known(r.heldout_median)},
                        {"noise", r.noise_levels},
                        {"inlier_share", r.inlier_share}};
    json["pairs"] = r.pairs;
    add_speed(corrected, json);
    return json;
}

// Frames that disagree with the others have no exposure and stay unchanged.
void leave_out_unjoined(const Fitted &fitted, const Scene &scene, std::vector<uint32_t> &frames,
                        std::vector<Correction> &jobs, Streams &streams) {
    for (size_t n = frames.size(); n-- > 0;) {
        if (!std::isnan(fitted.exposures[frames[n]].ev)) continue;
        if (fitted.corrects()) warn(streams, scene.files[frames[n]] + ": left out: it disagrees with the other frames");
        frames.erase(frames.begin() + static_cast<ptrdiff_t>(n));
        jobs.erase(jobs.begin() + static_cast<ptrdiff_t>(n));
    }
}

int align(const Options &o, Streams &streams) {
    Scene scene = sequence(o);
    std::vector<uint32_t> frames = frames_of(o, scene);
    std::vector<Correction> jobs = make_jobs(o, scene, frames);
    if (scene.document || scene.files.size() <= long_sequence_frames) check_pictures(scene, o.pixels.max_side);
    if (o.merge.empty()) check_output_folder(o.folder());
    Progress progress(streams, o.progress);
    const FittedSequence found = fit_frames(o, scene, progress);
    const Fitted &fitted = found.fitted;
    const std::vector<double> &white_shares = found.white_shares;
    Verdict verdict = fitted.verdict;
    name_images(found.names, verdict);
    std::vector<lensprof_exposure> exposures;
    leave_out_unjoined(fitted, scene, frames, jobs, streams);
    for (uint32_t i : frames) exposures.push_back(fitted.exposures[i]);
    Corrected written;
    if (fitted.corrects()) {
        std::shared_ptr<const lensprof_profile> model = profile_of(*fitted.held);
        for (size_t i = 0; i < jobs.size(); i++) {
            jobs[i].model = model;
            jobs[i].exposure = exposures[i];
            jobs[i].target_exposure = wanted_exposure(o, exposures);
            if (o.merge.empty())
                warn_of_limits(jobs[i].source, jobs[i].exposure.ev, jobs[i].target_exposure.ev, white_shares[frames[i]],
                               streams);
        }
        written = write_all(o, jobs, exposures, progress);
    }
    progress.clear();
    const std::string &item = o.pto.empty() ? scene.files[0] : o.pto;
    if (!fitted.corrects()) {
        if (o.pto.empty() && !verdict.findings.empty())
            verdict.findings[0].text +=
                "; frames of a moving camera need --project, and `lensprof deflicker` levels those of nearly one exposure";
        print_message(streams, item + ": not usable: " + verdict.headline() + "; nothing written");
    } else if (fitted.result.usable) {
        report_findings(verdict, item, progress);
    } else {
        warn(streams, item + ": " + verdict.headline());
    }
    if (o.json) print_json(report(o, fitted.result, verdict, exposures, written), streams.out);
    if (!o.json && !o.merge.empty() && !written.pictures.empty()) streams.out << o.merge << "\n";
    for (const auto &entry : written.pictures)
        if (!o.json && o.merge.empty()) streams.out << entry["output"].get<std::string>() << "\n";
    return static_cast<int>(written.pictures.empty() ? ExitCode::not_usable : ExitCode::done);
}

int run(const Options &o, Streams &streams) {
    check_fit_options(o.fit);
    check_max_side(o.pixels.max_side);
    if (o.files.empty() && o.pto.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT, "no frames to align; give at least two");
    if (!o.merge.empty() && !o.output.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--merge: writes one picture, but --output is a folder for frames; give one of them");
    if (!o.merge.empty() && !o.pto.empty())
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "--merge: needs a stationary camera, but --project is for one that rotated; give one of them");
    try {
        return align(o, streams);
    } catch (const Failure &failure) {
        if (o.json && failure.group() == LENSPROF_ERROR_NOT_USABLE) {
            const BuildReport empty = no_fit({}, failure);
            print_json(report(o, empty.fit, empty.verdict, {}, {}), streams.out);
        }
        throw;
    }
}

}  // namespace

void declare_align(Command &program) {
    Command command = program.add("align", "match exposure and white balance of the frames of a sequence",
                                  "Converts the frames of a sequence to one exposure and white balance.");
    auto o = std::make_shared<Options>();
    declare(command, *o);
    command.example("lensprof align --to brightest -o aligned frame1.jpg frame2.jpg frame3.jpg");
    command.run([o](Streams &streams) { return run(*o, streams); });
}

}  // namespace lensprof
