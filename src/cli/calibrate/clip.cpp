#include "cli/calibrate/clip.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "cli/calibrate/clip_conflicts.hpp"
#include "cli/calibrate/clip_files.hpp"
#include "cli/calibrate/clip_summary.hpp"
#include "cli/calibrate/levelled_clip.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/progress.hpp"
#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"
#include "photo/calibration/outcome.hpp"
#include "photo/clip/given_times.hpp"
#include "photo/clip/transforms_file.hpp"

namespace lensprof {
namespace {

constexpr double usual_rate = 25.0;  // frames per second of a folder

// What the container states of the camera; a video states no lens.
lensprof_profile_key clip_key(const VideoInfo &info) {
    PictureMetadata metadata = unknown_metadata();
    set_text(metadata.key.camera_maker, sizeof metadata.key.camera_maker, info.camera_maker);
    set_text(metadata.key.camera_model, sizeof metadata.key.camera_model, info.camera_model);
    metadata.key.processing = LENSPROF_PROCESSING_JPEG;
    return metadata.key;
}

// `given_ev`: by how much given exposures differ.
[[noreturn]] void refuse_static(const ClipTracks &clip, double given_ev) {
    constexpr double sweep_ev = 2.0;
    if (clip.shown_frames == 0)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      clip.path + ": all " + counted(clip.frames_in_clip, "frame")
                          + " are black, white or of one colour, which show nothing to follow; give a clip of a camera "
                            "that moves in front of objects, neither too dark nor too bright",
                      LENSPROF_REASON_FEW_PAIRS);
    throw Failure(LENSPROF_ERROR_NOT_USABLE,
                  clip.path + ": the camera does not move in the first " + counted(clip.shown_frames, "frame")
                      + (clip.shown_frames < clip.frames_in_clip ? " with scene points" : "")
                      + ", which do not show its falloff; "
                      + (given_ev > sweep_ev && is_folder(clip.path)
                             ? format("the given exposures differ by %.1f EV: of a sweep of exposures `lensprof bracket` "
                                      "measures the response; ",
                                      given_ev)
                             : std::string())
                      + "to level the exposure of a stationary camera use `lensprof deflicker`, or give the part of "
                        "the clip in which it moves",
                  LENSPROF_REASON_FEW_PAIRS);
}

// The file of exposure times: the given one, or that of a folder with images/; empty: none.
std::string times_file(const ClipCommand &o) {
    if (!o.times.empty() || !is_frame_folder(o.input)) return o.times;
    const std::string times = (std::filesystem::path(o.input) / "times.txt").string();
    return path_exists(times) ? times : std::string();
}

void check_clip(const ClipTracks &clip, double given_ev) {
    if (clip.frames_in_clip > 1 && clip.is_static()) refuse_static(clip, given_ev);
    if (clip.frames.size() < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, clip.path + ": has only one frame; give a clip of a moving camera",
                      LENSPROF_REASON_FEW_PAIRS);
}

// Stores the profile after all files, if the clip states a camera.
Outcome store_clip(const ClipCommand &o, ClipFit &fit, const lensprof_profile_key &key) {
    StoreOptions store = o.store;
    const bool is_of_unknown = !store.no_store && !*key.camera_model;
    store.no_store |= is_of_unknown;
    if (!store.no_store) store_result(fit.report, key, store, {"clip radiance", o.input, nullptr});
    Outcome outcome = outcome_of(fit.report, store, o.input, true);
    if (is_of_unknown)
        outcome.notices.note(o.input,
                             "states no camera, so that no profile is stored; store pcalib.txt and "
                             "vignette.png with `lensprof profile import` and the name of the camera");
    return outcome;
}

// Writes all files and levelled frames; returns their names.
std::vector<std::string> write_clip(const ClipCommand &o, const ClipFit &fit, const ClipTracks &clip,
                                    const std::vector<double> &known_ev, const FrameSource &source,
                                    ClipOutput *levelled, Events &events) {
    OutputFiles outputs;
    std::vector<std::string> written;
    make_folder(o.output);
    if (fit.best.corrects() && !fit.shows_exposures_only()) written = write_model(fit, clip, o.output, outputs);
    const auto tables = write_exposures(clip, offset_of_times(clip, known_ev), o.output, outputs);
    outputs.commit();
    written.insert(written.end(), tables.begin(), tables.end());
    if (levelled && fit.best.corrects()) {
        write_levelled(o, fit, clip, source, *levelled, events);
        written.push_back(o.levelled);
    }
    return written;
}

// Writes the page of the result.
void write_page(const ClipCommand &o, const ClipFit &fit, const ClipTracks &clip, std::vector<double> known_ev,
                const Json &json, const Outcome &outcome, Streams &streams) {
    std::vector<std::string> warnings;
    for (const Notice &notice : outcome.notices.list)
        if (notice.severity == LENSPROF_SEVERITY_WARNING) warnings.push_back(notice.line());
    const double offset_ev = offset_of_times(clip, known_ev);
    for (double &ev : known_ev) ev -= offset_ev;
    const std::string page = clip_page(fit, clip, known_ev, json, command_text(streams.words), warnings);
    write_file(o.report, page.data(), page.size());
}

}  // namespace

