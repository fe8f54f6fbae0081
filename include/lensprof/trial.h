/* lensprof/trial.h - which of several profiles fits given pictures.
 *
 * Example: whether a profile suits three overlapping pictures, compared with their falloff left as it is.
 *
 *     static lensprof_pair pairs[2000];
 *     const lensprof_profile *const profiles[] = {&profile};
 *     lensprof_sample_image samples[3]; lensprof_fit_image fitted[3]; lensprof_sample_options sampling; uint32_t count;
 *     lensprof_trial_result result; lensprof_trial_candidate candidates[2];
 *     lensprof_sample_options_init(&sampling), lensprof_trial_result_init(&result);
 *     for (uint32_t i = 0; i < 2; i++) lensprof_trial_candidate_init(&candidates[i]);
 *     for (uint32_t i = 0; i < 3; i++) {
 *         lensprof_sample_image_init(&samples[i]), samples[i].view = images[i], samples[i].camera = cameras[i];
 *         lensprof_fit_image_init(&fitted[i], i, images[i].width, images[i].height);
 *     }
 *     status = lensprof_sample_overlap(&sampling, samples, 3, pairs, 2000, &count, &error);
 *     if (status == LENSPROF_OK)
 *         status = lensprof_trial_run(NULL, fitted, 3, pairs, count, profiles, 1, candidates, &result, &error);
 *     if (status == LENSPROF_OK && result.usable) printf("RMS %.2f levels\n", candidates[result.best].heldout_rms);
 *
 * Response and falloff of each candidate are fixed. Exposures and white balances are fitted to one half of the pairs,
 * robustly: nearly half of them may be wrong if the others agree. The residual of grey value transfer (fit.h) is
 * measured on the other half, except for pairs that no candidate explains, which show two different objects.
 *
 * All pairs show by how much the corners are still too dark or too bright with each candidate: exposures and
 * white balances per pair of images and the remaining falloff are fitted, the latter linear in r^2 between the ends of
 * rings, with the shape of the response as far as it is uncertain. The exponent gamma, by which response and falloff
 * change together, is that of the profile if the response is its own: the remaining falloff is in EV of its scale, the
 * one in which it is applied. With another response gamma has the error of that response; known_ev of the images
 * reduces it.
 *
 * Threads: calls are independent. Same input, same bytes.
 */
#ifndef LENSPROF_TRIAL_H
#define LENSPROF_TRIAL_H

#include "fit.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_TRIAL_PAIRS 30 /* to be measured, at least: about half of the pairs given */

#define LENSPROF_TRIAL_RINGS 5 /* of the frame: r from its middle up to 0.25, 0.5, 0.7, 0.85 and 1 half diagonals */

/* Origin of the response of a candidate. */
typedef enum lensprof_trial_response {
    LENSPROF_TRIAL_RESPONSE_OWN = 0,   /* the profile itself */
    LENSPROF_TRIAL_RESPONSE_OTHER = 1, /* another of the profiles, whose response fits best */
    LENSPROF_TRIAL_RESPONSE_KIND = 2,  /* the typical response of the kind of camera, which fits best */
    LENSPROF_TRIAL_RESPONSE_LINEAR = 3 /* the pictures are sensor data */
} lensprof_trial_response;

/* The outermost ring that the pictures show, corrected with a candidate. It is too dark or too bright beyond two
 * standard errors and 0.03 EV. */
typedef enum lensprof_trial_corners {
    LENSPROF_TRIAL_CORNERS_NOT_SHOWN =
        0,                            /* no pair reaches them, or a standard error above 0.1 EV hides the difference */
    LENSPROF_TRIAL_CORNERS_AGREE = 1, /* as bright as the middle within the error */
    LENSPROF_TRIAL_CORNERS_TOO_DARK = 2,  /* undercorrected */
    LENSPROF_TRIAL_CORNERS_TOO_BRIGHT = 3 /* overcorrected */
} lensprof_trial_corners;

