/* Profiles of all versions, and the checks of their parts by lensprof_profile_validate, for use with blobs. */
#ifndef LENSPROF_CORE_PROFILE_H
#define LENSPROF_CORE_PROFILE_H

#include <lensprof/profile.h>

#include "core/sized.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Profiles are large, so they are read in the caller's memory, whatever their version. Members after this one may be
 * missing; read them through a function here, which knows their default. */
#define LP_FIRST_PROFILE LP_END_OF(lensprof_profile, covariance)

/* The levels of a profile; none if it has no such member. */
static inline lensprof_levels lp_profile_levels(const lensprof_profile *profile) {
    lensprof_levels levels = {{0.0, 0.0, 0.0}, 0.0};
    if (profile->struct_size >= LP_END_OF(lensprof_profile, levels)) levels = profile->levels;
    return levels;
}

/* The image circle of a profile; none if it has no such member. */
static inline lensprof_image_circle lp_profile_circle(const lensprof_profile *profile) {
    lensprof_image_circle circle = {{0.0, 0.0}, 0.0};
    if (profile->struct_size >= LP_END_OF(lensprof_profile, image_circle)) circle = profile->image_circle;
    return circle;
}

/* lensprof_profile_falloff in channel 0, 1 or 2, continued outside of the image circle: for what does not hold a
 * circle. */
double lp_profile_continued_falloff(const lensprof_profile *profile, uint32_t channel, uint32_t width, uint32_t height,
                                    double x, double y);

/* Whether the doubt of a provenance concerns the response alone (LENSPROF_DOUBT_RESPONSE). */
int lp_provenance_doubts_response(const lensprof_provenance *provenance);

/* LENSPROF_OK if it has a model, the texts are terminated and free of control characters and the numbers are in range.
 */
lensprof_status lp_camera_model_validate(const lensprof_camera_model *camera);

/* No text of a profile may contain a control character, which would break listings. */
static inline int lp_is_control(unsigned char c) { return c < 0x20 || c == 0x7f; }

/* A key's focal length, aperture and distance: each in its range, or LENSPROF_UNKNOWN. */
int lp_is_setting(double focal_mm, double aperture, double distance_m);

/* Whether all numbers of a key are valid: lensprof_profile_key_validate without the texts. */
int lp_are_key_numbers(const lensprof_profile_key *key);

/* A provenance's figures: each in its range, or LENSPROF_UNKNOWN. */
int lp_is_quality(double heldout_rms, double inlier_share);

#ifdef __cplusplus
}
#endif
#endif
