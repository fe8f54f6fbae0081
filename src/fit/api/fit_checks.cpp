// Checks of options, images, pairs and observations of the overlap fit.
#include "fit/api/fit_checks.hpp"

#include <cmath>
#include <map>

#include "core/profile.h"
#include "fit/base/fail.hpp"
#include "fit/prior/stored_prior.hpp"

namespace lensprof {
namespace {

// Checks the profile that is used as the prior.
lensprof_status check_profile(const lensprof_fit_options &o, lensprof_error *error) {
    if (o.method != LENSPROF_METHOD_TRANSFER && o.method != LENSPROF_METHOD_RADIANCE)
        return fail(LENSPROF_ERROR_UNSUPPORTED, error,
                    "fit options: only the methods transfer and radiance use a profile as the prior; leave it out");
    if (!(o.prior_weight > 0.0))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fit options: a profile as the prior requires prior_weight > 0");
    lensprof_status status = lensprof_profile_validate(o.profile);
    if (status != LENSPROF_OK)
        return fail(status, error, "fit options: the profile is invalid; see lensprof_profile_validate");
    if (!has_uncertainty(*o.profile))
        return fail(
            LENSPROF_ERROR_ARGUMENT, error,
            "fit options: the profile has neither a covariance nor the gamma_sigma of a refined response, so its "
            "uncertainty is unknown; leave it out");
    if (!is_covariance(*o.profile))
        return fail(LENSPROF_ERROR_ARGUMENT, error,
                    "fit options: the profile's covariance is not positive semi-definite; "
                    "leave it out");
    return LENSPROF_OK;
}

// The first option that is out of range, with its range; NULL if all are valid.
const char *broken_option(const lensprof_fit_options &o, uint32_t image_count) {
    const Rule rules[] = {
        {o.channels == 1 || o.channels == 3, "channels must be 1 or 3"},
        {o.reference < image_count, "reference must be less than the number of images"},
        {!(o.free & ~LENSPROF_FREE_LENS), "free takes LENSPROF_FREE_RESPONSE, _K1, _K2, _K3 and _CENTER only"},
        {o.modes <= LENSPROF_EMOR_MODES || o.modes == LENSPROF_MODES_AUTO,
         "modes must be 0..25 or LENSPROF_MODES_AUTO"},
        {o.loss <= LENSPROF_LOSS_SQUARED, "loss must be one of lensprof_loss, 0..2"},
        {o.huber_levels > 0.0 && o.huber_levels <= 255.0, "huber_levels must be above 0 and at most 255"},
        {o.prior_weight >= 0.0 && o.prior_weight <= 1e6, "prior_weight must be 0..1000000"},
        {o.max_iterations >= 1 && o.max_iterations <= 1000000, "max_iterations must be 1..1000000"},
        {o.vignettings <= 1 || o.vignettings == 3, "vignettings must be 0, 1 or 3"},
        {o.gamma_from <= LENSPROF_GAMMA_EXPOSURES,
         "gamma_from must be LENSPROF_GAMMA_AUTO, _PRIOR or _EXPOSURES; the others occur only in results"},
        {o.camera_kind <= LENSPROF_CAMERA_LINEAR, "camera_kind must be one of lensprof_camera_kind, 0..5"},
        {o.method <= LENSPROF_METHOD_TRANSFER_FUNCTION, "method must be one of lensprof_fit_method, 0..2"},
        {o.refine <= 1, "refine must be 0 or 1"},
        {o.moving_camera <= 1, "moving_camera must be 0 or 1"},
        {o.links || !o.link_count, "links must not be NULL if link_count is not 0"},
    };
    return first_broken(rules);
}

lensprof_status check_links(const lensprof_fit_options &o, uint32_t image_count, lensprof_error *error) {
    for (uint32_t n = 0; n < o.link_count; n++) {
        const lensprof_link &link = o.links[n];
        if (link.image[0] >= link.image[1] || link.image[1] >= image_count || link.state > LENSPROF_LINK_CONTRADICTED)
            return fail(LENSPROF_ERROR_ARGUMENT, error,
                        "fit options: link %u joins images %u and %u of %u, or its state is not one of "
                        "lensprof_link_state; give the smaller image first",
                        n, link.image[0], link.image[1], image_count);
    }
    return LENSPROF_OK;
}

}  // namespace

lensprof_status check_options(const lensprof_fit_options &o, uint32_t image_count, lensprof_error *error) {
    if (const char *wrong = broken_option(o, image_count))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fit options: %s", wrong);
    lensprof_status status = lensprof_vignetting_validate(&o.vignetting);
    if (status != LENSPROF_OK)
        return fail(status, error, "fit options: the given vignetting is not positive and finite");
    status = o.response ? lensprof_response_validate(o.response) : LENSPROF_OK;
    if (status != LENSPROF_OK)
        return fail(status, error, "fit options: the given response is not monotone from 0 to 1");
    status = check_links(o, image_count, error);
    if (status != LENSPROF_OK) return status;
    return o.profile ? check_profile(o, error) : LENSPROF_OK;
}

lensprof_status check_images(const lensprof_fit_image *images, uint32_t count, lensprof_error *error) {
    for (uint32_t i = 0; i < count; i++) {
        const auto &image = images[i];
        if (!image.width || !image.height || image.width > (1u << 20) || image.height > (1u << 20))
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_SIZE, error, "sizes must be 1..1048576");
        if (lensprof_exposure_validate(&image.exposure) != LENSPROF_OK)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_EXPOSURE, error,
                           "exposure or white balance out of range");
        if (image.known_ev_sigma != 0.0
            && !(image.known_ev_sigma >= 1e-3 && image.known_ev_sigma <= 100.0 && std::abs(image.known_ev) <= 64.0))
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_EXPOSURE, error,
                           "known_ev beyond 64 EV, or known_ev_sigma neither 0 nor 0.001..100");
        if (image.f_number_ratio != 0.0 && !(image.f_number_ratio >= 1.0 && image.f_number_ratio <= 1024.0))
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "f_number_ratio must be 0 (unknown) or 1..1024");
        if (image.crop_factor != 0.0 && !(image.crop_factor >= 0.1 && image.crop_factor <= 100.0))
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "crop_factor must be 0 (unknown) or 0.1..100");
        if (image.free & ~LENSPROF_FREE_IMAGE)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "only EV, RED and BLUE can be free in an image");
        if (image.setting >= LENSPROF_SETTINGS_MAX)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error, "setting must be 0..%d",
                           LENSPROF_SETTINGS_MAX - 1);
        if (image.camera >= LENSPROF_CAMERAS_MAX || image.reserved)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "camera must be 0..%d, and reserved 0", LENSPROF_CAMERAS_MAX - 1);
        for (uint32_t owner : {image.ev_of, image.red_of, image.blue_of})
            if (owner >= count)
                return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error, "linked to image %u of %u",
                               owner, count);
        if (images[image.ev_of].ev_of != image.ev_of || images[image.red_of].red_of != image.red_of
            || images[image.blue_of].blue_of != image.blue_of)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "linked to an image that is linked itself");
    }
    return LENSPROF_OK;
}

