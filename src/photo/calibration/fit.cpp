#include "photo/calibration/fit.hpp"

#include <algorithm>
#include <cmath>

#include "photo/base/events.hpp"
#include "photo/base/format.hpp"
#include "photo/pictures/orientation.hpp"
#include "photo/report/falloff.hpp"
#include "photo/scene/exposures.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

int on_fit_progress(double done, void *progress) {
    static_cast<Events *>(progress)->update("fitting", done);
    return is_cancelled();
}

const char *method_name(uint32_t method) {
    static const char *const names[] = {"transfer", "radiance", "transfer-function"};
    return method <= LENSPROF_METHOD_TRANSFER_FUNCTION ? names[method] : "unknown";
}

bool uses_stored_prior(const FitOptions &o) {
    return o.stored && o.prior_weight > 0.0
           && (o.method == LENSPROF_METHOD_TRANSFER || o.method == LENSPROF_METHOD_RADIANCE);
}

lensprof_fit_options fit_options(const FitOptions &o) {
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    options.method = o.method;
    options.modes = o.modes;
    options.loss = o.loss;
    options.camera_kind = o.camera_kind.value_or(LENSPROF_CAMERA_ANY);
    options.huber_levels = o.huber;
    options.prior_weight = o.prior_weight;
    if (o.gamma_from == LENSPROF_GAMMA_KNOWN)
        options.free &= ~LENSPROF_FREE_RESPONSE;
    else
        options.gamma_from = o.gamma_from;
    return options;
}

CameraKind camera_kind_of(const FitOptions &o, lensprof_profile_key key, const PictureMetadata &metadata) {
    if (o.camera_kind) return {*o.camera_kind, KindFrom::option};
    key.processing = metadata.processing_before;
    const uint32_t kind = lensprof_camera_kind_of(&key);
    const bool is_camera_output =
        kind == LENSPROF_CAMERA_LINEAR || (kind != LENSPROF_CAMERA_ANY && metadata.is_of_camera);
    if (!is_camera_output) return {};  // anything but the camera's JPEG was developed by other software
    return {kind, KindFrom::pictures};
}

size_t joined_images(const Fitted &fitted) { return joined_images(fitted.exposures); }

size_t joined_images(const std::vector<lensprof_exposure> &exposures) {
    return static_cast<size_t>(std::count_if(exposures.begin(), exposures.end(),
                                             [](const lensprof_exposure &e) { return !std::isnan(e.ev); }));
}

// Asks a fit for all that it found.
static void ask(const lensprof_fit &held, const std::vector<lensprof_fit_image> &images, Fitted &fitted,
                std::vector<lensprof_fit_image_quality> *quality) {
    lensprof_error error{};
    lensprof_fit_result_init(&fitted.result);
    check(lensprof_fit_setting_at(&held, LENSPROF_FIT_REFERENCE, &fitted.result, &error), "fit", &error);
    fitted.settings.assign(fitted.result.setting_count, fitted.result);
    for (uint32_t s = 0; s < fitted.result.setting_count; s++)
        check(lensprof_fit_setting_at(&held, s, &fitted.settings[s], &error), "fit", &error);
    fitted.cameras.resize(fitted.result.camera_count);
    for (uint32_t k = 0; k < fitted.result.camera_count; k++) {
        lensprof_fit_camera_init(&fitted.cameras[k]);
        check(lensprof_fit_camera_at(&held, k, &fitted.cameras[k], &error), "fit", &error);
    }
    const bool has_one_setting = fitted.settings.size() == 1, has_one_camera = fitted.cameras.size() == 1;
    for (uint32_t i = 0; i < images.size(); i++) {
        fitted.setting_of.push_back(has_one_setting ? 0 : images[i].setting);
        fitted.camera_of.push_back(has_one_camera ? 0 : images[i].camera);
        if (!quality) continue;
        lensprof_fit_image_quality_init(&(*quality)[i]);
        check(lensprof_fit_image_at(&held, i, &(*quality)[i], &error), "fit", &error);
    }
}

// A place in a picture, as in the frame of its setting.
template <class Number>
static void turn_place(uint16_t turn, const lensprof_fit_image &stored, Number xy[2]) {
    const uint32_t size[2] = {stored.width, stored.height};
    double x = xy[0] - 0.5 * (size[0] - 1.0), y = xy[1] - 0.5 * (size[1] - 1.0);
    turn_upright(turn, x, y);
    xy[0] = static_cast<Number>(x + 0.5 * (size[swaps_sides(turn)] - 1.0));
    xy[1] = static_cast<Number>(y + 0.5 * (size[!swaps_sides(turn)] - 1.0));
}

