#include "photo/clip/clip_calibration.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "photo/base/format.hpp"
#include "photo/base/lap.hpp"
#include "photo/clip/clip_exposures.hpp"
#include "photo/clip/given_times.hpp"
#include "photo/clip/keyframes.hpp"

namespace lensprof {
namespace {

std::vector<lensprof_fit_image> keyframe_images(const ClipOptions &o, const ClipTracks &clip,
                                                const std::vector<uint32_t> &keyframes, uint32_t reference) {
    std::vector<lensprof_fit_image> images(keyframes.size());
    for (uint32_t k = 0; k < images.size(); k++) {
        lensprof_fit_image_init(&images[k], k, clip.info.width, clip.info.height);
        images[k].free = LENSPROF_FREE_EV | (clip.channels == 3 ? LENSPROF_FREE_RED | LENSPROF_FREE_BLUE : 0);
        if (k == reference) images[k].free = 0;
        if (o.known_ev.empty() || std::isnan(o.known_ev[keyframes[k]])) continue;
        images[k].known_ev = o.known_ev[keyframes[k]];
        images[k].known_ev_sigma = o.known_sigma_ev;
    }
    return images;
}

// Some of the observations of a point, at even distances. Where they begin depends on the point, so that all keyframes
// are used.
std::vector<lensprof_observation> spread_observations(const std::vector<lensprof_observation> &all) {
    constexpr size_t most = 24;
    if (all.size() <= most) return all;
    const double golden = 0.6180339887498949 * all[0].point, shift = golden - std::floor(golden);
    std::vector<lensprof_observation> some;
    for (size_t n = 0; n < most; n++)
        some.push_back(all[static_cast<size_t>((double(n) + shift) * double(all.size()) / most)]);
    return some;
}

// Observations of the points that two or more keyframes show.
std::vector<lensprof_observation> keyframe_observations(const ClipTracks &clip,
                                                        const std::vector<uint32_t> &keyframes) {
    std::map<uint32_t, std::vector<lensprof_observation>> points;
    for (uint32_t k = 0; k < keyframes.size(); k++)
        for (const ClipObservation &seen : clip.observations_of(keyframes[k])) {
            if (std::isnan(seen.value[0]) || std::isnan(seen.value[1]) || std::isnan(seen.value[2])) continue;
            points[seen.track].push_back({seen.track,
                                          k,
                                          {double(seen.x), double(seen.y)},
                                          {double(seen.value[0]), double(seen.value[1]), double(seen.value[2])}});
        }
    std::vector<lensprof_observation> observations;
    for (const auto &[track, of_point] : points)
        if (of_point.size() > 1)
            for (const lensprof_observation &seen : spread_observations(of_point)) observations.push_back(seen);
    return observations;
}

// The keyframes and, if few of them have a known exposure, others between them that have: these show the exponent.
std::vector<uint32_t> with_known(std::vector<uint32_t> keyframes, const std::vector<double> &known_ev,
                                 const ClipTracks &clip) {
    constexpr size_t enough = 10;
    if (known_ev.empty() || keyframes.empty()) return keyframes;
    const auto is_known = [&](uint32_t frame) { return std::isfinite(known_ev[frame]); };
    const auto known = size_t(std::count_if(keyframes.begin(), keyframes.end(), is_known));
    std::vector<uint32_t> further;
    for (uint32_t frame = keyframes.front(); frame < keyframes.back(); frame++)
        if (is_known(frame) && clip.frames[frame].observation_count > 0
            && !std::binary_search(keyframes.begin(), keyframes.end(), frame))
            further.push_back(frame);
    const size_t missing = known < enough ? std::min(enough - known, further.size()) : 0;
    for (size_t n = 0; n < missing; n++) keyframes.push_back(further[n * further.size() / missing]);
    std::sort(keyframes.begin(), keyframes.end());
    return keyframes;
}

// Keyframes in the order of the golden ratio: the fit begins with pairs of neighbours among the observations of a
// point, and neighbours in time differ little in light and place.
std::vector<uint32_t> scattered(const std::vector<uint32_t> &keyframes) {
    constexpr double golden = 0.6180339887498949;
    std::vector<std::pair<double, uint32_t>> order;
    for (uint32_t k = 0; k < keyframes.size(); k++)
        order.emplace_back(golden * k - std::floor(golden * k), keyframes[k]);
    std::sort(order.begin(), order.end());
    std::vector<uint32_t> result;
    for (const auto &[rank, frame] : order) result.push_back(frame);
    return result;
}

// By how much the exposures of keyframes in the fit differ from those of all frames, EV rms. The latter compare only
// what two frames share, so that a response of the wrong shape gives others.
double contradiction_ev(const ClipFit &fit, const ClipTracks &clip) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (size_t k = 0; k < fit.keyframes.size(); k++) {
        const ClipFrame &frame = clip.frames[fit.keyframes[k]];
        const double difference = fit.best.exposures[k].ev - frame.exposure.ev;
        if (frame.state != ClipState::measured || !std::isfinite(difference)) continue;
        sum += difference, squares += difference * difference, count++;
    }
    return count > 1.0 ? std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count))) : 0.0;
}

