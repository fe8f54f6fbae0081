// The C interface of the flat field fit: argument checks, and conversion of exceptions to status codes.
#include <cmath>
#include <memory>
#include <new>

#include "fit/api/boundary.hpp"
#include "fit/api/held.hpp"
#include "fit/api/profile.hpp"
#include "fit/base/sized.hpp"
#include "fit/flat/rules.hpp"

using namespace lensprof;

struct lensprof_flat {
    uint32_t mark;  // kHeldFlat until the fit is released
    uint32_t is_own_memory, responses, reserved;
    lensprof_flat_result *result;
    lensprof_finding *findings;   // lensprof::kFlatRuleCount
    lensprof_response *response;  // 3, of which `responses` are used
    lensprof_flat_image_quality *quality;
};

namespace {

constexpr uint32_t kLensFlags = LENSPROF_FREE_FALLOFF | LENSPROF_FREE_CENTER;
constexpr double kLargestRotation = 360.0;
constexpr size_t kFirstFlatOptions = LP_END_OF(lensprof_flat_options, progress_user);
constexpr size_t kFirstFlatImage = LP_END_OF(lensprof_flat_image, rotation_deg);
constexpr uint32_t kHeldFlat = 0x4c504643u;

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
        {lensprof_levels_validate(&o.levels) == LENSPROF_OK, "levels must have black below white"},
        {o.black_sigma >= 0.0 && o.black_sigma <= 0.2, "black_sigma must be 0..0.2"},
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
    if (!(std::abs(image.rotation_deg) <= kLargestRotation))
        return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error, "rotated by more than 360 degrees");
    for (uint32_t j = 0; j < i; j++)
        if (images[j].shot == image.shot && images[j].rotation_deg != image.rotation_deg)
            return fail_at(LENSPROF_ITEM_IMAGE, i, LENSPROF_ERROR_ARGUMENT, error,
                           "in the same shot as image %u, but rotated differently", j);
    return LENSPROF_OK;
}

// All arguments and results of the call, in this library's struct versions.
struct Call {
    lensprof_flat_options options;
    std::vector<lensprof_flat_image> images;
    FlatResult result;
    std::vector<lensprof_flat_image_quality> quality;
};

lensprof_status take_call(const lensprof_flat_options *options, const lensprof_flat_image *images, uint32_t count,
                          Call &call, lensprof_error *error) {
    lensprof_flat_options_init(&call.options);
    if (const char *wrong = lp_sized_take(&call.options, options, kFirstFlatOptions))
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "flat options: %s", wrong);
    lensprof_status status = check_options(call.options, count, error);
    auto init = [](lensprof_flat_image &image, uint32_t) { lensprof_flat_image_init(&image); };
    if (status == LENSPROF_OK)
        status = take_all(images, count, kFirstFlatImage, LENSPROF_ITEM_IMAGE, init, call.images, error);
    for (uint32_t i = 0; i < count && status == LENSPROF_OK; i++)
        status = check_image(call.options, call.images.data(), i, error);
    lensprof_flat_result_init(&call.result);
    if (status == LENSPROF_OK) call.quality.resize(count);
    call.result.image_quality = call.quality.data();
    call.result.images = count;
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

