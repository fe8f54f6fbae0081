// The C interface of the overlap fit: argument checks, and conversion of exceptions to status codes.
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <new>

#include "core/profile.h"
#include "fit/api/profile.hpp"
#include "fit/base/sized.hpp"
#include "fit/methods/cameras.hpp"
#include "fit/methods/debevec.hpp"
#include "fit/methods/group.hpp"
#include "fit/methods/overlap.hpp"
#include "fit/methods/transfer_function/transfer_function.hpp"
#include "fit/prior/stored_prior.hpp"
#include "fit/problem/residual.hpp"
#include "fit/problem/tracks.hpp"
#include "fit/verdict/output.hpp"

using namespace lensprof;

namespace {

constexpr uint32_t kSharedFlags =
    LENSPROF_FREE_RESPONSE | LENSPROF_FREE_K1 | LENSPROF_FREE_K2 | LENSPROF_FREE_K3 | LENSPROF_FREE_CENTER;
constexpr uint32_t kImageFlags = LENSPROF_FREE_EV | LENSPROF_FREE_RED | LENSPROF_FREE_BLUE;
constexpr size_t kFirstOptions = LP_END_OF(lensprof_fit_options, progress_user);
constexpr size_t kFirstImage = LP_END_OF(lensprof_fit_image, known_ev_sigma);
constexpr size_t kFirstResult = LP_END_OF(lensprof_fit_result, image_quality);
constexpr size_t kFirstSetting = sizeof(lensprof_fit_setting);
constexpr size_t kFirstCamera = sizeof(lensprof_fit_camera);
constexpr size_t kFirstQuality = LP_END_OF(lensprof_fit_image_quality, known_ev_left_out);

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
        {!(o.free & ~kSharedFlags), "free takes LENSPROF_FREE_RESPONSE, _K1, _K2, _K3 and _CENTER only"},
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
        {o.method <= LENSPROF_METHOD_DEBEVEC, "method must be one of lensprof_fit_method, 0..3"},
        {o.refine <= 1, "refine must be 0 or 1"},
        {!o.reserved && !o.reserved2, "reserved and reserved2 must be 0"},
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
        if (image.free & ~kImageFlags)
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

// Checks what the method `debevec` requires as known, and that only the response is free.
lensprof_status check_debevec(const lensprof_fit_options &o, const lensprof_fit_image *images, uint32_t image_count,
                              lensprof_error *error) {
    if (o.free != LENSPROF_FREE_RESPONSE)
        return fail(LENSPROF_ERROR_ARGUMENT, error,
                    "fit options: the method debevec estimates only the response; free it, and fix falloff and centre");
    for (uint32_t i = 0; i < image_count; i++)
        if (!(images[i].known_ev_sigma > 0.0))
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "the method debevec needs the known exposures of all images (known_ev, and a "
                           "known_ev_sigma above 0); give them, or use the method transfer");
    for (uint32_t i = 0; i < image_count; i++)
        if (!(std::abs(known_exposure(images, o.reference, i)) <= 64.0))
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_EXPOSURE, error,
                           "known exposure beyond 64 EV relative to the reference");
    return LENSPROF_OK;
}

bool has_unknowns(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t count) {
    if (options.method == LENSPROF_METHOD_DEBEVEC) return true;  // the response, without modes
    Problem problem = make_problem(options, images, count, nullptr, {});
    return problem.image_unknowns > 0 || !free_columns(problem, options.modes == 0 ? 0 : 1).empty();
}

// All arguments and results of a call except pairs, observations and exposures, in this library's struct versions.
struct Call {
    lensprof_fit_options options;
    lensprof_response linear;
    std::vector<lensprof_fit_image> images;
    lensprof_fit_result result;
    std::vector<lensprof_fit_image_quality> quality;
    std::vector<lensprof_fit_setting> settings;      // empty if all images have setting 0
    std::vector<lensprof_fit_camera> cameras;        // empty if all images have camera 0
    lensprof_fit_setting *given_settings = nullptr;  // the caller's arrays, or NULL
    lensprof_fit_camera *given_cameras = nullptr;
    uint32_t given_setting_count = 0, given_camera_count = 0;

    uint32_t count() const { return static_cast<uint32_t>(images.size()); }
    int channels() const { return static_cast<int>(options.channels); }
};

lensprof_status take_images(const lensprof_fit_image *given, uint32_t count, std::vector<lensprof_fit_image> &images,
                            lensprof_error *error) {
    auto init = [](lensprof_fit_image &image, uint32_t i) { lensprof_fit_image_init(&image, i, 0, 0); };
    lensprof_status status = take_all(given, count, kFirstImage, LENSPROF_ITEM_IMAGE, init, images, error);
    if (status == LENSPROF_OK) status = check_images(images.data(), count, error);
    return status == LENSPROF_OK ? check_cameras(images, error) : status;
}

