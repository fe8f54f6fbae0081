#include "cli/calibrate/clip_summary.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/calibrate/clip_files.hpp"
#include "cli/fitting/fit_page.hpp"
#include "cli/page/page.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

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
void notice_exponent(const ClipFit &fit, const ClipTracks &clip, const ClipTally &tally, Events &notices) {
    constexpr double fixed_ev = 0.1;
    const lensprof_fit_result &result = fit.report.fit;
    if (result.gamma_from != LENSPROF_GAMMA_PRIOR) return;
    const bool is_fixed = tally.high_ev - tally.low_ev < fixed_ev, has_times = fit.report.exposures_given;
    const char *reason = is_fixed    ? "all frames have one exposure"
                         : has_times ? "the exposures of its keyframes differ too little"
                                     : "the exposure times are unknown";
    const char *remedy = is_fixed || has_times ? "record while the exposure changes by 1 EV or more"
                                               : "give the exposure time of each frame with --times";
    notices.note(clip.path,
                 reason
                     + format("; the exponent of response, falloff and exposures is that of typical cameras, with a "
                              "standard error of %.0f %%; to measure it %s, or give the response with --response",
                              100.0 * result.gamma_sigma, remedy));
}

// Known exposures that the clip contradicts show a doubtful response, or wrong times.
void notice_times(const ClipTracks &clip, double error_ev, Events &notices) {
    constexpr double largest_ev = 0.03;
    if (error_ev > largest_ev)
        notices.warn(clip.path, format("measured exposures differ from the given ones by %.3f EV (rms), so that the "
                                       "response is doubtful; check that the times belong to these frames, or record "
                                       "more motion and change of exposure",
                                       error_ev));
}

// Frames at even distances, with what pages of pictures state of them.
Json page_frames(const ClipTracks &clip) {
    constexpr size_t most = 200;
    const size_t count = clip.frames.size(), step = (count + most - 1) / most;
    Json frames = Json::array();
    for (size_t i = 0; i < count; i += step) {
        const ClipFrame &frame = clip.frames[i];
        if (frame.state != ClipState::measured) continue;
        frames.push_back({{"name", format("frame %zu", i + 1)},
                          {"ev", frame.exposure.ev},
                          {"ev_sigma", frame.ev_sigma},
                          {"known_ev", Json()},
                          {"balance", frame.exposure.white_balance},
                          {"balance_sigma", {0.0, 0.0, 0.0}}});
    }
    return frames;
}

}  // namespace

ClipTally::ClipTally(const ClipTracks &clip) {
    for (const ClipFrame &frame : clip.frames) {
        (frame.state == ClipState::measured ? measured : frame.state == ClipState::blank ? blank : unlinked)++;
        repeats += frame.repeats;
        if (frame.state != ClipState::measured) continue;
        segments = std::max(segments, frame.segment + 1), groups = std::max(groups, frame.group + 1);
        low_ev = std::min(low_ev, frame.exposure.ev), high_ev = std::max(high_ev, frame.exposure.ev);
    }
}

void add_clip_notices(const ClipFit &fit, const ClipTracks &clip, const ClipTally &tally, Events &notices) {
    if (clip.info.is_interlaced) notices.warn(clip.path, "is interlaced; deinterlace it first for better exposures");
    if (clip.info.orientation != 1) notices.note(clip.path, "is shown rotated; the vignette and frames are as stored");
    if (tally.segments > 1)
        notices.note(clip.path, "new scenes begin at frames " + breaks_of(clip)
                                    + (tally.groups < 2 ? "; the given times connect them"
                                                        : "; exposures are relative to the mean of each scene"));
    if (tally.blank) notices.note(clip.path, counted(tally.blank, "frame") + " black or white, without exposure");
    if (2 * tally.measured < clip.frames.size())
        notices.warn(clip.path, "most frames have no exposure; if they are not in the order of recording, sort them");
    constexpr size_t few_keyframes = 10;
    if (fit.keyframes.size() < few_keyframes)
        notices.warn(clip.path,
                     "only " + counted(fit.keyframes.size(), "frame")
                         + " determine the result; record several seconds for a response and falloff to rely on");
    if (tally.unlinked)
        notices.warn(clip.path, counted(tally.unlinked, "frame")
                                    + " without exposure, because too few scene points are found in others");
    if (tally.repeats) notices.note(clip.path, counted(tally.repeats, "frame") + " repeat the one before");
    constexpr double clearly_better = 1.1;
    const double rms = fit.best.result.heldout_rms;
    if (rms > clearly_better * fit.fitted_rms)
        notices.warn(clip.path,
                     format("the given response leaves a residual of %.2f levels, a fitted one %.2f; if that "
                            "of these settings is not known better, omit it",
                            rms, fit.fitted_rms));
    notice_exponent(fit, clip, tally, notices);
    notice_times(clip, fit.known.rms_ev, notices);
}

Json clip_json(const ClipFit &fit, const ClipTracks &clip, const ClipTally &tally,
               const std::vector<std::string> &written, const ClipOutput *levelled) {
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

void print_clip(const ClipFit &fit, const ClipTracks &clip, const ClipTally &tally,
                const std::vector<std::string> &written, const ClipOutput *levelled, std::ostream &out) {
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

std::string clip_page(const ClipFit &fit, const ClipTracks &clip, const Json &result, const std::string &command,
                      const std::vector<std::string> &warnings) {
    Json page = curves_page(fit.report, clip.path, "Calibration from the frames of a clip", command);
    page["images"] = page_frames(clip);
    add_fit_verdict(page, fit.report, warnings);
    page["result"] = result;
    return page_of(page);
}

}  // namespace lensprof