// The fit of a finished call in memory[lensprof_flat_bytes].
lensprof_flat *make_flat(const Call &call, void *memory, bool is_own) {
    auto *block = static_cast<char *>(memory);
    lensprof_flat &flat = *take_block<lensprof_flat>(block, 1);
    flat = {};
    flat.is_own_memory = is_own;
    flat.result = take_block<lensprof_flat_result>(block, 1);
    flat.findings = take_block<lensprof_finding>(block, kFlatRuleCount);
    flat.response = take_block<lensprof_response>(block, 3);
    flat.quality = take_block<lensprof_flat_image_quality>(block, call.quality.size());
    *flat.result = call.result;
    hold_findings(call.result.verdict, kFlatRuleCount, flat.findings, *flat.result);
    flat.responses = call.options.response ? call.options.responses : 1;
    lensprof_response_set_linear(&flat.response[0]);
    if (call.options.response) std::copy_n(call.options.response, flat.responses, flat.response);
    std::copy(call.quality.begin(), call.quality.end(), flat.quality);
    for (size_t i = 0; i < call.quality.size(); i++) flat.quality[i].struct_size = sizeof flat.quality[i];
    flat.mark = kHeldFlat;
    return &flat;
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

size_t lensprof_flat_bytes(uint32_t image_count) {
    if (image_count == 0 || image_count > LENSPROF_FLAT_IMAGES) return 0;
    return sizeof(lensprof_flat) + sizeof(lensprof_flat_result) + kFlatRuleCount * sizeof(lensprof_finding)
           + 3 * sizeof(lensprof_response) + image_count * sizeof(lensprof_flat_image_quality);
}

lensprof_status lensprof_fit_flat(const lensprof_flat_options *options, const lensprof_flat_image *images,
                                  uint32_t image_count, void *memory, size_t size, lensprof_flat **flat,
                                  lensprof_error *error) {
    clear(error);
    if (!options || !images || !flat) return fail(LENSPROF_ERROR_ARGUMENT, error, "flat: a pointer is NULL");
    return at_boundary("flat", error, [&] {
        const auto call = std::make_unique<Call>();
        lensprof_status status = take_call(options, images, image_count, *call, error);
        const size_t bytes = lensprof_flat_bytes(image_count);
        if (status == LENSPROF_OK) status = check_place({memory, size}, bytes, "flat", error);
        if (status == LENSPROF_OK) status = run(*call, error);
        if (status == LENSPROF_OK) *flat = make_flat(*call, memory ? memory : ::operator new(bytes), !memory);
        return status;
    });
}

void lensprof_flat_destroy(lensprof_flat *flat) {
    if (!flat || flat->mark != kHeldFlat) return;
    flat->mark = 0;
    if (flat->is_own_memory) ::operator delete(flat);
}

lensprof_status lensprof_flat_get(const lensprof_flat *flat, lensprof_flat_result *result, lensprof_error *error) {
    const lensprof_status status = check_held(flat, result, kHeldFlat, "flat", error);
    return status == LENSPROF_OK
               ? give(*flat->result, result, LP_END_OF(lensprof_flat_result, gain_grid), "flat", error)
               : status;
}

lensprof_status lensprof_flat_image_at(const lensprof_flat *flat, uint32_t index, lensprof_flat_image_quality *quality,
                                       lensprof_error *error) {
    const uint32_t count = flat && flat->mark == kHeldFlat ? flat->result->images : 0;
    const lensprof_status status = check_part(flat, quality, kHeldFlat, "flat", index, count, "image", error);
    return status == LENSPROF_OK
               ? give(flat->quality[index], quality, LP_END_OF(lensprof_flat_image_quality, card), "flat", error)
               : status;
}

lensprof_status lensprof_flat_finding_at(const lensprof_flat *flat, uint32_t index, lensprof_finding *finding,
                                         lensprof_error *error) {
    const lensprof_status status = check_held(flat, finding, kHeldFlat, "flat", error);
    return status == LENSPROF_OK ? give_finding(flat->findings, *flat->result, index, finding, "flat", error) : status;
}

lensprof_status lensprof_flat_profile(const lensprof_flat *flat, lensprof_profile *profile, lensprof_error *error) {
    const lensprof_status status = check_held(flat, profile, kHeldFlat, "flat", error);
    if (status != LENSPROF_OK) return status;
    const auto change = [&](lensprof_profile &target) {
        put_result(*flat->result, "flat", flat->result->images, target);
        target.responses = flat->responses;
        std::copy_n(flat->response, flat->responses, target.response);
        target.grid = flat->result->gain_grid;
        target.levels = flat->result->levels;
        target.image_circle = flat->result->image_circle;
        target.provenance.pairs = flat->result->cells;
    };
    return change_given_profile(profile, change, error);
}

}  // extern "C"