// Rejects more than one setting per camera for methods that estimate a single falloff.
lensprof_status check_settings(const Call &call, lensprof_error *error) {
    const uint32_t method = call.options.method;
    if (method != LENSPROF_METHOD_TRANSFER_FUNCTION && method != LENSPROF_METHOD_DEBEVEC) return LENSPROF_OK;
    std::map<uint32_t, uint32_t> setting_of;  // per camera
    for (uint32_t i = 0; i < call.count(); i++) {
        const lensprof_fit_image &image = call.images[i];
        const uint32_t camera = method == LENSPROF_METHOD_DEBEVEC ? 0 : image.camera;
        if (setting_of.try_emplace(camera, image.setting).first->second != image.setting)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_UNSUPPORTED, error,
                           "has another lens setting; use the method transfer or radiance to fit several");
        if (method == LENSPROF_METHOD_DEBEVEC && image.camera != call.images[0].camera)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_UNSUPPORTED, error,
                           "belongs to another camera; the method debevec fits one camera at a time");
    }
    return LENSPROF_OK;
}

// Allocates results for lens settings or cameras: as many as the images name, or as the caller asks for. None if all
// numbers are 0 and the caller does not ask for any.
template <class Item, class Init>
lensprof_status take_items(Item *given, uint32_t given_count, uint32_t last, uint32_t max_count, size_t first_size,
                           Init init, std::vector<Item> &items, lensprof_error *error) {
    std::vector<Item> checked;
    const uint32_t count = given ? std::min(given_count, max_count) : 0;
    const lensprof_status status = take_all(given, count, first_size, LENSPROF_ITEM_NONE, init, checked, error);
    if (status != LENSPROF_OK || (last == 0 && !given)) return status;
    items.resize(std::max(last + 1, count));
    for (Item &item : items) init(item, 0);
    return LENSPROF_OK;
}

lensprof_status take_settings(const lensprof_fit_result &given, Call &call, lensprof_error *error) {
    lensprof_fit_result taken;  // without these members if the caller's version is older
    lensprof_fit_result_init(&taken);
    lp_sized_copy(&taken, &given);
    call.given_settings = taken.settings, call.given_setting_count = taken.setting_count;
    call.given_cameras = taken.cameras, call.given_camera_count = taken.camera_count;
    uint32_t last_setting = 0, last_camera = 0;
    for (uint32_t i = 0; i < call.count(); i++) {
        last_setting = std::max(last_setting, call.images[i].setting);
        last_camera = std::max(last_camera, call.images[i].camera);
        if (taken.settings && call.images[i].setting >= taken.setting_count)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "its setting is %u, but the result has room for %u", call.images[i].setting,
                           taken.setting_count);
        if (taken.cameras && call.images[i].camera >= taken.camera_count)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "its camera is %u, but the result has room for %u", call.images[i].camera,
                           taken.camera_count);
    }
    lensprof_status status = check_settings(call, error);
    if (status == LENSPROF_OK)
        status = take_items(
            taken.settings, taken.setting_count, last_setting, LENSPROF_SETTINGS_MAX, kFirstSetting,
            [](lensprof_fit_setting &setting, uint32_t) { lensprof_fit_setting_init(&setting); }, call.settings, error);
    if (status == LENSPROF_OK)
        status = take_items(
            taken.cameras, taken.camera_count, last_camera, LENSPROF_CAMERAS_MAX, kFirstCamera,
            [](lensprof_fit_camera &camera, uint32_t) { lensprof_fit_camera_init(&camera); }, call.cameras, error);
    if (!call.settings.empty()) call.result.settings = call.settings.data();
    call.result.setting_count = static_cast<uint32_t>(call.settings.size());
    if (!call.cameras.empty()) call.result.cameras = call.cameras.data();
    call.result.camera_count = static_cast<uint32_t>(call.cameras.size());
    return status;
}

template <class Item>
void give_items(Item *given, uint32_t given_count, const std::vector<Item> &items) {
    auto *bytes = reinterpret_cast<char *>(given);
    const size_t step = bytes ? lp_sized_bytes(bytes) : 0;
    for (size_t n = 0; bytes && n < std::min<size_t>(given_count, items.size()); n++)
        lp_sized_copy(bytes + n * step, &items[n]);
}

// Copies the settings into the caller's arrays, which may have fewer elements than this library's. Their addresses and
// sizes in the result stay.
void give_settings(Call &call) {
    give_items(call.given_settings, call.given_setting_count, call.settings);
    give_items(call.given_cameras, call.given_camera_count, call.cameras);
    call.result.settings = call.given_settings, call.result.setting_count = call.given_setting_count;
    call.result.cameras = call.given_cameras, call.result.camera_count = call.given_camera_count;
}

