// The C interface of the fit of fields: argument checks, and conversion of exceptions to status codes.
#include <cmath>
#include <cstdio>
#include <memory>

#include "fit/api/boundary.hpp"
#include "fit/api/held.hpp"
#include "fit/api/profile.hpp"
#include "fit/base/sized.hpp"
#include "fit/fields/heldout.hpp"
#include "fit/fields/rules.hpp"

using namespace lensprof;

struct lensprof_fields {
    FieldsFit fit;
};

namespace {

constexpr size_t kFirstFieldsOptions = LP_END_OF(lensprof_fields_options, progress_user);
constexpr uint32_t kLargestFrame = 1u << 20;  // px

lensprof_status null_fields(lensprof_error *error) {
    return fail(LENSPROF_ERROR_ARGUMENT, error, "fields: a pointer is NULL");
}

// The first option that is out of range, with its range; NULL if all are valid.
const char *broken_fields_option(const lensprof_fields_options &o) {
    const auto is_offset = [&](double offset) { return std::abs(offset) < 1e12; };
    const Rule rules[] = {
        {o.channels == 1 || o.channels == 3, "channels must be 1 or 3"},
        {o.given_offset <= 1, "given_offset must be 0 or 1"},
        {is_offset(o.offset[0]) && is_offset(o.offset[1]) && is_offset(o.offset[2]), "offset must be finite"},
        {o.white >= 0.0 && o.white < 1e12, "white must be 0 or positive"},
        {o.responses == 1 || o.responses == 3, "responses must be 1 or 3"},
        {!o.reserved, "reserved must be 0"},
    };
    return first_broken(rules);
}

lensprof_status check_fields_options(const lensprof_fields_options &o, lensprof_error *error) {
    if (const char *wrong = broken_fields_option(o))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fields options: %s", wrong);
    const auto is_side = [](uint32_t side) { return side >= 2 && side <= kLargestFrame; };
    if (!is_side(o.width) || !is_side(o.height))
        return fail(LENSPROF_ERROR_SIZE, error, "fields options: a frame of %u x %u; its sides must be 2..%u px",
                    o.width, o.height, kLargestFrame);
    lensprof_status status = LENSPROF_OK;
    for (uint32_t c = 0; o.response && c < o.responses && status == LENSPROF_OK; c++)
        status = lensprof_response_validate(&o.response[c]);
    return status == LENSPROF_OK ? status
                                 : fail(status, error, "fields options: a response is not monotone from 0 to 1");
}

// A view in the form that the sampler reads.
struct GivenView {
    const lensprof_image *view;
    const uint8_t *mask;
    ptrdiff_t mask_row_bytes;
};

lensprof_status take_view(const FieldsFit &fit, const GivenView &given, lensprof_sample_image &image,
                          lensprof_error *error) {
    const auto index = static_cast<uint32_t>(fit.pictures.size());
    if (index >= LENSPROF_FIELDS_IMAGES)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fields: more than %d pictures", LENSPROF_FIELDS_IMAGES);
    const uint32_t width = fit.grid.width, height = fit.grid.height;
    image = {};
    image.view = *given.view, image.mask = given.mask, image.mask_row_bytes = given.mask_row_bytes;
    image.camera.width = width, image.camera.height = height;
    image.reduction = given.view->width ? width / given.view->width : 0;
    image.white = 1.0;
    const lensprof_status status = check_view(image, index, error);
    if (status != LENSPROF_OK) return status;
    if (given.view->height != height / image.reduction || given.view->width != width / image.reduction)
        return fail_at(LENSPROF_ITEM_IMAGE, index, LENSPROF_ERROR_SIZE, error,
                       "a view of %u x %u is not a frame of %u x %u, reduced by one number", given.view->width,
                       given.view->height, width, height);
    if (fit.options.channels == 3 && lensprof_layout_channels(given.view->layout) != 3)
        return fail_at(LENSPROF_ITEM_IMAGE, index, LENSPROF_ERROR_ARGUMENT, error, "a grey picture; set channels to 1");
    const bool is_float = given.view->sample == LENSPROF_SAMPLE_F32;
    image.white = fit.options.white > 0.0 ? fit.options.white : is_float ? INFINITY : 1.0;
    return LENSPROF_OK;
}

// Makes the means of cells linear.
void invert_cells(const FieldsFit &fit, FieldCells &cells) {
    if (!fit.options.response) return;
    for (uint32_t c = 0; c < fit.options.channels; c++) {
        const lensprof_response &response = fit.response[fit.options.responses == 3 ? c : 0];
        for (float &value : cells.value[c])
            if (!std::isnan(value))
                value = static_cast<float>(lensprof_response_invert(&response, static_cast<double>(value), nullptr));
    }
}

lensprof_status check_fitted(const lensprof_fields *fields, const void *result, lensprof_error *error) {
    clear(error);
    if (!fields || !result) return null_fields(error);
    if (!fields->fit.is_fitted)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fields: nothing was fitted; call lensprof_fields_fit first");
    return LENSPROF_OK;
}

lensprof_status out_of_range(const char *part, uint32_t index, size_t count, lensprof_error *error) {
    return fail(LENSPROF_ERROR_ARGUMENT, error, "fields: it has no %s %u, but %zu, counted from 0", part, index, count);
}

// The offsets, if the pictures are linear and their samples lie within 0..1.
lensprof_levels levels_of(const FieldsFit &fit) {
    lensprof_levels levels{};
    for (uint32_t c = 0; c < 3; c++) levels.black[c] = fit.result.channel[fit.result.channels == 3 ? c : 0].offset;
    return is_linear(fit) && lensprof_levels_validate(&levels) == LENSPROF_OK ? levels : lensprof_levels{};
}

void put_fields(const FieldsFit &fit, lensprof_profile &profile) {
    profile.responses = fit.options.response ? fit.options.responses : 1;
    for (lensprof_response &response : profile.response) lensprof_response_set_linear(&response);
    if (fit.options.response) std::copy_n(fit.response.begin(), profile.responses, profile.response);
    profile.vignettings = 1;
    for (lensprof_vignetting &vignetting : profile.vignetting) vignetting = {};
    profile.covariance_size = 0;
    std::fill(std::begin(profile.covariance), std::end(profile.covariance), 0.0);
    profile.grid = fit.result.shading;
    profile.levels = levels_of(fit);
    lensprof_provenance &p = profile.provenance;
    std::snprintf(p.method, sizeof p.method, "fields");
    std::snprintf(p.software, sizeof p.software, "lensprof %s", lensprof_version());
    p.images = fit.result.used, p.pairs = fit.result.used * fit.result.columns * fit.result.rows;
    p.heldout_rms = LENSPROF_UNKNOWN, p.inlier_share = LENSPROF_UNKNOWN;
    p.not_usable = !fit.result.usable;
}

}  // namespace