// Checks that every setting belongs to one camera.
lensprof_status check_cameras(const std::vector<lensprof_fit_image> &images, lensprof_error *error) {
    std::map<uint32_t, uint32_t> first;  // image of each setting
    for (uint32_t i = 0; i < images.size(); i++) {
        const uint32_t other = first.try_emplace(images[i].setting, i).first->second;
        if (images[other].camera != images[i].camera)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "has setting %u like image %u, but another camera; give it a separate setting",
                           images[i].setting, other);
    }
    return LENSPROF_OK;
}

namespace {

// Checks a position and grey values in an image; errors name the item of `item_kind` and its number.
lensprof_status check_end(const double xy[2], const double value[3], const lensprof_fit_image &frame, uint32_t image,
                          int channels, lensprof_item_kind item_kind, uint32_t number, lensprof_error *error) {
    double x = xy[0], y = xy[1];
    if (!std::isfinite(x) || !std::isfinite(y))
        return fail_at(item_kind, number, LENSPROF_ERROR_NOT_FINITE, error, "a position is not a number");
    if (x < -1.0 || y < -1.0 || x > frame.width || y > frame.height)
        return fail_at(item_kind, number, LENSPROF_ERROR_ARGUMENT, error, "position %g, %g is outside image %u", x, y,
                       image);
    for (int c = 0; c < channels; c++) {
        if (!std::isfinite(value[c]))
            return fail_at(item_kind, number, LENSPROF_ERROR_NOT_FINITE, error, "a grey value is not a number");
        if (value[c] < 0.0 || value[c] > 1.0)
            return fail_at(item_kind, number, LENSPROF_ERROR_ARGUMENT, error, "grey values must be 0..1");
    }
    return LENSPROF_OK;
}

}  // namespace

