#include "cli/calibrate/clip.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "cli/calibrate/clip_conflicts.hpp"
#include "cli/calibrate/clip_files.hpp"
#include "cli/calibrate/levelled_clip.hpp"
#include "cli/program/exit_code.hpp"
#include "cli/program/message.hpp"
#include "cli/program/progress.hpp"
#include "cli/report/report.hpp"
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

struct Tally {
    size_t measured = 0, blank = 0, unlinked = 0, repeats = 0;
    uint32_t segments = 0, groups = 0;
    double low_ev = INFINITY, high_ev = -INFINITY;

    explicit Tally(const ClipTracks &clip) {
        for (const ClipFrame &frame : clip.frames) {
            (frame.state == ClipState::measured ? measured : frame.state == ClipState::blank ? blank : unlinked)++;
            repeats += frame.repeats;
            if (frame.state != ClipState::measured) continue;
            segments = std::max(segments, frame.segment + 1), groups = std::max(groups, frame.group + 1);
            low_ev = std::min(low_ev, frame.exposure.ev), high_ev = std::max(high_ev, frame.exposure.ev);
        }
    }
};

[[noreturn]] void refuse_static(const ClipTracks &clip) {
    if (clip.shown_frames == 0)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      clip.path + ": all " + counted(clip.frames_in_clip, "frame")
                          + " are black, white or of one colour, which show nothing to follow; give a clip of a camera "
                            "that moves in front of objects, neither too dark nor too bright",
                      LENSPROF_REASON_FEW_PAIRS);
    throw Failure(LENSPROF_ERROR_NOT_USABLE,
                  clip.path + ": the camera does not move in the first " + counted(clip.shown_frames, "frame")
                      + (clip.shown_frames < clip.frames_in_clip ? " with scene points" : "")
                      + ", which do not show its falloff; to level the exposure of a stationary camera use `lensprof "
                        "deflicker`, or give the part of the clip in which it moves",
                  LENSPROF_REASON_FEW_PAIRS);
}

// The first frames of segments, numbered from 1.
std::string breaks_of(const ClipTracks &clip) {
    constexpr int most_listed = 8;
    std::string list;
    int count = 0;
    for (size_t i = 0, segment = 0; i < clip.frames.size(); i++) {
        if (clip.frames[i].state != ClipState::measured || clip.frames[i].segment == segment) continue;
        segment = clip.frames[i].segment;
        if (count++ < most_listed) list += (list.empty() ? "" : ", ") + std::to_string(i + 1);
    }
    return count > most_listed ? list + format(" and %d more", count - most_listed) : list;
}

// What the clip shows of the exponent that response, falloff and exposures share.
void report_exponent(const ClipFit &fit, const ClipTracks &clip, const Tally &tally, Streams &streams) {
    constexpr double fixed_ev = 0.1;
    const lensprof_fit_result &result = fit.report.fit;
    if (result.gamma_from != LENSPROF_GAMMA_PRIOR) return;
    const bool is_fixed = tally.high_ev - tally.low_ev < fixed_ev, has_times = fit.report.exposures_given;
    const char *reason = is_fixed    ? "all frames have one exposure"
                         : has_times ? "the exposures of its keyframes differ too little"
                                     : "the exposure times are unknown";
    const char *remedy = is_fixed || has_times ? "record while the exposure changes by 1 EV or more"
                                               : "give the exposure time of each frame with --times";
    note(streams, clip.path + ": " + reason
                      + format("; the exponent of response, falloff and exposures is that of typical cameras, with a "
                               "standard error of %.0f %%; to measure it %s",
                               100.0 * result.gamma_sigma, remedy));
}

void report_frames(const ClipFit &fit, const ClipTracks &clip, const Tally &tally, Streams &streams) {
    if (clip.info.is_interlaced)
        warn(streams, clip.path + ": is interlaced; deinterlace it first for better exposures");
    if (clip.info.orientation != 1)
        note(streams, clip.path + ": is shown rotated; the vignette and frames are as stored");
    if (tally.segments > 1)
        note(streams, clip.path + ": new scenes begin at frames " + breaks_of(clip)
                          + (tally.groups < 2 ? "; the given times connect them"
                                              : "; exposures are relative to the mean of each scene"));
    if (tally.blank)
        note(streams, clip.path + ": " + counted(tally.blank, "frame") + " black or white, without exposure");
    if (2 * tally.measured < clip.frames.size())
        warn(streams,
             clip.path + ": most frames have no exposure; if they are not in the order of recording, sort them");
    constexpr size_t few_keyframes = 10;
    if (fit.keyframes.size() < few_keyframes)
        warn(streams, clip.path + ": only " + counted(fit.keyframes.size(), "frame")
                          + " determine the result; record several seconds for a response and falloff to rely on");
    if (tally.unlinked)
        warn(streams, clip.path + ": " + counted(tally.unlinked, "frame")
                          + " without exposure, because too few scene points are found in others");
    if (tally.repeats) note(streams, clip.path + ": " + counted(tally.repeats, "frame") + " repeat the one before");
    report_exponent(fit, clip, tally, streams);
}

// Known exposures that the clip contradicts show a doubtful response, or wrong times.
void report_times(const ClipTracks &clip, double error_ev, Streams &streams) {
    constexpr double largest_ev = 0.03;
    if (error_ev > largest_ev)
        warn(streams, clip.path
                          + format(": measured exposures differ from the given ones by %.3f EV (rms), so that the "
                                   "response is doubtful; check that the times belong to these frames, or record "
                                   "more motion and change of exposure",
                                   error_ev));
}

