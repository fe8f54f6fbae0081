/* lensprof/flat.h - falloff from pictures of a white card or of another even light.
 *
 * Method `flat` (Goldman & Chen 2005, section 6.1): with the response known, the exposures of one shot are merged,
 *     E = sum_i w_i g(B_i) / t_i  /  sum_i w_i,
 * and the falloff is fitted to what was merged (equation 14):
 *     sum over cells of ( E - t L0 M(r) )^2,        M(0) = 1.
 * Beyond the paper: cells weighted by their noise, wrong ones distrusted, one curve a channel where they differ, a free
 * centre, the light's own gradient, a covariance, and a verdict in words.
 *
 * A light that is not even and a falloff that is not centred look alike in one picture. Shots with the camera turned
 * about its axis tell them apart: the light stays with the scene, the falloff with the frame. What stays unknown is how
 * the light itself falls off evenly in all directions; a card at several places of the frame does not need it even.
 *
 * Threads: calls are independent of each other; the pictures are only read. One call uses as many threads as its
 * options say, all gone when it returns; the result does not depend on their number: same input, same bytes. */
#ifndef LENSPROF_FLAT_H
#define LENSPROF_FLAT_H

#include "apply.h"
#include "fit.h"
#include "profile.h"
#include "reason.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_FLAT_IMAGES 128 /* most pictures of a call */
#define LENSPROF_FLAT_SPOTS 32   /* most spots of dust that are told one by one */

/* One picture. */
typedef struct lensprof_flat_image {
    uint32_t struct_size;
    uint32_t width, height;   /* full frame, px; the same for all pictures */
    uint32_t reduction;       /* as in lensprof_sample_image */
    uint32_t shot;            /* pictures of one shot (same pose, same light, other exposure) carry one number */
    uint32_t reserved;        /* 0 */
    lensprof_image view;      /* the frame, reduced or not; layouts with alpha: alpha below half = excluded */
    const uint8_t *mask;      /* one byte a view pixel, 0 = not the card; NULL = all of it */
    ptrdiff_t mask_row_bytes; /* at least the width of the view, or at most minus that; unused without a mask */
    double black, white;      /* samples outside [black, white] in any channel are not used; 0..1 */
    double ev;                /* known exposure, EV up to a common offset: log2 of t. Only differences within a shot
                                 count, and, for a card at several places, between shots */
    double turn_deg;          /* camera turned about its axis, clockwise as seen from behind it: degrees; one a shot */
} lensprof_flat_image;

/* Full size, shot 0, no mask, 2/255 to 250/255, 0 EV, not turned; view and frame zero, to be set by the caller. */
LENSPROF_API void lensprof_flat_image_init_sized(lensprof_flat_image *image, size_t size);
static inline void lensprof_flat_image_init(lensprof_flat_image *image) {
    lensprof_flat_image_init_sized(image, sizeof *image);
}

typedef enum lensprof_flat_light {
    LENSPROF_FLAT_LIGHT_AUTO = 0,     /* PLANE; for a card at several places EVEN */
    LENSPROF_FLAT_LIGHT_EVEN = 1,     /* the light is even: what is not radial is the lens's centre */
    LENSPROF_FLAT_LIGHT_PLANE = 2,    /* its logarithm is a plane over the scene, one a channel */
    LENSPROF_FLAT_LIGHT_QUADRATIC = 3 /* and the two second-order terms that no falloff has: x^2 - y^2 and xy */
} lensprof_flat_light;

typedef enum lensprof_flat_grid {
    LENSPROF_FLAT_GRID_AUTO = 0, /* where the polynomial leaves more than 0.3 % (rms) */
    LENSPROF_FLAT_GRID_NONE = 1,
    LENSPROF_FLAT_GRID_ALWAYS = 2
} lensprof_flat_grid;

typedef struct lensprof_flat_options {
    uint32_t struct_size;
    uint32_t channels;    /* 1 or 3; three channels need views in colour */
    uint32_t free;        /* LENSPROF_FREE_K1 | _K2 | _K3 | _CENTER */
    uint32_t vignettings; /* falloff curves: 1 for all channels, 3, or 0 = 3 where they clearly differ */
    uint32_t light;       /* lensprof_flat_light */
    uint32_t own_light;   /* 0: one light for all shots, fixed to the scene; 1: every shot has a light of its own */
    uint32_t several;     /* 0: every shot fills the frame, its brightness is free; 1: one card at several places of the
                             frame, with one brightness in all shots, whose exposures are known */
    uint32_t find_card;  /* 1: the card covers a part of the frame, and is looked for: the largest even bright region */
    uint32_t grid;       /* lensprof_flat_grid */
    uint32_t responses;  /* 1 for all channels, or 3 */
    uint32_t threads;    /* at most so many, the caller's included; 0 = one a core */
    uint32_t reserved;   /* 0 */
    double ev_sigma;     /* SEVERAL: standard error of an exposure, 0.001..1 EV */
    double prior_weight; /* weight of the priors on falloff and centre (docs/model.md); 0 = none, 1 = default */
    const lensprof_response *response; /* `responses` of them; NULL = linear. Read during the call */
    lensprof_vignetting vignetting;    /* the value where fixed */
    lensprof_progress progress;        /* or NULL; the fraction never falls */
    void *progress_user;
} lensprof_flat_options;

/* 3 channels, everything free, curves, light and grid AUTO, frame-filling shots of one light, linear, 0.02 EV, prior
 * weight 1, threads on all cores. */
