// The C interface of the flat field fit: argument checks, and conversion of exceptions to status codes.
#include <cmath>
#include <memory>
#include <new>

#include "fit/api/profile.hpp"
#include "fit/base/parallel.hpp"
#include "fit/base/sized.hpp"
#include "fit/flat/fit.hpp"

using namespace lensprof;

namespace {

constexpr uint32_t kLensFlags = LENSPROF_FREE_K1 | LENSPROF_FREE_K2 | LENSPROF_FREE_K3 | LENSPROF_FREE_CENTER;
constexpr double kLargestTurn = 360.0;
constexpr size_t kFirstFlatOptions = LP_END_OF(lensprof_flat_options, progress_user);
constexpr size_t kFirstFlatImage = LP_END_OF(lensprof_flat_image, turn_deg);
constexpr size_t kFirstFlatResult = LP_END_OF(lensprof_flat_result, image_quality);
constexpr size_t kFirstQuality = LP_END_OF(lensprof_flat_image_quality, reserved);

// The first option that is out of range, with its range; NULL if all are valid.
const char *broken_option(const lensprof_flat_options &o) {
    const Rule rules[] = {
        {o.channels == 1 || o.channels == 3, "channels must be 1 or 3"},
        {!(o.free & ~kLensFlags), "free takes LENSPROF_FREE_K1, _K2, _K3 and _CENTER only"},
        {o.vignettings <= 1 || o.vignettings == 3, "vignettings must be 0, 1 or 3"},
        {o.vignettings != 3 || o.channels == 3, "vignettings must be 0 or 1 if channels is 1"},
        {o.light <= LENSPROF_FLAT_LIGHT_QUADRATIC, "light must be one of lensprof_flat_light, 0..3"},
        {o.own_light <= 1, "own_light must be 0 or 1"},
        {o.several <= 1, "several must be 0 or 1"},
        {o.find_card <= 1, "find_card must be 0 or 1"},
        {o.grid <= LENSPROF_FLAT_GRID_ALWAYS, "grid must be one of lensprof_flat_grid, 0..2"},
        {o.responses == 1 || o.responses == 3, "responses must be 1 or 3"},
        {o.ev_sigma >= 1e-3 && o.ev_sigma <= 1.0, "ev_sigma must be 0.001..1 EV"},
        {o.prior_weight >= 0.0 && o.prior_weight <= 1e6, "prior_weight must be 0..1000000"},
        {!o.reserved, "reserved must be 0"},
    };
    return first_broken(rules);
}

lensprof_status check_options(const lensprof_flat_options &o, uint32_t count, lensprof_error *error) {
    if (count == 0 || count > LENSPROF_FLAT_IMAGES)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "flat: %u pictures; give 1 to %d", count, LENSPROF_FLAT_IMAGES);
    if (const char *wrong = broken_option(o)) return fail(LENSPROF_ERROR_ARGUMENT, error, "flat options: %s", wrong);
    if (o.several && o.light > LENSPROF_FLAT_LIGHT_EVEN)
        return fail(LENSPROF_ERROR_ARGUMENT, error,
                    "flat options: a card at several places has one brightness; its light must be even");
    if (!o.free)
        return fail(LENSPROF_ERROR_NO_UNKNOWNS, error, "flat: falloff and centre are fixed; free at least one");
    lensprof_status status = lensprof_vignetting_validate(&o.vignetting);
    if (status != LENSPROF_OK)
        return fail(status, error, "flat options: the given vignetting is not positive and finite");
    for (uint32_t c = 0; o.response && c < o.responses && status == LENSPROF_OK; c++)
        status = lensprof_response_validate(&o.response[c]);
    return status == LENSPROF_OK ? status : fail(status, error, "flat options: a response is not monotone from 0 to 1");
}

lensprof_status check_image(const lensprof_flat_options &o, const lensprof_flat_image *images, uint32_t i,
                            lensprof_error *error) {
    const auto &image = images[i];
    if (image.reserved) return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error, "reserved is not 0");
    lensprof_status status = check_view(sample_image_of(image), i, error);
    if (status != LENSPROF_OK) return status;
    if (image.width != images[0].width || image.height != images[0].height)
        return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_SIZE, error,
                       "a frame of %u x %u, not %u x %u like the first", image.width, image.height, images[0].width,
                       images[0].height);
    if (o.channels == 3 && lensprof_layout_channels(image.view.layout) != 3)
        return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error, "a grey picture; set channels to 1");
    if (!(std::abs(image.ev) <= 64.0))
        return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_EXPOSURE, error, "exposure beyond 64 EV");
    if (!(std::abs(image.turn_deg) <= kLargestTurn))
        return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error, "rotated by more than 360 degrees");
    for (uint32_t j = 0; j < i; j++)
        if (images[j].shot == image.shot && images[j].turn_deg != image.turn_deg)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "in the same shot as image %u, but rotated differently", j);
    return LENSPROF_OK;
}

// All arguments and results of the call, in this library's struct versions.
struct Call {
    lensprof_flat_options options;
    std::vector<lensprof_flat_image> images;
    lensprof_flat_result result;
    std::vector<lensprof_flat_image_quality> quality;
};

