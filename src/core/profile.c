/* Profiles as values: defaults and validation. */
#include "core/profile.h"

#include <math.h>
#include <string.h>

_Static_assert(sizeof(lensprof_profile_key) == 512 && sizeof(lensprof_provenance) == 768
                   && sizeof(lensprof_camera_model) == 1024,
               "fixed for ever");

void lensprof_profile_key_init(lensprof_profile_key *key) {
    memset(key, 0, sizeof *key);
    key->crop_factor = key->focal_mm = key->aperture = key->distance_m = key->color_temperature_k = LENSPROF_UNKNOWN;
    key->processing = LENSPROF_PROCESSING_JPEG;
}

/* Terminated, and without control characters. */
static int is_text(const char *text, size_t capacity) {
    for (size_t i = 0; i < capacity; i++) {
        unsigned char c = (unsigned char)text[i];
        if (c == 0) return 1;
        if (lp_is_control(c)) return 0;
    }
    return 0;
}

static int is_known_or_unknown(double value, double largest) {
    return value == LENSPROF_UNKNOWN || (value > 0.0 && value <= largest);
}

int lp_is_setting(double focal_mm, double aperture, double distance_m) {
    return is_known_or_unknown(focal_mm, 1e5) && is_known_or_unknown(aperture, 1e4)
           && is_known_or_unknown(distance_m, INFINITY);
}

int lp_are_key_numbers(const lensprof_profile_key *key) {
    return is_known_or_unknown(key->crop_factor, 1e4) && lp_is_setting(key->focal_mm, key->aperture, key->distance_m)
           && is_known_or_unknown(key->color_temperature_k, 1e6);
}

/* Room for future members: any other value comes from a newer lensprof. */
static int is_empty(const uint32_t *reserved, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (reserved[i]) return 0;
    return 1;
}

lensprof_status lensprof_profile_key_validate(const lensprof_profile_key *key) {
    if (!key || key->processing > LENSPROF_PROCESSING_CORRECTED
        || !is_empty(key->reserved, sizeof key->reserved / sizeof *key->reserved))
        return LENSPROF_ERROR_ARGUMENT;
    if (!is_text(key->camera_maker, sizeof key->camera_maker) || !is_text(key->camera_model, sizeof key->camera_model)
        || !is_text(key->lens, sizeof key->lens) || !is_text(key->unit, sizeof key->unit)
        || !is_text(key->style, sizeof key->style))
        return LENSPROF_ERROR_ARGUMENT;
    return lp_are_key_numbers(key) ? LENSPROF_OK : LENSPROF_ERROR_ARGUMENT;
}

void lensprof_camera_model_init(lensprof_camera_model *camera) {
    memset(camera, 0, sizeof *camera);
    camera->crop_factor = LENSPROF_UNKNOWN;
}

lensprof_status lp_camera_model_validate(const lensprof_camera_model *camera) {
    if (!camera || camera->fixed_lens > 1 || !is_known_or_unknown(camera->crop_factor, 1e4)
        || !is_empty(camera->reserved, sizeof camera->reserved / sizeof *camera->reserved))
        return LENSPROF_ERROR_ARGUMENT;
    const char *const texts[] = {camera->maker,       camera->model,   camera->other_maker,
                                 camera->other_model, camera->variant, camera->mount};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        if (!is_text(texts[i], sizeof camera->maker)) return LENSPROF_ERROR_ARGUMENT;
    const char *model = camera->model;
    while (*model == ' ') model++;
    return *model && is_text(camera->lens, sizeof camera->lens) && is_text(camera->source, sizeof camera->source)
               ? LENSPROF_OK
               : LENSPROF_ERROR_ARGUMENT;
}

void lensprof_profile_init_sized(lensprof_profile *profile, size_t size) {
    if (!lp_sized_begin(profile, size, LP_FIRST_PROFILE)) return;
    lensprof_profile_key_init(&profile->key);
    profile->provenance.heldout_rms = profile->provenance.inlier_share = LENSPROF_UNKNOWN;
    profile->responses = profile->vignettings = 1;
    lensprof_gain_grid_init(&profile->grid);
    lensprof_response_set_linear(&profile->response[0]); /* once: a copy takes a tenth of the time */
    profile->response[1] = profile->response[2] = profile->response[0];
}

int lp_provenance_doubts_response(const lensprof_provenance *provenance) {
    static const char doubt[] = LENSPROF_DOUBT_RESPONSE;
    for (size_t i = 0; i < sizeof doubt; i++)
        if (provenance->doubt[i] != doubt[i]) return 0;
    return 1;
}

