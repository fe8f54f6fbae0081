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
// included; without times the error of the exponent, which scales all exposures.
void complete_errors(const ClipFit &fit, ClipTracks &clip) {
    const lensprof_fit_result &result = fit.best.result;
    const double common_ev = std::isfinite(fit.known.rms_ev) ? fit.known.rms_ev : 0.0,
                 exponent = result.gamma_from == LENSPROF_GAMMA_PRIOR ? result.gamma_sigma : 0.0;
    for (ClipFrame &frame : clip.frames)
        if (frame.state == ClipState::measured)
            frame.ev_sigma = std::hypot(frame.ev_sigma, common_ev, exponent * frame.exposure.ev);
}

ClipModel model_of(const Fitted &best) { return {best.response_of(0), best.falloff_of(0)}; }

}  // namespace

std::unique_ptr<lensprof_profile> ClipFit::profile() const {
    auto profile = new_profile();
    profile->response[0] = best.response_of(0);
    const auto falloff = best.falloff_of(0);
    profile->vignettings = best.falloff_curves_of(0);
    std::copy_n(falloff.begin(), falloff.size(), profile->vignetting);
    return profile;
}

static ClipFit fit_once(const ClipOptions &o, const lensprof_profile_key &key, ClipTracks &clip, Events &events) {
    ClipFit fit_of_clip;
    auto clock = std::chrono::steady_clock::now();
    auto &keyframes = fit_of_clip.keyframes = scattered(choose_keyframes(clip, o.most_keyframes));
    FitInput input;
    input.observations = keyframe_observations(clip, keyframes);
    if (keyframes.size() < 2 || input.observations.empty())
        throw Failure(LENSPROF_ERROR_NOT_USABLE,
                      clip.path + ": no scene points are seen in several frames, because the frames are too dark, "
                                  "blurred or far apart; give a clip of a textured scene with slower motion",
                      LENSPROF_REASON_FEW_PAIRS);
    fit_of_clip.observations = input.observations.size();
    for (size_t i = 0; i < input.observations.size(); i++)
        fit_of_clip.points += !i || input.observations[i].point != input.observations[i - 1].point;
    BuildReport &report = fit_of_clip.report;
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
    fit_of_clip.best = fit(input, report.reference, clip.path, events, &report.quality);
    const Fitted &best = fit_of_clip.best;
    report.fit = best.result, report.held = best.held, report.verdict = best.verdict;
    name_images(report.names, report.verdict);
    report.exposures = best.exposures, report.reference = best.reference;
    if (o.response) fit_of_clip.fitted_rms = rms_of_fitted_response(input, report.reference, clip.path, events);
    events.update("exposures", 0.9);
    fit_of_clip.known = find_exposures(model_of(best), {o.known_ev, o.known_sigma_ev}, clip);
    events.clear();
    return fit_of_clip;
}

// Names the frames of wrong exposures, numbered from 1, and forgets these.
static void leave_out(const KnownAgreement &known, ClipOptions &o, const ClipTracks &clip, Events &events) {
    constexpr size_t most_listed = 8;
    std::string list;
    for (size_t n = 0; n < known.wrong.size(); n++) {
        o.known_ev[known.wrong[n]] = NAN;
        if (n < most_listed) list += (n ? ", " : "") + std::to_string(known.wrong[n] + 1);
    }
    if (known.wrong.size() > most_listed) list += format(" and %zu more", known.wrong.size() - most_listed);
    events.warn(
        clip.path,
        format("given exposures differ by up to %.2f EV from what the frames show, and are not used: ", known.wrong_ev)
            + (known.wrong.size() > 1 ? "frames " : "frame ") + list);
}

ClipFit fit_clip(ClipOptions o, const lensprof_profile_key &key, ClipTracks &clip, Events &events) {
    ClipFit fit_of_clip = fit_once(o, key, clip, events);
    if (!fit_of_clip.known.wrong.empty()) {
        leave_out(fit_of_clip.known, o, clip, events);
        fit_of_clip = fit_once(o, key, clip, events);
    }
    check_exposures(fit_of_clip, clip, o.response.has_value());
    complete_errors(fit_of_clip, clip);
    return fit_of_clip;
}

}  // namespace lensprof
