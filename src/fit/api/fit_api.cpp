// The C interface of the overlap fit: its functions, and conversion of exceptions to status codes.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <new>
#include <vector>

#include "core/profile.h"
#include "fit/api/fit_call.hpp"
#include "fit/api/fit_checks.hpp"
#include "fit/api/fit_methods.hpp"
#include "fit/api/profile.hpp"
#include "fit/base/parallel.hpp"
#include "fit/base/sized.hpp"
#include "fit/methods/cameras.hpp"
#include "fit/methods/overlap.hpp"
#include "fit/problem/tracks.hpp"
#include "fit/verdict/output.hpp"

using namespace lensprof;

namespace {

// Runs a fit, which returns a status, and converts exceptions to status codes.
template <class Fit>
lensprof_status at_boundary(lensprof_error *error, Fit fit) {
    try {
        return fit();
    } catch (const Cancelled &) {
        return fail(LENSPROF_ERROR_CANCELLED, error, "fit: cancelled");
    } catch (const std::bad_alloc &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "fit: out of memory");
    } catch (const std::exception &e) {
        return fail(LENSPROF_ERROR_INTERNAL, error, "fit: %s", e.what());
    } catch (...) {
        return fail(LENSPROF_ERROR_INTERNAL, error, "fit: an unknown exception");
    }
}

// Runs a fit, and gives the result and the elapsed time to the caller.
template <class Fit>
lensprof_status run(FitCall &call, lensprof_exposure *exposures, lensprof_fit_result *result, lensprof_error *error,
                    Fit fit) {
    if (!has_unknowns(call.options, call.images.data(), call.count()))
        return fail(LENSPROF_ERROR_NO_UNKNOWNS, error, "fit: every parameter is fixed; free at least one");
    const auto began = std::chrono::steady_clock::now();
    std::vector<lensprof_exposure> found(exposures, exposures + call.count());
    const lensprof_status status = fit(found.data());
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - began;
    if (status != LENSPROF_OK) return status;
    call.result.seconds = taken.count();
    std::copy(found.begin(), found.end(), exposures);
    give_settings(call);
    give_result(call.result, call.quality, result);
    return LENSPROF_OK;
}

// Sum of counts; saturates instead of overflowing.
uint32_t sum_of(uint32_t a, uint32_t b) { return a + std::min(b, UINT32_MAX - a); }

}  // namespace