extern "C" {

void lensprof_fields_options_init_sized(lensprof_fields_options *options, size_t size) {
    if (!lp_sized_begin(options, size, kFirstFieldsOptions)) return;
    options->channels = 3;
    options->responses = 1;
}

lensprof_status lensprof_fields_create(const lensprof_fields_options *options, lensprof_fields **fields,
                                       lensprof_error *error) {
    return at_boundary("fields", error, [&] {
        clear(error);
        if (!options || !fields) return null_fields(error);
        auto made = std::make_unique<lensprof_fields>();
        FieldsFit &fit = made->fit;
        lensprof_fields_options_init(&fit.options);
        if (const char *wrong = lp_sized_take(&fit.options, options, kFirstFieldsOptions))
            return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "fields options: %s", wrong);
        const lensprof_status status = check_fields_options(fit.options, error);
        if (status != LENSPROF_OK) return status;
        if (fit.options.response) std::copy_n(fit.options.response, fit.options.responses, fit.response.begin());
        if (fit.options.response) fit.options.response = fit.response.data();
        fit.grid = make_field_grid(fit.options.width, fit.options.height);
        *fields = made.release();
        return LENSPROF_OK;
    });
}

void lensprof_fields_destroy(lensprof_fields *fields) { delete fields; }

lensprof_status lensprof_fields_add(lensprof_fields *fields, const lensprof_image *view, const uint8_t *mask,
                                    ptrdiff_t mask_row_bytes, lensprof_error *error) {
    return at_boundary("fields", error, [&] {
        clear(error);
        if (!fields || !view) return null_fields(error);
        FieldsFit &fit = fields->fit;
        lensprof_sample_image image;
        const lensprof_status status = take_view(fit, {view, mask, mask_row_bytes}, image, error);
        if (status != LENSPROF_OK) return status;
        FieldPicture picture;
        picture.cells = measure_field(fit.grid, image, static_cast<int>(fit.options.channels));
        invert_cells(fit, picture.cells);
        picture.same_as = static_cast<uint32_t>(fit.pictures.size());
        fit.pictures.push_back(std::move(picture));
        return LENSPROF_OK;
    });
}

