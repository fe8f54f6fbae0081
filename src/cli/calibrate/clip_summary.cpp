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

// The first frames of segments after the first.
std::vector<uint32_t> breaks_of(const ClipTracks &clip) {
    std::vector<uint32_t> first;
    for (uint32_t i = 0, segment = 0; i < clip.frames.size(); i++) {
        if (clip.frames[i].state != ClipState::measured || clip.frames[i].segment == segment) continue;
        segment = clip.frames[i].segment;
        first.push_back(i);
    }
    return first;
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
void notice_times(const ClipFit &fit, const ClipTracks &clip, Events &notices) {
    constexpr double largest_ev = 0.03;
    if (!fit.left_out.empty())
        notices.warn(clip.path, format("given exposures differ by up to %.2f EV from what the frames show, and are not "
                                       "used: ",
                                       fit.left_out_ev)
                                    + frame_list(fit.left_out));
    if (fit.known.rms_ev > largest_ev)
        notices.warn(clip.path,
                     format("measured exposures differ from the given ones by %.3f EV (rms), most, by %.2f EV, "
                            "in frame %u; check that the times belong to these frames, or record more "
                            "motion and change of exposure",
                            fit.known.rms_ev, fit.known.worst_ev, fit.known.worst_frame + 1));
}

// Frames at even distances, with what pages of pictures state of them. Exposures are relative to the mean.
Json page_frames(const ClipTracks &clip, const std::vector<double> &known_ev) {
    constexpr size_t most = 200;
    const size_t count = clip.frames.size(), step = (count + most - 1) / most;
    Json frames = Json::array();
    for (size_t i = 0; i < count; i += step) {
        const ClipFrame &frame = clip.frames[i];
        if (frame.state != ClipState::measured) continue;
        frames.push_back({{"name", format("frame %zu", i + 1)},
                          {"ev", frame.exposure.ev},
                          {"ev_sigma", frame.ev_sigma},
                          {"known_ev", known_ev.empty() ? Json() : number_or_null(known_ev[i])},
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
        notices.note(clip.path, "new scenes begin at " + frame_list(breaks_of(clip))
                                    + (tally.groups < 2 ? "; the given times connect them"
                                                        : "; exposures are relative to the mean of each scene"));
    if (tally.blank) notices.note(clip.path, counted(tally.blank, "frame") + " black or white, without exposure");
    if (2 * tally.measured < clip.frames.size())
        notices.warn(clip.path, "most frames have no exposure; if they are not in the order of recording, sort them");
    if (fit.shows_exposures_only())
        notices.warn(clip.path,
                     "shows neither response nor falloff, so that pcalib.txt and vignette.png are not written; if the "
                     "camera stands still, and clouds or people move, level the frames with `lensprof deflicker`");
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
    notice_times(fit, clip, notices);
}

// Frames numbered from 1.
static Json numbers_of(const std::vector<uint32_t> &frames) {
    Json numbers = Json::array();
    for (const uint32_t frame : frames) numbers.push_back(frame + 1);
    return numbers;
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
            {"times_left_out", numbers_of(fit.left_out)},
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

std::string clip_page(const ClipFit &fit, const ClipTracks &clip, const std::vector<double> &known_ev,
                      const Json &result, const std::string &command, const std::vector<std::string> &warnings) {
    Json page = curves_page(fit.report, clip.path, "Calibration from the frames of a clip", command);
    page["images"] = page_frames(clip, known_ev);
    add_fit_verdict(page, fit.report, warnings);
    page["result"] = result;
    return page_of(page);
}

}  // namespace lensprof