extern "C" {

void lensprof_fit_image_init_sized(lensprof_fit_image *image, size_t size, uint32_t index, uint32_t width,
                                   uint32_t height) {
    if (!lp_sized_begin(image, size, kFirstImage)) return;
    image->width = width;
    image->height = height;
    image->free = kImageFlags;
    image->ev_of = image->red_of = image->blue_of = index;
    lensprof_exposure_init(&image->exposure);
}

void lensprof_fit_options_init_sized(lensprof_fit_options *options, size_t size) {
    if (!lp_sized_begin(options, size, kFirstOptions)) return;
    options->channels = 3;
    options->free =
        LENSPROF_FREE_RESPONSE | LENSPROF_FREE_K1 | LENSPROF_FREE_K2 | LENSPROF_FREE_K3 | LENSPROF_FREE_CENTER;
    options->modes = LENSPROF_MODES_AUTO;
    options->huber_levels = 5.0;
    options->prior_weight = 1.0;
    options->max_iterations = 200;
}

void lensprof_fit_result_init_sized(lensprof_fit_result *result, size_t size, size_t image_quality_size) {
    if (!lp_sized_begin(result, size, kFirstResult)) return;
    result->image_quality_size = static_cast<uint32_t>(image_quality_size);
    lensprof_response_set_linear(&result->response);
}

lensprof_status lensprof_fit_overlap(const lensprof_fit_options *options, const lensprof_fit_image *images,
                                     uint32_t image_count, const lensprof_pair *pairs, uint32_t pair_count,
                                     lensprof_exposure *exposures, lensprof_fit_result *result, lensprof_error *error) {
    return at_boundary(error, [&] {
        const auto call = std::make_unique<FitCall>();
        lensprof_status status =
            take_call(options, images, image_count, pairs || pair_count == 0, exposures, result, *call, error);
        if (status == LENSPROF_OK)
            status = check_pairs(pairs, pair_count, call->images.data(), image_count, call->channels(), error);
        if (status == LENSPROF_OK && call->options.method == LENSPROF_METHOD_DEBEVEC)
            status = check_debevec(call->options, call->images.data(), image_count, error);
        if (status != LENSPROF_OK) return status;
        if (pair_count == 0) return fail(LENSPROF_ERROR_NO_SAMPLES, error, "fit: no pairs were given");
        return run(*call, exposures, result, error, [&](lensprof_exposure *found) {
            return has_several_cameras(call->options, call->images) ? fit_each_camera(
                       *call, {call->options, call->images, {pairs, pairs + pair_count}, {}}, found, error)
                                                                    : fit_pairs(*call, pairs, pair_count, found, error);
        });
    });
}

lensprof_status lensprof_fit_radiance(const lensprof_fit_options *options, const lensprof_fit_image *images,
                                      uint32_t image_count, const lensprof_observation *observations,
                                      uint32_t observation_count, lensprof_exposure *exposures,
                                      lensprof_fit_result *result, lensprof_error *error) {
    return at_boundary(error, [&] {
        const auto call = std::make_unique<FitCall>();
        lensprof_status status = take_call(options, images, image_count, observations || observation_count == 0,
                                           exposures, result, *call, error);
        if (status == LENSPROF_OK && call->options.method != LENSPROF_METHOD_RADIANCE)
            return fail(LENSPROF_ERROR_UNSUPPORTED, error, "fit options: tracks require the method radiance");
        if (status == LENSPROF_OK)
            status = check_observations(observations, observation_count, call->images.data(), image_count,
                                        call->channels(), error);
        if (status != LENSPROF_OK) return status;
        if (observation_count == 0) return fail(LENSPROF_ERROR_NO_SAMPLES, error, "fit: no observations were given");
        return run(*call, exposures, result, error, [&](lensprof_exposure *found) {
            if (!has_several_cameras(call->options, call->images))
                return fit_tracks(*call, observations, observation_count, found, error);
            const Tracks tracks = tracks_of(observations, observation_count);
            status = check_tracks(tracks, error);
            if (status != LENSPROF_OK) return status;
            return fit_each_camera(*call,
                                   {call->options,
                                    call->images,
                                    pairs_of(tracks, call->channels()),
                                    {observations, observations + observation_count}},
                                   found, error);
        });
    });
}

lensprof_status lensprof_profile_from_fit(lensprof_profile *profile, const lensprof_fit_result *result,
                                          const lensprof_fit_options *given, uint32_t image_count,
                                          lensprof_error *error) {
    clear(error);
    if (!profile || !result) return fail(LENSPROF_ERROR_ARGUMENT, error, "profile or result is NULL");
    lensprof_fit_options options;
    lensprof_fit_options_init(&options);
    lensprof_fit_result fit;
    lensprof_fit_result_init(&fit);
    const lensprof_status status = take_fitted(given, kFirstOptions, options, result, kFirstResult, fit, error);
    if (status != LENSPROF_OK) return status;
    const auto change = [&](lensprof_profile &target) {
        const uint32_t used = image_count - std::min(fit.left_out, image_count);
        put_result(fit, given ? method_name(options.method) : "", used, target);
        target.responses = 1;
        target.response[0] = fit.response;
        lensprof_gain_grid_init(&target.grid);
        target.provenance.pairs = fit.pairs;
        target.provenance.heldout_rms = fit.heldout_rms;
        target.provenance.gamma_sigma = std::max(fit.gamma_sigma, 0.0);
        const bool is_shown = fit.response_from != LENSPROF_FIT_RESPONSE_KIND;
        std::snprintf(target.provenance.doubt, sizeof target.provenance.doubt, "%s", is_shown ? "" : LP_DOUBT_RESPONSE);
        const bool holds =
            fit.profile_prior != LENSPROF_PROFILE_PRIOR_NONE && fit.profile_prior != LENSPROF_PROFILE_PRIOR_OVERRULED;
        if (!holds || !options.profile) return;
        target.provenance.images = sum_of(used, options.profile->provenance.images);
        target.provenance.pairs = sum_of(fit.pairs, options.profile->provenance.pairs);
    };
    return change_given_profile(profile, change, error);
}

void lensprof_fit_setting_init_sized(lensprof_fit_setting *setting, size_t size) {
    lp_sized_begin(setting, size, kFirstSetting);
}

lensprof_status lensprof_fit_result_take_setting(lensprof_fit_result *result, const lensprof_fit_setting *given,
                                                 lensprof_error *error) {
    clear(error);
    if (!result || !given) return fail(LENSPROF_ERROR_ARGUMENT, error, "result or setting is NULL");
    lensprof_fit_setting setting;
    lensprof_fit_setting_init(&setting);
    if (const char *wrong = lp_sized_take(&setting, given, kFirstSetting))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "setting: %s", wrong);
    lensprof_fit_result local_result;
    lensprof_fit_result_init(&local_result);
    if (const char *wrong = lp_sized_take(&local_result, result, kFirstResult))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "result: %s", wrong);
    if (!setting.images)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "setting: it has no image in the fit; choose one with images");
    copy_setting(setting, local_result);
    local_result.pairs = setting.pairs;
    local_result.left_out = 0;
    lp_sized_copy(result, &local_result);
    return LENSPROF_OK;
}