// All pictures in the frames of their settings.
static FitInput rotated_input(const FitInput &input) {
    FitInput rotated = input;
    rotated.turn_of.clear();
    for (lensprof_pair &pair : rotated.pairs)
        for (int side = 0; side < 2; side++)
            turn_place(input.turn_of[pair.image[side]], input.images[pair.image[side]], pair.xy[side]);
    for (lensprof_observation &observation : rotated.observations)
        turn_place(input.turn_of[observation.image], input.images[observation.image], observation.xy);
    for (size_t i = 0; i < rotated.images.size(); i++)
        if (swaps_sides(input.turn_of[i])) std::swap(rotated.images[i].width, rotated.images[i].height);
    double *centre = rotated.options.vignetting.center;  // of the reference
    turn_upright(input.turn_of[input.options.reference], centre[0], centre[1]);
    return rotated;
}

std::array<lensprof_vignetting, 3> Fitted::falloff_of(uint32_t image) const {
    std::array<lensprof_vignetting, 3> falloff;
    const lensprof_vignetting *of_setting =
        settings.empty() ? result.vignetting : settings[setting_of[image]].vignetting;
    std::copy_n(of_setting, falloff.size(), falloff.begin());
    for (lensprof_vignetting &curve : falloff)
        if (!turn_of.empty()) turn_upright(inverse_orientation(turn_of[image]), curve.center[0], curve.center[1]);
    return falloff;
}

Fitted fit(FitInput &input, uint32_t reference, const std::string &item, Events &progress,
           std::vector<lensprof_fit_image_quality> *quality) {
    if (!input.turn_of.empty()) {
        FitInput rotated = rotated_input(input);
        Fitted in_settings = fit(rotated, reference, item, progress, quality);
        in_settings.turn_of = input.turn_of;
        return in_settings;
    }
    Fitted fitted;
    auto count = static_cast<uint32_t>(input.images.size());
    fitted.exposures.resize(count);
    if (quality) quality->resize(count);
    lensprof_fit *held = nullptr;
    input.options.progress = on_fit_progress;
    input.options.progress_user = &progress;
    input.options.points = input.points.empty() ? nullptr : input.points.data();
    input.options.view_distances = input.view_distances.empty() ? nullptr : input.view_distances.data();
    lensprof_error error{};
    const auto *images = input.images.data();
    auto pairs = static_cast<uint32_t>(input.pairs.size()),
         observations = static_cast<uint32_t>(input.observations.size());
    lensprof_status status =
        observations ? lensprof_fit_radiance(&input.options, images, count, input.observations.data(), observations,
                                             nullptr, 0, fitted.exposures.data(), &held, &error)
                     : lensprof_fit_overlap(&input.options, images, count, input.pairs.data(), pairs, nullptr, 0,
                                            fitted.exposures.data(), &held, &error);
    fitted.held = {held, lensprof_fit_destroy};
    stop_if_cancelled();
    if (status == LENSPROF_ERROR_NO_UNKNOWNS)
        throw Failure(LENSPROF_ERROR_ARGUMENT, item + ": no parameter is estimated; give " + option_name("free_all"));
    check(status, item, &error);
    ask(*held, input.images, fitted, quality);
    fitted.verdict = verdict_of(held);
    fitted.reference = std::isnan(fitted.exposures[reference].ev) ? fitted.result.reference : reference;
    fitted.exposures = relative_exposures(fitted.exposures, fitted.reference);
    return fitted;
}

BuildReport no_fit(const std::vector<std::string> &names, const Failure &failure) {
    BuildReport report;
    report.names = names;
    report.exposures.resize(names.size());
    for (auto &e : report.exposures) lensprof_exposure_init(&e);
    lensprof_fit_result_init(&report.fit);
    lensprof_response_set_linear(&report.fit.response);
    report.fit.heldout_rms = report.fit.heldout_median = report.fit.before_rms = LENSPROF_UNKNOWN;
    report.fit.gamma_from = LENSPROF_GAMMA_NONE;
    report.fit.gamma_sigma = LENSPROF_UNKNOWN;
    report.fit.vignettings = 1;
    report.quality.resize(names.size());
    report.verdict.refuse(failure.reason, failure.what());
    return report;
}

}  // namespace lensprof