LENSPROF_API void lensprof_flat_options_init_sized(lensprof_flat_options *options, size_t size);
static inline void lensprof_flat_options_init(lensprof_flat_options *options) {
    lensprof_flat_options_init_sized(options, sizeof *options);
}

/* What one picture gave. It grows by lensprof_flat_result.image_quality_size. Shares are of the card's part of the
 * frame. */
typedef struct lensprof_flat_image_quality {
    double white_share, black_share; /* of its cells that hold samples beyond the limits */
    double noise_levels;             /* noise of a pixel of the view, levels of 255; median over the cells */
    double ev_residual;              /* its light less what the others of its shot say, EV; 0 for a single picture */
    double residual;                 /* of its shot: rms of what the model leaves, share of the light */
    double gradient[2];              /* of its shot: light to the right and down in the frame, share a half diagonal */
    double radius;                   /* of its shot: largest r of a cell used, half diagonals */
    uint32_t card[4];                /* of its shot: left, top, width, height of the card, px of the frame */
    uint32_t cells;                  /* of its shot: cells used */
    uint32_t reserved;               /* 0 */
} lensprof_flat_image_quality;

/* Dust, or a mark on the card: a small dark place that was left out. Frozen value struct. */
typedef struct lensprof_flat_spot {
    double x, y;    /* px of the frame */
    double radius;  /* px */
    double depth;   /* light that is missing, share, in its darkest cell */
    uint32_t shots; /* that show it: in all of several turned ones it is on the sensor, in one of them on the card */
    uint32_t reserved;
} lensprof_flat_spot;

typedef struct lensprof_flat_result {
    uint32_t struct_size;
    uint32_t usable;                   /* 1, or 0 with the reason in words */
    uint32_t image_quality_size;       /* bytes of an element of image_quality, set by the _init function */
    uint32_t covariance_size;          /* order as in profile.h, with the coefficients of the responses that were given;
                                          parameters held fixed have zero rows; 0 = not determined, or more than
                                          LENSPROF_COVARIANCE_MAX */
    char reason[256];                  /* why not usable; when usable empty, or what to mind */
    lensprof_vignetting vignetting[3]; /* of the channels; all alike when `vignettings` is 1; they share one centre */
    uint32_t vignettings;              /* 1 or 3 */
    uint32_t light;                    /* EVEN, PLANE or QUADRATIC */
    uint32_t shots;
    uint32_t cells;     /* cells used, of all shots */
    uint32_t separated; /* 1: the pictures tell the light's gradient from the centre; 0: the prior on the centre
                           does, or it is held */
    uint32_t iterations;
    uint32_t converged;
    uint32_t spots; /* found; the largest LENSPROF_FLAT_SPOTS of them follow */
    lensprof_flat_spot spot[LENSPROF_FLAT_SPOTS];
    double radius;         /* largest r of a cell used, half diagonals */
    double noise;          /* of a cell, expected from that of its pixels: share of the light */
    double residual;       /* of a cell: rms of what the model leaves, share of the light */
    double texture;        /* of it, finer than some cells and beyond the noise: the card is not even */
    double frame_residual; /* of it, coarser, at the same place of the frame in all shots: the falloff is not radial
                              (of a single shot: or the light is not even) */
    double shot_residual; /* of it, coarser, of each shot's own: the light is not what the model says; 0 for one shot */
    double inlier_share;  /* of cells: within 3 sigma */
    double corner_sigma;  /* standard error of M at r = 1 */
    double grid_residual; /* what falloff and grid together leave of frame_residual; 0 without a grid */
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX];
    lensprof_gain_grid gain_grid; /* what the polynomial leaves: the attenuation is M times it, and it is 1 at the
                                     centre of M. 0 x 0 where it is not asked for, or nothing shows it */
    lensprof_flat_image_quality *image_quality; /* the caller's array of `image_count`, set before the call; or NULL */
    uint32_t reason_code;                       /* lensprof_reason: what `reason` states, */
    uint32_t reason_values;                     /* how many numbers, 0..2, */
    lensprof_item reason_item;                  /* which image or shot, */
    double reason_value[2];                     /* and the numbers, in the units of reason.h */
} lensprof_flat_result;

/* No result. */
LENSPROF_API void lensprof_flat_result_init_sized(lensprof_flat_result *result, size_t size, size_t image_quality_size);
static inline void lensprof_flat_result_init(lensprof_flat_result *result) {
    lensprof_flat_result_init_sized(result, sizeof *result, sizeof(lensprof_flat_image_quality));
}

/* Fits the falloff to `image_count` pictures. A fit that ran returns OK even when the result is poor: see `usable`.
 * Errors: unusable options, shots with different turns or pictures with different frames ARGUMENT or SIZE; NaN in a
 * float view NOT_FINITE (the text names image and pixel); no cell between black and white NO_SAMPLES; nothing free
 * NO_UNKNOWNS; a response that is none RESPONSE; CANCELLED; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_flat(const lensprof_flat_options *options,
                                                                 const lensprof_flat_image *images,
                                                                 uint32_t image_count, lensprof_flat_result *result,
                                                                 lensprof_error *error);

/* Puts what was found into an initialised profile, as lensprof_profile_from_fit does: the responses of the options
 * (linear where there are none), vignettings, covariance and gain grid; method "flat", cells as pairs. options: those
 * of the fit, whose responses are read; NULL = a linear response. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_from_flat(lensprof_profile *profile,
                                                                          const lensprof_flat_result *result,
                                                                          const lensprof_flat_options *options,
                                                                          uint32_t image_count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