lensprof_status take_call(const lensprof_flat_options *options, const lensprof_flat_image *images, uint32_t count,
                          const lensprof_flat_result &result, Call &call, lensprof_error *error) {
    lensprof_status status =
        check_result(result, kFirstFlatResult, kFirstQuality, result.image_quality, "flat result", error);
    if (status != LENSPROF_OK) return status;
    lensprof_flat_options_init(&call.options);
    if (const char *wrong = lp_sized_take(&call.options, options, kFirstFlatOptions))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "flat options: %s", wrong);
    status = check_options(call.options, count, error);
    auto init = [](lensprof_flat_image &image, uint32_t) { lensprof_flat_image_init(&image); };
    if (status == LENSPROF_OK)
        status = take_all(images, count, kFirstFlatImage, LENSPROF_ITEM_IMAGE, init, call.images, error);
    for (uint32_t i = 0; i < count && status == LENSPROF_OK; i++)
        status = check_image(call.options, call.images.data(), i, error);
    lensprof_flat_result_init(&call.result);
    if (result.image_quality) call.quality.resize(count);
    call.result.image_quality = result.image_quality ? call.quality.data() : nullptr;
    return status;
}

lensprof_status run(Call &call, lensprof_error *error) {
    const auto &options = call.options;
    const auto count = static_cast<uint32_t>(call.images.size());
    auto stop = [&] { return options.progress && options.progress(0.0, options.progress_user) != 0; };
    auto place = [&](uint32_t i) { return sample_image_of(call.images[i]); };
    const lensprof_status status = check_finite(place, count, options.threads, stop, error);
    if (status != LENSPROF_OK) return status;
    if (!fit_flat(options, call.images.data(), count, call.result))
        return fail(
            LENSPROF_ERROR_NO_SAMPLES, error,
            "no part of a card lies between black and white; check exposures, limits, and the position of the card");
    return LENSPROF_OK;
}

}  // namespace

extern "C" {

void lensprof_flat_image_init_sized(lensprof_flat_image *image, size_t size) {
    if (!lp_sized_begin(image, size, kFirstFlatImage)) return;
    image->reduction = 1;
    image->black = 2.0 / 255.0;
    image->white = 250.0 / 255.0;
}

void lensprof_flat_options_init_sized(lensprof_flat_options *options, size_t size) {
    if (!lp_sized_begin(options, size, kFirstFlatOptions)) return;
    options->channels = 3;
    options->free = kLensFlags;
    options->responses = 1;
    options->ev_sigma = 0.02;
    options->prior_weight = 1.0;
}

void lensprof_flat_result_init_sized(lensprof_flat_result *result, size_t size, size_t image_quality_size) {
    if (lp_sized_begin(result, size, kFirstFlatResult))
        result->image_quality_size = static_cast<uint32_t>(image_quality_size);
}

lensprof_status lensprof_fit_flat(const lensprof_flat_options *options, const lensprof_flat_image *images,
                                  uint32_t image_count, lensprof_flat_result *result, lensprof_error *error) {
    clear(error);
    if (!options || !images || !result) return fail(LENSPROF_ERROR_ARGUMENT, error, "flat: a pointer is NULL");
    try {
        const auto call = std::make_unique<Call>();
        lensprof_status status = take_call(options, images, image_count, *result, *call, error);
        if (status == LENSPROF_OK) status = run(*call, error);
        if (status == LENSPROF_OK) give_result(call->result, call->quality, result);
        return status;
    } catch (const Cancelled &) {
        return fail(LENSPROF_ERROR_CANCELLED, error, "flat: cancelled");
    } catch (const std::bad_alloc &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "flat: out of memory");
    } catch (const std::exception &e) {
        return fail(LENSPROF_ERROR_INTERNAL, error, "flat: %s", e.what());
    } catch (...) {
        return fail(LENSPROF_ERROR_INTERNAL, error, "flat: an unknown exception");
    }
}

lensprof_status lensprof_profile_from_flat(lensprof_profile *profile, const lensprof_flat_result *result,
                                           const lensprof_flat_options *given, uint32_t image_count,
                                           lensprof_error *error) {
    clear(error);
    if (!profile || !result) return fail(LENSPROF_ERROR_ARGUMENT, error, "profile or result is NULL");
    lensprof_flat_options options;
    lensprof_flat_options_init(&options);
    lensprof_flat_result flat;
    lensprof_flat_result_init(&flat);
    const lensprof_status status =
        take_fitted(given, kFirstFlatOptions, options, result, kFirstFlatResult, flat, error);
    if (status != LENSPROF_OK) return status;
    if (options.responses != 1 && options.responses != 3)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "options: responses is %u; give 1 or 3", options.responses);
    const auto change = [&](lensprof_profile &target) {
        put_result(flat, "flat", image_count, target);
        target.responses = options.response ? options.responses : 1;
        lensprof_response_set_linear(&target.response[0]);
        if (options.response) std::copy_n(options.response, target.responses, target.response);
        target.grid = flat.gain_grid;
        target.provenance.pairs = flat.cells;
    };
    return change_given_profile(profile, change, error);
}

}  // extern "C"