Json clip_json(const ClipFit &fit, const ClipTracks &clip, const Tally &tally, const std::vector<std::string> &written,
               const ClipOutput *levelled) {
    return {{"codec", clip.info.codec},
            {"width", clip.info.width},
            {"height", clip.info.height},
            {"orientation", clip.info.orientation},
            {"frames_in_clip", clip.frames_in_clip},
            {"measured", tally.measured},
            {"segments", tally.segments},
            {"points", fit.points},
            {"observations", fit.observations},
            {"times_rms_ev", number_or_null(fit.known.rms_ev)},
            {"frames", clip_frames_json(clip)},
            {"video", levelled ? levelled->json() : Json()},
            {"written", written}};
}

void print_clip(const ClipFit &fit, const ClipTracks &clip, const Tally &tally, const std::vector<std::string> &written,
                const ClipOutput *levelled, std::ostream &out) {
    const lensprof_fit_result &result = fit.report.fit;
    out << counted(clip.frames.size(), "frame") << " of " << clip.info.width << " x " << clip.info.height << " pixels, "
        << tally.measured << " measured, " << fit.keyframes.size() << " keyframes in the fit\n"
        << format("exposure  %.2f to %.2f EV\n", tally.low_ev, tally.high_ev)
        << format("corner    %.3f of the light in the middle\n",
                  lensprof_vignetting_eval(&green_falloff(result), 1.0, nullptr))
        << format("residual  %.2f levels of 255\n", result.heldout_rms);
    if (levelled) out << levelled->text();
    for (const std::string &name : written) out << "written   " << name << "\n";
}

// The file of exposure times: the given one, or that of a folder with images/; empty: none.
std::string times_file(const ClipCommand &o) {
    if (!o.times.empty() || !is_frame_folder(o.input)) return o.times;
    const std::string times = (std::filesystem::path(o.input) / "times.txt").string();
    return path_exists(times) ? times : std::string();
}

void check_clip(const ClipTracks &clip) {
    if (clip.frames_in_clip > 1 && clip.is_static()) refuse_static(clip);
    if (clip.frames.size() < 2)
        throw Failure(LENSPROF_ERROR_NOT_USABLE, clip.path + ": has only one frame; give a clip of a moving camera",
                      LENSPROF_REASON_FEW_PAIRS);
}

// Stores the profile after all files, if the clip states a camera.
Outcome store_clip(const ClipCommand &o, ClipFit &fit, const lensprof_profile_key &key, Streams &streams) {
    StoreOptions store = o.store;
    if (!store.no_store && !*key.camera_model) {
        store.no_store = true;
        note(streams, o.input + ": states no camera, so that no profile is stored; store pcalib.txt and vignette.png "
                                "with `lensprof profile import` and the name of the camera");
    }
    if (!store.no_store) store_result(fit.report, key, store, {"clip radiance", o.input, nullptr});
    return outcome_of(fit.report, store, o.input, true);
}

// Writes all files and levelled frames; returns their names.
std::vector<std::string> write_clip(const ClipCommand &o, const ClipFit &fit, const ClipTracks &clip,
                                    const std::vector<double> &known_ev, const FrameSource &source,
                                    ClipOutput *levelled, Events &events) {
    OutputFiles outputs;
    std::vector<std::string> written;
    make_folder(o.output);
    if (fit.best.corrects()) written = write_model(fit, clip, o.output, outputs);
    const auto tables = write_exposures(clip, offset_of_times(clip, known_ev), o.output, outputs);
    outputs.commit();
    written.insert(written.end(), tables.begin(), tables.end());
    if (levelled && fit.best.corrects()) {
        write_levelled(o, fit, clip, source, *levelled, events);
        written.push_back(o.levelled);
    }
    return written;
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
    if (!times.empty()) inputs.push_back(times);
    check_conflicts(o, inputs);
    const auto levelled = open_levelled(o, inputs, events);
    const GivenTimes given(times, *source, is_of_pictures || o.frames_per_s <= 0.0);
    ClipTracks clip = track_clip(o.input, *source, is_of_pictures ? 0.0 : o.frames_per_s, events,
                                 [&](const ClipTracks &first) { check_times_early(first, given.of_first(first)); });
    check_clip(clip);
    ClipOptions options;
    options.known_ev = given.of(clip);
    check_times_early(clip, options.known_ev);
    const lensprof_profile_key key = clip_key(clip.info);
    ClipFit fit = fit_clip(options, key, clip, events);
    check_wanted(o, clip);
    events.clear();
    const Tally tally(clip);
    const auto written = write_clip(o, fit, clip, options.known_ev, *source, levelled.get(), events);
    const Outcome outcome = store_clip(o, fit, key, streams);
    if (o.json) {
        Json json = build_json(fit.report);
        json["clip"] = clip_json(fit, clip, tally, written, levelled.get());
        print_json(json, streams.out);
    } else {
        print_clip(fit, clip, tally, written, levelled.get(), streams.out);
    }
    report_frames(fit, clip, tally, streams);
    report_times(clip, fit.known.rms_ev, streams);
    for (const Notice &notice : outcome.notices.list) events.notice(notice.severity, notice.item, notice.text);
    if (!outcome.is_good) print_message(streams, outcome.refusal);
    return static_cast<int>(outcome.is_good ? ExitCode::done : ExitCode::not_usable);
}

}  // namespace lensprof