bool is_frame_folder(const std::string &path) {
    if (!is_folder(path)) return false;
    return has_transforms(path)
           || (is_folder((std::filesystem::path(path) / "images").string())
               && path_exists((std::filesystem::path(path) / "times.txt").string()));
}

int calibrate_clip(const ClipCommand &o, Streams &streams) {
    Progress events(streams, o.progress);
    check_output_folder(o.output);
    const bool is_of_pictures = is_folder(o.input);
    const auto source =
        open_frames(o.input, is_of_pictures && o.frames_per_s > 0.0 ? o.frames_per_s : usual_rate, events);
    const std::string times = times_file(o);
    std::vector<std::string> inputs = source->files();
    for (const std::string &file : {times, o.response_file})
        if (!file.empty()) inputs.push_back(file);
    check_conflicts(o, inputs);
    const auto levelled = open_levelled(o, inputs, events);
    const GivenTimes given(times, *source, is_of_pictures || o.frames_per_s <= 0.0);
    ClipTracks clip = track_clip(o.input, *source, is_of_pictures ? 0.0 : o.frames_per_s, events,
                                 [&](const ClipTracks &first) { check_times_early(first, given.of_first(first)); });
    check_clip(clip, given.range_ev());
    ClipOptions options;
    options.known_ev = given.of(clip);
    options.response = o.response;
    check_times_early(clip, options.known_ev);
    const lensprof_profile_key key = clip_key(clip.info);
    ClipFit fit = fit_clip(options, key, clip, events);
    check_wanted(o, clip);
    events.clear();
    const ClipTally tally(clip);
    auto written = write_clip(o, fit, clip, options.known_ev, *source, levelled.get(), events);
    Outcome outcome = store_clip(o, fit, key);
    add_clip_notices(fit, clip, tally, outcome.notices);
    if (!o.report.empty()) written.push_back(o.report);
    Json json = build_json(fit.report);
    json["clip"] = clip_json(fit, clip, tally, written, levelled.get());
    if (!o.report.empty()) write_page(o, fit, clip, options.known_ev, json, outcome, streams);
    if (o.json)
        print_json(json, streams.out);
    else
        print_clip(fit, clip, tally, written, levelled.get(), streams.out);
    for (const Notice &notice : outcome.notices.list) events.notice(notice.severity, notice.item, notice.text);
    if (!outcome.is_good) print_message(streams, outcome.refusal);
    return static_cast<int>(outcome.is_good ? ExitCode::done : ExitCode::not_usable);
}

}  // namespace lensprof