lensprof_status lensprof_profile_copy(lensprof_profile *to, const lensprof_profile *from) {
    if (!to || !from) return LENSPROF_ERROR_ARGUMENT;
    if (to == from) return LENSPROF_OK;
    if (lp_sized_wrong(to, LP_FIRST_PROFILE, sizeof *to) || lp_sized_wrong(from, LP_FIRST_PROFILE, sizeof *from))
        return LENSPROF_ERROR_STRUCT_SIZE;
    if (to->struct_size > from->struct_size) lensprof_profile_init_sized(to, to->struct_size);
    lp_sized_copy(to, from);
    return LENSPROF_OK;
}

int lp_is_quality(double heldout_rms, double inlier_share) {
    return (heldout_rms == LENSPROF_UNKNOWN || (heldout_rms >= 0.0 && heldout_rms <= 255.0))
           && (inlier_share == LENSPROF_UNKNOWN || (inlier_share >= 0.0 && inlier_share <= 1.0));
}

static lensprof_status validate_provenance(const lensprof_provenance *p) {
    if (!is_text(p->method, sizeof p->method) || !is_text(p->software, sizeof p->software)
        || !is_text(p->source, sizeof p->source) || !is_text(p->doubt, sizeof p->doubt))
        return LENSPROF_ERROR_ARGUMENT;
    if (!is_empty(p->reserved, sizeof p->reserved / sizeof *p->reserved) || p->prior_id < 0 || p->forced > 1
        || p->not_usable > 1 || !(p->gamma_sigma >= 0.0) || !isfinite(p->gamma_sigma))
        return LENSPROF_ERROR_ARGUMENT;
    return lp_is_quality(p->heldout_rms, p->inlier_share) ? LENSPROF_OK : LENSPROF_ERROR_ARGUMENT;
}

static lensprof_status validate_covariance(const double *covariance, uint32_t n) {
    if (n > LENSPROF_COVARIANCE_MAX) return LENSPROF_ERROR_SIZE;
    for (uint32_t i = 0; i < n; i++) {
        if (!(covariance[i * n + i] >= 0.0)) return LENSPROF_ERROR_ARGUMENT;
        for (uint32_t j = 0; j < n; j++) {
            if (!isfinite(covariance[i * n + j])) return LENSPROF_ERROR_NOT_FINITE;
            if (covariance[i * n + j] != covariance[j * n + i]) return LENSPROF_ERROR_ARGUMENT;
        }
    }
    return LENSPROF_OK;
}

/* All channels use one lens: one centre. */
static lensprof_status validate_falloff(const lensprof_vignetting *vignetting, const lensprof_vignetting *first) {
    lensprof_status status = lensprof_vignetting_validate(vignetting);
    if (status != LENSPROF_OK) return status;
    int same = vignetting->center[0] == first->center[0] && vignetting->center[1] == first->center[1];
    return same ? LENSPROF_OK : LENSPROF_ERROR_VIGNETTING;
}

lensprof_status lensprof_profile_validate(const lensprof_profile *profile) {
    if (!profile) return LENSPROF_ERROR_ARGUMENT;
    if (lp_sized_wrong(profile, LP_FIRST_PROFILE, sizeof *profile)) return LENSPROF_ERROR_STRUCT_SIZE;
    if ((profile->responses != 1 && profile->responses != 3)
        || (profile->vignettings != 1 && profile->vignettings != 3))
        return LENSPROF_ERROR_ARGUMENT;
    lensprof_status status = lensprof_profile_key_validate(&profile->key);
    if (status == LENSPROF_OK) status = validate_provenance(&profile->provenance);
    for (uint32_t c = 0; c < profile->responses && status == LENSPROF_OK; c++)
        status = lensprof_response_validate(&profile->response[c]);
    for (uint32_t c = 0; c < profile->vignettings && status == LENSPROF_OK; c++)
        status = validate_falloff(&profile->vignetting[c], &profile->vignetting[0]);
    if (status == LENSPROF_OK) status = lensprof_gain_grid_validate(&profile->grid);
    if (status == LENSPROF_OK) status = validate_covariance(profile->covariance, profile->covariance_size);
    if (status != LENSPROF_OK) return status;
    const lensprof_levels levels = lp_profile_levels(profile);
    const lensprof_image_circle circle = lp_profile_circle(profile);
    status = lensprof_levels_validate(&levels);
    return status == LENSPROF_OK ? lensprof_image_circle_validate(&circle) : status;
}