typedef struct lensprof_trial_options {
    uint32_t struct_size;
    uint32_t channels;    /* 1 or 3 */
    uint32_t camera_kind; /* lensprof_camera_kind of the pictures. LINEAR: all candidates have a linear response */
    uint32_t reserved;    /* 0 */
} lensprof_trial_options;

/* 3 channels, any camera. */
LENSPROF_API void lensprof_trial_options_init_sized(lensprof_trial_options *options, size_t size);
static inline void lensprof_trial_options_init(lensprof_trial_options *options) {
    lensprof_trial_options_init_sized(options, sizeof *options);
}

/* A profile, or the last: exposures and white balances alone, without falloff. Levels are of 255. Differences of RMS
 * have standard errors from the scatter of pairs and of image pairs, the larger one; they are clear beyond two. */
typedef struct lensprof_trial_candidate {
    uint32_t struct_size;
    uint32_t has_falloff;      /* 1: a polynomial or a gain grid */
    uint32_t response_from;    /* lensprof_trial_response: a raw profile has no response for rendered pictures */
    uint32_t response_profile; /* OTHER: its index */
    uint32_t as_good_as_best;  /* 1: not clearly above the best profile */
    uint32_t
        better_than_none; /* 1: clearly below exposures and white balances alone, or clearly flatter by the rings */
    double heldout_rms, heldout_median;   /* residual and absolute residual of the measured pairs, levels */
    double above_best, above_best_sigma;  /* RMS above that of the best profile, levels, and its standard error */
    double below_none, below_none_sigma;  /* RMS below that of exposures and white balances alone, the same */
    uint32_t corners;                     /* lensprof_trial_corners */
    uint32_t rings;                       /* from the middle on, that the pictures show; 0: none */
    double ring_ev[LENSPROF_TRIAL_RINGS]; /* remaining falloff: mean brightness of each ring above that of the first,
                                             EV; positive: too bright, overcorrected. 0 beyond the rings shown */
    double ring_sigma_ev[LENSPROF_TRIAL_RINGS]; /* its standard error, EV */
} lensprof_trial_candidate;

/* No falloff, nothing measured. */
static inline void lensprof_trial_candidate_init(lensprof_trial_candidate *candidate) {
    lensprof_init_sized(candidate, sizeof *candidate);
}

typedef struct lensprof_trial_result {
    uint32_t struct_size;
    uint32_t usable;                       /* 1: a profile is better than none */
    uint32_t best;                         /* index of the profile with the smallest RMS */
    uint32_t decided;                      /* 1: usable, and all other profiles are clearly worse than the best */
    uint32_t images;                       /* with pairs */
    uint32_t fitted;                       /* pairs of the first half */
    uint32_t measured, unexplained;        /* pairs of the other half: measured, and explained by no candidate */
    double before_rms;                     /* of the measured pairs without exposures, |B1 - B2|, levels of 255 */
    double ring_end[LENSPROF_TRIAL_RINGS]; /* largest r of each ring, half diagonals */
} lensprof_trial_result;

/* Nothing measured. */
static inline void lensprof_trial_result_init(lensprof_trial_result *result) {
    lensprof_init_sized(result, sizeof *result);
}

/* Tries `profile_count` profiles on pairs of images of one camera at one lens setting; of the images only the frames
 * are used. options may be NULL. `candidates` has profile_count + 1 elements, initialised: one per profile, then no
 * falloff. Errors: ARGUMENT for NULL, no profile, values out of range and pairs outside images; STRUCT_SIZE;
 * NOT_FINITE; SIZE of an image; those of lensprof_profile_validate; NO_SAMPLES for fewer than LENSPROF_TRIAL_PAIRS
 * pairs to be measured, or if no candidate explains any; MEMORY. The error names the image, pair or profile. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_trial_run(
    const lensprof_trial_options *options, const lensprof_fit_image *images, uint32_t image_count,
    const lensprof_pair *pairs, uint32_t pair_count, const lensprof_profile *const *profiles, uint32_t profile_count,
    lensprof_trial_candidate *candidates, lensprof_trial_result *result, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