// Checks common to both fits: everything except the pairs or observations.
lensprof_status take_call(const lensprof_fit_options *options, const lensprof_fit_image *images, uint32_t image_count,
                          bool has_data, const lensprof_exposure *exposures, const lensprof_fit_result *result,
                          Call &call, lensprof_error *error) {
    clear(error);
    if (!options || !images || !exposures || !result || !has_data)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: a pointer is NULL");
    if (image_count < 2) return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: at least two images are needed");
    lensprof_status status =
        check_result(*result, kFirstResult, kFirstQuality, result->image_quality, "fit result", error);
    if (status != LENSPROF_OK) return status;
    lensprof_fit_options_init(&call.options);
    if (const char *wrong = lp_sized_take(&call.options, options, kFirstOptions))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "fit options: %s", wrong);
    status = check_options(call.options, image_count, error);
    if (call.options.camera_kind == LENSPROF_CAMERA_LINEAR && (call.options.free & LENSPROF_FREE_RESPONSE)
        && call.options.method != LENSPROF_METHOD_DEBEVEC) {
        lensprof_response_set_linear(&call.linear);
        call.options.response = &call.linear;
        call.options.free &= ~LENSPROF_FREE_RESPONSE;
    }
    if (status == LENSPROF_OK) status = take_images(images, image_count, call.images, error);
    lensprof_fit_result_init(&call.result);
    if (status == LENSPROF_OK && result->image_quality) call.quality.resize(image_count);
    call.result.image_quality = call.quality.empty() ? nullptr : call.quality.data();
    return status == LENSPROF_OK ? take_settings(*result, call, error) : status;
}

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
lensprof_status run(Call &call, lensprof_fit_result *result, lensprof_error *error, Fit fit) {
    if (!has_unknowns(call.options, call.images.data(), call.count()))
        return fail(LENSPROF_ERROR_NO_UNKNOWNS, error, "fit: every parameter is fixed; free at least one");
    const auto began = std::chrono::steady_clock::now();
    const lensprof_status status = fit();
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - began;
    if (status != LENSPROF_OK) return status;
    call.result.seconds = taken.count();
    give_settings(call);
    give_result(call.result, call.quality, result);
    return LENSPROF_OK;
}

lensprof_status fit_tracks(Call &call, const lensprof_observation *observations, uint32_t count,
                           lensprof_exposure *exposures, lensprof_error *error) {
    Tracks tracks = tracks_of(observations, count);
    lensprof_status status = check_tracks(tracks, error);
    if (status != LENSPROF_OK) return status;
    const auto within = [&](const Group &group) {
        return tracks_within(tracks, [&](uint32_t i, uint32_t j) { return group.holds(i, j); });
    };
    if (pairs_of(tracks, call.channels()).empty())
        return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                    "fit: no point has two observations that are neither black nor saturated");
    const auto fit = [&](const lensprof_fit_options &options, const Group &group, lensprof_exposure *found,
                         lensprof_fit_result &result) {
        fit_radiance(options, call.images.data(), call.count(), within(group), found, result);
    };
    const auto pairs_within = [&](const Group &group) { return pairs_of(within(group), call.channels()); };
    fit_largest_group(call.options, call.images.data(), call.count(), pairs_within, fit, exposures, call.result);
    return LENSPROF_OK;
}

// Fits the largest group of images that agree, with a method of pairs.
template <class Method>
void fit_group(Call &call, const lensprof_pair *pairs, uint32_t count, lensprof_exposure *exposures, Method method) {
    const auto pairs_within = [&](const Group &group) {
        std::vector<lensprof_pair> group_pairs;
        std::copy_if(pairs, pairs + count, std::back_inserter(group_pairs),
                     [&](const lensprof_pair &pair) { return group.holds(pair.image[0], pair.image[1]); });
        return group_pairs;
    };
    const auto fit = [&](const lensprof_fit_options &options, const Group &group, lensprof_exposure *found,
                         lensprof_fit_result &result) {
        const std::vector<lensprof_pair> group_pairs = pairs_within(group);
        method(options, call.images.data(), call.count(), group_pairs.data(), static_cast<uint32_t>(group_pairs.size()),
               found, result);
    };
    fit_largest_group(call.options, call.images.data(), call.count(), pairs_within, fit, exposures, call.result);
}