void lensprof_fit_camera_init_sized(lensprof_fit_camera *camera, size_t size) {
    if (lp_sized_begin(camera, size, kFirstCamera)) lensprof_response_set_linear(&camera->response);
}

lensprof_status lensprof_fit_result_take_camera(lensprof_fit_result *result, const lensprof_fit_camera *given,
                                                lensprof_error *error) {
    clear(error);
    if (!result || !given) return fail(LENSPROF_ERROR_ARGUMENT, error, "result or camera is NULL");
    lensprof_fit_camera camera;
    lensprof_fit_camera_init(&camera);
    if (const char *wrong = lp_sized_take(&camera, given, kFirstCamera))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "camera: %s", wrong);
    lensprof_fit_result local_result;
    lensprof_fit_result_init(&local_result);
    if (const char *wrong = lp_sized_take(&local_result, result, kFirstResult))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "result: %s", wrong);
    if (!camera.images) return fail(LENSPROF_ERROR_ARGUMENT, error, "camera: it has no fit; choose one with images");
    copy_camera(camera, local_result);
    local_result.usable = 0;  // until a setting is copied
    lp_sized_copy(result, &local_result);
    return LENSPROF_OK;
}

lensprof_status lensprof_transfer_rms(const lensprof_response *response, const lensprof_vignetting vignetting[3],
                                      const lensprof_fit_image *images, const lensprof_exposure *exposures,
                                      uint32_t image_count, const lensprof_pair *pairs, uint32_t pair_count,
                                      uint32_t channels, double *rms, double *median, lensprof_error *error) {
    clear(error);
    if (!response || !vignetting || !images || !exposures || !pairs || !rms || !pair_count
        || (channels != 1 && channels != 3))
        return fail(LENSPROF_ERROR_ARGUMENT, error,
                    "transfer rms: a pointer is NULL, there are no pairs, or channels is not 1 or 3");
    lensprof_status status = check_model(*response, vignetting, channels, exposures, image_count, error);
    if (status != LENSPROF_OK) return status;
    try {
        std::vector<lensprof_fit_image> local_images;
        status = take_images(images, image_count, local_images, error);
        if (status == LENSPROF_OK)
            status =
                check_pairs(pairs, pair_count, local_images.data(), image_count, static_cast<int>(channels), error);
        if (status != LENSPROF_OK) return status;
        Summary summary = transfer_summary(*response, vignetting, local_images.data(), exposures, image_count, pairs,
                                           pair_count, static_cast<int>(channels));
        *rms = summary.rms;
        if (median) *median = summary.median;
        return LENSPROF_OK;
    } catch (const std::exception &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "transfer rms: out of memory");
    }
}

}  // extern "C"