lensprof_status lensprof_fields_fit(lensprof_fields *fields, lensprof_error *error) {
    return at_boundary("fields", error, [&] {
        clear(error);
        if (!fields) return null_fields(error);
        if (!fit_fields(fields->fit))
            return fail(
                LENSPROF_ERROR_NO_SAMPLES, error,
                "fields: none of the %zu pictures shows light above its offset that is not saturated; check shutter, "
                "exposure and mask, or state the offset of pictures whose light is even",
                fields->fit.pictures.size());
        return LENSPROF_OK;
    });
}

lensprof_status lensprof_fields_get(const lensprof_fields *fields, lensprof_fields_result *result,
                                    lensprof_error *error) {
    const lensprof_status status = check_fitted(fields, result, error);
    return status == LENSPROF_OK
               ? give(fields->fit.result, result, LP_END_OF(lensprof_fields_result, shading), "fields", error)
               : status;
}

lensprof_status lensprof_fields_image_at(const lensprof_fields *fields, uint32_t index, lensprof_fields_image *image,
                                         lensprof_error *error) {
    const lensprof_status status = check_fitted(fields, image, error);
    if (status != LENSPROF_OK) return status;
    const auto &pictures = fields->fit.pictures;
    if (index >= pictures.size()) return out_of_range("picture", index, pictures.size(), error);
    lensprof_fields_image found;
    lensprof_fields_image_init(&found);
    const FieldPicture &picture = pictures[index];
    found.used = picture.used, found.same_as = picture.same_as;
    std::copy(picture.level.begin(), picture.level.end(), found.level);
    found.white_share = picture.cells.white_share, found.pixel_share = picture.cells.pixel_share;
    return give(found, image, LP_END_OF(lensprof_fields_image, pixel_share), "fields", error);
}

lensprof_status lensprof_fields_smoothness_at(const lensprof_fields *fields, uint32_t channel, uint32_t index,
                                              lensprof_fields_smoothness *smoothness, lensprof_error *error) {
    const lensprof_status status = check_fitted(fields, smoothness, error);
    if (status != LENSPROF_OK) return status;
    if (channel >= fields->fit.result.channels)
        return out_of_range("channel", channel, fields->fit.result.channels, error);
    if (index >= kSmoothnesses) return out_of_range("smoothness", index, kSmoothnesses, error);
    const Smoothness tried = smoothness_at(index);
    *smoothness = {static_cast<uint32_t>(tried.order), 0, tried.weight, fields->fit.heldout[channel][index]};
    return LENSPROF_OK;
}

lensprof_status lensprof_fields_finding_at(const lensprof_fields *fields, uint32_t index, lensprof_finding *finding,
                                           lensprof_error *error) {
    const lensprof_status status = check_fitted(fields, finding, error);
    const FieldsFit *const fit = fields ? &fields->fit : nullptr;
    return status == LENSPROF_OK ? give_finding(fit->verdict.data(), fit->result, index, finding, "fields", error)
                                 : status;
}

lensprof_status lensprof_fields_profile(const lensprof_fields *fields, lensprof_profile *profile,
                                        lensprof_error *error) {
    const lensprof_status status = check_fitted(fields, profile, error);
    if (status != LENSPROF_OK) return status;
    return change_given_profile(
        profile, [&](lensprof_profile &target) { put_fields(fields->fit, target); }, error);
}

}  // extern "C"