lensprof_status fit_pairs(Call &call, const lensprof_pair *pairs, uint32_t count, lensprof_exposure *exposures,
                          lensprof_error *error) {
    const auto &options = call.options;
    const lensprof_fit_image *images = call.images.data();
    if (options.method == LENSPROF_METHOD_RADIANCE) {
        std::vector<lensprof_observation> observations = observations_of(pairs, count, call.channels());
        return fit_tracks(call, observations.data(), static_cast<uint32_t>(observations.size()), exposures, error);
    }
    if (options.method == LENSPROF_METHOD_TRANSFER)
        fit_group(call, pairs, count, exposures, fit_overlap);
    else if (options.method == LENSPROF_METHOD_TRANSFER_FUNCTION)
        fit_group(call, pairs, count, exposures, fit_transfer_functions);
    else
        fit_debevec(options, images, call.count(), pairs, count, exposures, call.result);
    return LENSPROF_OK;
}

// Fits one camera of several, using only its images.
bool fit_camera(const CameraInput &input, lensprof_exposure *exposures, lensprof_fit_result &result) {
    if (!has_unknowns(input.options, input.images.data(), static_cast<uint32_t>(input.images.size()))) return false;
    Call call;
    call.options = input.options;
    call.images = input.images;
    call.result = result;
    const auto pairs = static_cast<uint32_t>(input.pairs.size()),
               observations = static_cast<uint32_t>(input.observations.size());
    const lensprof_status status = observations
                                       ? fit_tracks(call, input.observations.data(), observations, exposures, nullptr)
                                       : fit_pairs(call, input.pairs.data(), pairs, exposures, nullptr);
    result = call.result;
    return status == LENSPROF_OK;
}

lensprof_status fit_each_camera(Call &call, const CamerasData &data, lensprof_exposure *exposures,
                                lensprof_error *error) {
    if (fit_cameras(data, fit_camera, exposures, call.result)) return LENSPROF_OK;
    return fail(
        LENSPROF_ERROR_NO_SAMPLES, error,
        "fit: no pair connects two images of the same camera; give more images of it, or treat all as one camera");
}

const char *method_name(uint32_t method) {
    switch (method) {
    case LENSPROF_METHOD_TRANSFER: return "transfer";
    case LENSPROF_METHOD_RADIANCE: return "radiance";
    case LENSPROF_METHOD_TRANSFER_FUNCTION: return "transfer-function";
    case LENSPROF_METHOD_DEBEVEC: return "debevec";
    default: return "";
    }
}

// Sum of counts; saturates instead of overflowing.
uint32_t sum_of(uint32_t a, uint32_t b) { return a + std::min(b, UINT32_MAX - a); }

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
        const auto call = std::make_unique<Call>();
        lensprof_status status =
            take_call(options, images, image_count, pairs || pair_count == 0, exposures, result, *call, error);
        if (status == LENSPROF_OK)
            status = check_pairs(pairs, pair_count, call->images.data(), image_count, call->channels(), error);
        if (status == LENSPROF_OK && call->options.method == LENSPROF_METHOD_DEBEVEC)
            status = check_debevec(call->options, call->images.data(), image_count, error);
        if (status != LENSPROF_OK) return status;
        if (pair_count == 0) return fail(LENSPROF_ERROR_NO_SAMPLES, error, "fit: no pairs were given");
        return run(*call, result, error, [&] {
            return has_several_cameras(call->options, call->images)
                       ? fit_each_camera(*call, {call->options, call->images, {pairs, pairs + pair_count}, {}},
                                         exposures, error)
                       : fit_pairs(*call, pairs, pair_count, exposures, error);
        });
    });
}

lensprof_status lensprof_fit_radiance(const lensprof_fit_options *options, const lensprof_fit_image *images,
                                      uint32_t image_count, const lensprof_observation *observations,
                                      uint32_t observation_count, lensprof_exposure *exposures,
                                      lensprof_fit_result *result, lensprof_error *error) {
    return at_boundary(error, [&] {
        const auto call = std::make_unique<Call>();
        lensprof_status status = take_call(options, images, image_count, observations || observation_count == 0,
                                           exposures, result, *call, error);
        if (status == LENSPROF_OK && call->options.method != LENSPROF_METHOD_RADIANCE)
            return fail(LENSPROF_ERROR_UNSUPPORTED, error, "fit options: tracks require the method radiance");
        if (status == LENSPROF_OK)
            status = check_observations(observations, observation_count, call->images.data(), image_count,
                                        call->channels(), error);
        if (status != LENSPROF_OK) return status;
        if (observation_count == 0) return fail(LENSPROF_ERROR_NO_SAMPLES, error, "fit: no observations were given");
        return run(*call, result, error, [&] {
            if (!has_several_cameras(call->options, call->images))
                return fit_tracks(*call, observations, observation_count, exposures, error);
            const Tracks tracks = tracks_of(observations, observation_count);
            status = check_tracks(tracks, error);
            if (status != LENSPROF_OK) return status;
            return fit_each_camera(*call,
                                   {call->options,
                                    call->images,
                                    pairs_of(tracks, call->channels()),
                                    {observations, observations + observation_count}},
                                   exposures, error);
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