// The residual of the same fit with a free response; NaN if that is not possible.
double rms_of_fitted_response(FitInput input, uint32_t reference, const std::string &path, Events &events) {
    input.options.free |= LENSPROF_FREE_RESPONSE;
    input.options.response = nullptr;
    try {
        return fit(input, reference, path, events, nullptr).result.heldout_rms;
    } catch (const Failure &failure) {
        if (!is_of_input(failure)) throw;
        return NAN;
    }
}

// A fit that contradicts itself or the given times has a wrong response.
void check_exposures(const ClipFit &fit, const ClipTracks &clip, bool is_response_given) {
    constexpr double most_times_fitted = 1.5;
    const double rms = fit.best.result.heldout_rms;
    if (rms > most_times_fitted * fit.fitted_rms)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      clip.path
                          + format(": the given response leaves a residual of %.1f levels, a fitted one %.1f; give the "
                                   "response of this camera at these settings, or omit it",
                                   rms, fit.fitted_rms),
                      LENSPROF_REASON_UNDETERMINED);
    if (is_response_given && fit.known.rms_ev > KnownAgreement::largest_ev
        && fit.known.scaled_rms_ev < 0.5 * KnownAgreement::largest_ev)
        throw Failure(
            LENSPROF_ERROR_NOT_USABLE,
            clip.path
                + format(": the given response and times contradict each other: they agree with exposures that "
                         "are %.2f times as large in EV; correct or omit one of them",
                         fit.known.scale),
            LENSPROF_REASON_KNOWN_CONTRADICT);
    if (std::vector<uint32_t> wrong = fit.known.wrong_frames; !wrong.empty()) {
        wrong.insert(wrong.end(), fit.left_out.begin(), fit.left_out.end());
        throw Failure(
            LENSPROF_ERROR_NOT_USABLE,
            clip.path
                + format(": given exposures differ by up to %.2f EV from what the frames show, too many to be "
                         "left out; correct those of ",
                         std::max(fit.known.worst_ev, fit.left_out_ev))
                + frame_list(wrong),
            LENSPROF_REASON_KNOWN_CONTRADICT);
    }
    if (fit.known.better_shift) refuse_shifted_times(clip, fit.known.better_shift);
    if (fit.known.rms_ev > KnownAgreement::largest_ev) refuse_times(clip, fit.known.rms_ev);
    constexpr double largest_ev = 0.03;
    const double error_ev = contradiction_ev(fit, clip);
    if (fit.best.corrects() && error_ev > largest_ev)
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      clip.path
                          + format(": the exposures of keyframes in the fit differ from those of all frames by %.2f EV "
                                   "(rms), so that the response is wrong; %s",
                                   error_ev,
                                   is_response_given ? "give that of this camera at these settings, or omit it"
                                                     : "record more motion and change of exposure"),
                      LENSPROF_REASON_UNDETERMINED);
}

// Adds to the noise of a step what all frames share: how far the given times differ from the frames, codec and tracks
// included, or without times how far the exposures of keyframes do; and the error of an exponent that is not measured,
// which scales all exposures. The error of a given response is not known.
void complete_errors(const ClipFit &fit, ClipTracks &clip) {
    const lensprof_fit_result &result = fit.best.result;
    const double common_ev = std::isfinite(fit.known.rms_ev) ? fit.known.rms_ev : contradiction_ev(fit, clip),
                 exponent = result.gamma_from == LENSPROF_GAMMA_PRIOR ? result.gamma_sigma : 0.0;
    for (ClipFrame &frame : clip.frames)
        if (frame.state == ClipState::measured)
            frame.ev_sigma = std::hypot(frame.ev_sigma, common_ev, exponent * frame.exposure.ev);
}

ClipModel model_of(const Fitted &best) {
    return {best.response_of(0), best.falloff_of(0), best.result.gamma_from == LENSPROF_GAMMA_PRIOR};
}

}  // namespace