lensprof_status check_pairs(const lensprof_pair *pairs, uint32_t count, const lensprof_fit_image *images,
                            uint32_t image_count, int channels, lensprof_error *error) {
    for (uint32_t p = 0; p < count; p++) {
        const auto &pair = pairs[p];
        if (pair.image[0] >= image_count || pair.image[1] >= image_count || pair.image[0] == pair.image[1])
            return fail_at(LENSPROF_ITEM_PAIR, p, LENSPROF_ERROR_ARGUMENT, error, "images %u and %u of %u",
                           pair.image[0], pair.image[1], image_count);
        for (int side = 0; side < 2; side++) {
            uint32_t image = pair.image[side];
            lensprof_status status = check_end(pair.xy[side], pair.value[side], images[image], image, channels,
                                               LENSPROF_ITEM_PAIR, p, error);
            if (status != LENSPROF_OK) return status;
        }
    }
    return LENSPROF_OK;
}

lensprof_status check_scene(const lensprof_fit_options &o, uint32_t pair_count, lensprof_error *error) {
    if (o.view_distances && !o.points)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fit options: view_distances need points");
    for (uint32_t p = 0; o.view_distances && p < pair_count; p++)
        if (!(o.view_distances[p] >= 0.0 && std::isfinite(o.view_distances[p])))
            return fail_at(LENSPROF_ITEM_PAIR, p, LENSPROF_ERROR_ARGUMENT, error,
                           "view distance must be at least 0 and finite");
    return LENSPROF_OK;
}

lensprof_status check_observations(const lensprof_observation *observations, uint32_t count,
                                   const lensprof_fit_image *images, uint32_t image_count, int channels,
                                   lensprof_error *error) {
    for (uint32_t n = 0; n < count; n++) {
        const auto &o = observations[n];
        if (o.image >= image_count)
            return fail_at(LENSPROF_ITEM_OBSERVATION, n, LENSPROF_ERROR_ARGUMENT, error, "image %u of %u", o.image,
                           image_count);
        lensprof_status status =
            check_end(o.xy, o.value, images[o.image], o.image, channels, LENSPROF_ITEM_OBSERVATION, n, error);
        if (status != LENSPROF_OK) return status;
    }
    return LENSPROF_OK;
}

lensprof_status check_tracks(const Tracks &tracks, lensprof_error *error) {
    for (const Range &track : tracks.tracks) {
        const auto &first = tracks.observations[track.first];
        if (track.last - track.first < 2)
            return fail_at(LENSPROF_ITEM_POINT, first.point, LENSPROF_ERROR_ARGUMENT, error,
                           "only one observation; leave out points without a second one");
        for (size_t i = track.first + 1; i < track.last; i++)
            if (tracks.observations[i].image == tracks.observations[i - 1].image)
                return fail_at(LENSPROF_ITEM_POINT, first.point, LENSPROF_ERROR_ARGUMENT, error,
                               "two observations in image %u; leave one out", tracks.observations[i].image);
    }
    return LENSPROF_OK;
}

lensprof_status check_model(const lensprof_response &response, const lensprof_vignetting *vignetting, uint32_t channels,
                            const lensprof_exposure *exposures, uint32_t image_count, lensprof_error *error) {
    lensprof_status status = lensprof_response_validate(&response);
    if (status != LENSPROF_OK) return fail(status, error, "the response is invalid; see lensprof_response_validate");
    for (uint32_t c = 0; c < channels; c++)
        if ((status = lensprof_vignetting_validate(&vignetting[c])) != LENSPROF_OK)
            return fail(status, error, "vignetting %u is invalid; see lensprof_vignetting_validate", c);
    for (uint32_t i = 0; i < image_count; i++)
        if ((status = lensprof_exposure_validate(&exposures[i])) != LENSPROF_OK)
            return fail_at(LENSPROF_ITEM_IMAGE, i, status, error,
                           "its exposure is invalid; see lensprof_exposure_validate");
    return LENSPROF_OK;
}

}  // namespace lensprof
