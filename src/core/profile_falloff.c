/* The falloff of a profile and its standard error.
 *
 * M = 1 + k1 r^2 + k2 r^4 + k3 r^6 is linear in k, and nearly so in the centre c: with the gradient
 *     g = (dM/dk1, dM/dk2, dM/dk3, dM/dcx, dM/dcy) = (r^2, r^4, r^6, dM/d(r^2) d(r^2)/dcx, dM/d(r^2) d(r^2)/dcy)
 * and the covariance C of these five, the variance of M is g' C g. */
#include "core/covariance.h"
#include "core/profile.h"

#include <math.h>

uint32_t lp_covariance_modes(const lensprof_response *response, uint32_t responses) {
    uint32_t modes = 0;
    for (uint32_t c = 0; c < responses; c++)
        if (response[c].kind == LENSPROF_RESPONSE_EMOR) modes += response[c].modes;
    return modes;
}

/* g' C g over the `count` parameters at index[]. */
static double form(const double *covariance, uint32_t n, const uint32_t *index, const double *g, uint32_t count) {
    double variance = 0.0;
    int known = 0;
    for (uint32_t i = 0; i < count; i++) {
        known |= covariance[index[i] * n + index[i]] > 0.0;
        for (uint32_t j = 0; j < count; j++) variance += g[i] * g[j] * covariance[index[i] * n + index[j]];
    }
    return known && variance >= 0.0 && isfinite(variance) ? variance : LENSPROF_UNKNOWN;
}

double lp_falloff_variance(const double *covariance, uint32_t n, uint32_t first, double r2) {
    const uint32_t index[3] = {first, first + 1, first + 2};
    const double g[3] = {r2, r2 * r2, r2 * r2 * r2};
    return n < first + 3 ? LENSPROF_UNKNOWN : form(covariance, n, index, g, 3);
}

static uint32_t curve_of(const lensprof_profile *profile, uint32_t channel) {
    return profile->vignettings == 3 ? channel : 0;
}

static void set_sigma(double *sigma, double variance, double scale) {
    if (sigma) *sigma = variance >= 0.0 ? scale * sqrt(variance) : LENSPROF_UNKNOWN;
}

double lp_profile_continued_falloff(const lensprof_profile *profile, uint32_t channel, uint32_t width, uint32_t height,
                                    double x, double y) {
    const lensprof_vignetting *v = &profile->vignetting[curve_of(profile, channel)];
    const double m = lensprof_vignetting_eval(v, lensprof_vignetting_r2(v, width, height, x, y, NULL), NULL);
    return m * lensprof_gain_grid_eval(&profile->grid, width, height, x, y, channel);
}

double lensprof_profile_falloff(const lensprof_profile *profile, uint32_t channel, uint32_t width, uint32_t height,
                                double x, double y, double *sigma) {
    set_sigma(sigma, LENSPROF_UNKNOWN, 1.0);
    if (channel > 2) return 0.0;
    const lensprof_image_circle circle = lp_profile_circle(profile);
    if (!lensprof_image_circle_contains(&circle, width, height, x, y)) return 1.0;
    if (!sigma) /* maps evaluate this for every pixel */
        return lp_profile_continued_falloff(profile, channel, width, height, x, y);
    const lensprof_vignetting *v = &profile->vignetting[curve_of(profile, channel)];
    double by_r2, by_center[2];
    const double r2 = lensprof_vignetting_r2(v, width, height, x, y, by_center);
    const double m = lensprof_vignetting_eval(v, r2, &by_r2);
    const double grid = lensprof_gain_grid_eval(&profile->grid, width, height, x, y, channel);
    const uint32_t n = profile->covariance_size, modes = lp_covariance_modes(profile->response, profile->responses);
    const uint32_t first = lp_covariance_index(modes, curve_of(profile, channel));
    const uint32_t center = lp_covariance_index(modes, profile->vignettings);
    const uint32_t index[5] = {first, first + 1, first + 2, center, center + 1};
    const double g[5] = {r2, r2 * r2, r2 * r2 * r2, by_r2 * by_center[0], by_r2 * by_center[1]};
    if (n >= first + 3) set_sigma(sigma, form(profile->covariance, n, index, g, n >= center + 2 ? 5 : 3), grid);
    return m * grid;
}

double lensprof_profile_radial_falloff(const lensprof_profile *profile, uint32_t channel, double r, double *sigma) {
    set_sigma(sigma, LENSPROF_UNKNOWN, 1.0);
    if (channel > 2) return 0.0;
    const uint32_t curve = curve_of(profile, channel);
    const uint32_t modes = lp_covariance_modes(profile->response, profile->responses);
    const uint32_t first = lp_covariance_index(modes, curve);
    set_sigma(sigma, lp_falloff_variance(profile->covariance, profile->covariance_size, first, r * r), 1.0);
    return lensprof_vignetting_eval(&profile->vignetting[curve], r * r, NULL);
}