std::unique_ptr<lensprof_profile> ClipFit::profile() const {
    auto profile = new_profile();
    profile->response[0] = best.response_of(0);
    const auto falloff = best.falloff_of(0);
    profile->vignettings = best.falloff_curves_of(0);
    std::copy_n(falloff.begin(), falloff.size(), profile->vignetting);
    return profile;
}

// The frames of the fit, and what it compares.
static FitInput keyframe_input(const ClipOptions &o, const lensprof_profile_key &key, ClipTracks &clip,
                               ClipFit &found) {
    auto clock = std::chrono::steady_clock::now();
    auto &keyframes = found.keyframes =
        scattered(with_known(choose_keyframes(clip, o.most_keyframes), o.known_ev, clip));
    FitInput input;
    input.observations = keyframe_observations(clip, keyframes);
    if (keyframes.size() < 2 || input.observations.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      clip.path + ": no scene points are seen in several frames, because the frames are too dark, "
                                  "blurred or far apart; give a clip of a textured scene with slower motion",
                      LENSPROF_REASON_FEW_PAIRS);
    found.observations = input.observations.size();
    for (size_t i = 0; i < input.observations.size(); i++)
        found.points += !i || input.observations[i].point != input.observations[i - 1].point;
    BuildReport &report = found.report;
    for (ClipFrame &frame : clip.frames) frame.is_keyframe = false;
    for (const uint32_t frame : keyframes) {
        clip.frames[frame].is_keyframe = true;
        report.names.push_back(format("frame %u", frame + 1));
    }
    report.reference = static_cast<uint32_t>(keyframes.size() / 2);
    report.exposures_given = !o.known_ev.empty();
    FitOptions options = o.fit;
    options.method = LENSPROF_METHOD_RADIANCE;
    if (o.response) options.gamma_from = LENSPROF_GAMMA_KNOWN;
    input.options = fit_options(options);
    if (o.response) input.options.response = &*o.response;
    input.options.channels = clip.channels;
    input.options.reference = report.reference;
    input.options.moving_camera = 1;
    if (o.fit.camera_kind) report.camera_kind = {*o.fit.camera_kind, KindFrom::option};
    if (!o.fit.camera_kind && *key.camera_model)
        report.camera_kind = {lensprof_camera_kind_of(&key), KindFrom::pictures};
    input.options.camera_kind = report.camera_kind.kind;
    input.images = keyframe_images(o, clip, keyframes, report.reference);
    report.sample_s = lap(clock);
    return input;
}

// Fits the keyframes, and sets the exposures of all frames.
static void fit_frames(const ClipOptions &o, FitInput &input, ClipTracks &clip, Events &events, ClipFit &found) {
    BuildReport &report = found.report;
    found.best = fit(input, report.reference, clip.path, events, &report.quality);
    const Fitted &best = found.best;
    report.fit = best.result, report.held = best.held, report.verdict = best.verdict;
    name_images(report.names, report.verdict);
    report.exposures = best.exposures, report.reference = best.reference;
    events.update("exposures", 0.9);
    found.known = find_exposures(model_of(best), {o.known_ev, o.known_sigma_ev}, clip);
    events.clear();
}

// Forgets a few known exposures that are wrong; false if no one is, or too many.
static bool leave_out_wrong(ClipFit &found, ClipOptions &o) {
    const auto &wrong = found.known.wrong_frames;
    const auto known =
        size_t(std::count_if(o.known_ev.begin(), o.known_ev.end(), [](double ev) { return std::isfinite(ev); }));
    auto &left_out = found.left_out;
    if (wrong.empty() || left_out.size() + wrong.size() > most_wrong(known + left_out.size())) return false;
    for (const uint32_t frame : wrong) o.known_ev[frame] = NAN;
    left_out.insert(left_out.end(), wrong.begin(), wrong.end());
    std::sort(left_out.begin(), left_out.end());
    found.left_out_ev = std::max(found.left_out_ev, found.known.worst_ev);
    return true;
}

ClipFit fit_clip(ClipOptions o, const lensprof_profile_key &key, ClipTracks &clip, Events &events) {
    ClipFit found;
    FitInput input;
    do {
        ClipFit next;
        next.left_out = found.left_out, next.left_out_ev = found.left_out_ev;
        input = keyframe_input(o, key, clip, next);
        fit_frames(o, input, clip, events, next);
        found = std::move(next);
    } while (leave_out_wrong(found, o));
    if (o.response) found.fitted_rms = rms_of_fitted_response(input, found.report.reference, clip.path, events);
    check_exposures(found, clip, o.response.has_value());
    complete_errors(found, clip);
    return found;
}

}  // namespace lensprof
