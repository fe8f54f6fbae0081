/* lensprof/flat.h - falloff from pictures of a white card or of another even light.
 *
 * Example: the falloff from a linear picture of a white card.
 *
 *     lensprof_flat *flat = NULL;
 *     lensprof_flat_image card;
 *     lensprof_flat_options options;
 *     lensprof_flat_image_init(&card), lensprof_flat_options_init(&options), lensprof_profile_init(&profile);
 *     card.view = image, card.width = image.width, card.height = image.height;
 *     status = lensprof_fit_flat(&options, &card, 1, NULL, 0, &flat, &error);
 *     if (status == LENSPROF_OK) status = lensprof_flat_profile(flat, &profile, &error);
 *     lensprof_flat_destroy(flat);
 *
 * Method `flat` (Goldman & Chen 2005, section 6.1): the response is known. The exposures of each shot are merged,
 *     E = sum_i w_i g(B_i) / t_i  /  sum_i w_i,
 * and the falloff is fitted to the result (equation 14):
 *     sum over cells of ( E - t L0 M(r) )^2,        M(0) = 1.
 * M is a polynomial in r^2 or, where this fits far better, as for deep falloffs, the exponential of one; the profile
 * then holds the nearest polynomial, and a gain grid the rest. What lies outside of the image circle is left out.
 *
 * Beyond the paper: cells are weighted by their noise, outliers are down-weighted, channels get curves of their own if
 * they differ, the centre is free, the gradient of the light is estimated, and the result has a covariance and
 * findings.
 *
 * Uneven light and a decentred falloff look alike in one picture. Shots with the camera rotated about its axis separate
 * them: the light stays with the scene, the falloff with the frame. A radially symmetric decrease of the light remains
 * indistinguishable from falloff. A card at several places of the frame avoids this: its light need not be even.
 *
 * Threads: calls are independent of each other; the pictures are only read. One call uses up to the number of threads
 * in its options, and joins them before it returns. The result does not depend on that number: same input, same bytes.
 */
#ifndef LENSPROF_FLAT_H
#define LENSPROF_FLAT_H

#include "apply.h"
#include "fit.h"
#include "profile.h"
#include "reason.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_FLAT_IMAGES 128 /* maximum number of pictures in a call */
#define LENSPROF_FLAT_SPOTS 32   /* maximum number of dust spots listed individually */

/* One picture. */
typedef struct lensprof_flat_image {
    uint32_t struct_size;
    uint32_t width, height;   /* full frame, px; the same for all pictures */
    uint32_t reduction;       /* as in lensprof_sample_image */
    uint32_t shot;            /* pictures of one shot (same pose and light, different exposure) have the same number */
    uint32_t reserved;        /* 0 */
    lensprof_image view;      /* the frame, reduced or not; in layouts with alpha, alpha below half = excluded */
    const uint8_t *mask;      /* one byte per view pixel, 0 = not the card; NULL = all of it is card */
    ptrdiff_t mask_row_bytes; /* magnitude at least the width of the view, may be negative; unused without a mask */
    double black, white; /* grey values outside [black, white] in any channel are not used; 0..1. With levels in the
                            options: of B, not of the samples */
    double ev; /* known exposure, log2 of t, EV up to a common offset. Only differences matter: within a shot and, for
                  a card at several places, between shots */
    double rotation_deg; /* rotation of the camera about its axis, degrees clockwise seen from the back of the camera;
                        the same for all pictures of a shot */
} lensprof_flat_image;

/* Full size, shot 0, no mask, 2/255 to 250/255, 0 EV, no rotation. View and frame are zero; the caller must set them.
 */
LENSPROF_API void lensprof_flat_image_init_sized(lensprof_flat_image *image, size_t size);
static inline void lensprof_flat_image_init(lensprof_flat_image *image) {
    lensprof_flat_image_init_sized(image, sizeof *image);
}

typedef enum lensprof_flat_light {
    LENSPROF_FLAT_LIGHT_AUTO = 0,     /* PLANE; EVEN for a card at several places, and for shots at one angle that an
                                         even light and a lens a little off centre describe as well; QUADRATIC for
                                         shots at several angles that show a curved light */
    LENSPROF_FLAT_LIGHT_EVEN = 1,     /* the light is even: all asymmetry is due to the centre of the lens */
    LENSPROF_FLAT_LIGHT_PLANE = 2,    /* the logarithm of the light is a plane over the scene, one per channel */
    LENSPROF_FLAT_LIGHT_QUADRATIC = 3 /* PLANE plus the two second-order terms that no falloff has: x^2 - y^2 and xy */
} lensprof_flat_light;

typedef enum lensprof_flat_grid {
    LENSPROF_FLAT_GRID_AUTO = 0, /* if the falloff leaves more than 0.3 % (rms), or is not a polynomial in r^2 */
    LENSPROF_FLAT_GRID_NONE = 1, /* the falloff is then the polynomial nearest to the pictures */
    LENSPROF_FLAT_GRID_ALWAYS = 2
} lensprof_flat_grid;

typedef struct lensprof_flat_options {
    uint32_t struct_size;
    uint32_t channels;    /* 1 or 3; three channels require colour views */
    uint32_t free;        /* LENSPROF_FREE_K1 | _K2 | _K3 | _CENTER */
    uint32_t vignettings; /* falloff curves: 1 for all channels, 3, or 0 = 3 if they differ clearly */
    uint32_t light;       /* lensprof_flat_light */
    uint32_t own_light;   /* 0: one light for all shots, fixed to the scene; 1: each shot has its own light */
    uint32_t several;   /* 0: each shot fills the frame and its brightness is free; 1: one card at several places of the
                           frame, with the same brightness in all shots, whose exposures are known */
    uint32_t find_card; /* 1: the card covers only a part of the frame; it is found as the largest even bright region */
    uint32_t grid;      /* lensprof_flat_grid */
    uint32_t responses; /* 1 for all channels, or 3 */
    uint32_t threads;   /* maximum number, including the caller's; 0 = one per core */
    uint32_t reserved;  /* 0 */
    double ev_sigma;    /* if `several`: standard error of an exposure, 0.001..1 EV */
    double prior_weight; /* weight of the priors on falloff and centre (docs/model.md); 0 = none, 1 = default */
    const lensprof_response *response; /* array of `responses`; NULL = linear. Read during the call */
    lensprof_vignetting vignetting;    /* values of fixed parameters */
    lensprof_progress progress;        /* or NULL; the fraction never decreases */
    void *progress_user;
    lensprof_levels levels; /* of the samples of all pictures; all 0 = none */
    double black_sigma; /* standard error of the black level, share of white less black, 0..0.2; 0 = exact. Otherwise
                           what the level leaves is estimated, if the responses are linear: see below */
} lensprof_flat_options;

/* black_sigma: an offset b that was not subtracted makes the falloff too weak, and one picture does not show it.
 * Pictures of one pattern of light F at different levels a do: the exposures of a shot, whose times need not be exact,
 * and shots at one angle. B_n(x) = b + a_n F(x) is fitted to them per channel, with b = 0 +- black_sigma before; with
 * own_light, ln a_n is a plane. b is subtracted, and is in the levels of result and profile. Without such pictures it
 * stays 0. */

/* 3 channels, everything free, curves, light and grid AUTO, frame-filling shots with a common light, linear response,
 * 0.02 EV, prior weight 1, threads on all cores, no levels, black exact. */
LENSPROF_API void lensprof_flat_options_init_sized(lensprof_flat_options *options, size_t size);
static inline void lensprof_flat_options_init(lensprof_flat_options *options) {
    lensprof_flat_options_init_sized(options, sizeof *options);
}

/* A fit of a card: what the call below found. Calls on one fit may run in several threads. */
typedef struct lensprof_flat lensprof_flat;

/* Quality of one picture. Shares refer to the card's part of the frame. "Of the shot": the value is that of the whole
 * shot. */
typedef struct lensprof_flat_image_quality {
    uint32_t struct_size;
    uint32_t cells;                  /* of the shot: number of cells used */
    double white_share, black_share; /* share of cells that contain samples beyond the limits */
    double noise_levels;             /* noise of a view pixel, levels of 255; median over the cells */
    double ev_residual; /* its light minus that of the other pictures of its shot, EV; 0 for a single picture */
    double residual;    /* of the shot: rms residual of the model, share of the light */
    double gradient[2]; /* of the shot: gradient of the light to the right and down in the frame, share per half
                           diagonal */
    double radius;      /* of the shot: largest r of a cell used, half diagonals */
    uint32_t card[4];   /* of the shot: left, top, width, height of the card, px of the frame */
} lensprof_flat_image_quality;

/* All zero. */
static inline void lensprof_flat_image_quality_init(lensprof_flat_image_quality *quality) {
    lensprof_init_sized(quality, sizeof *quality);
}

/* Dust, or a mark on the card: a small dark place that was excluded. Frozen value struct. */
typedef struct lensprof_flat_spot {
    double x, y;    /* px of the frame */
    double radius;  /* px */
    double depth;   /* share of light missing in its darkest cell */
    uint32_t shots; /* shots that show it. With rotated shots: all of them = on the sensor, only one = on the card */
    uint32_t reserved;
} lensprof_flat_spot;

typedef struct lensprof_flat_result {
    uint32_t struct_size;
    uint32_t usable;          /* 1, or 0 as the findings state */
    uint32_t images;          /* pictures given */
    uint32_t covariance_size; /* order as in profile.h, with the coefficients of the responses in the options; fixed
                                 parameters have zero rows; 0 = not determined, or more than LENSPROF_COVARIANCE_MAX */
    uint32_t findings;        /* number of lensprof_flat_finding_at: refusals, then warnings, then notes; */
    uint32_t passed;          /* after them, the rules that hold */
    lensprof_vignetting vignetting[3]; /* per channel; all equal if `vignettings` is 1; they share one centre */
    uint32_t vignettings;              /* 1 or 3 */
    uint32_t light;                    /* EVEN, PLANE or QUADRATIC */
    uint32_t shots;
    uint32_t cells;     /* cells used in all shots */
    uint32_t separated; /* 1: the pictures separate the gradient of the light from the centre; 0: the prior on the
                           centre does, or the centre is fixed */
    uint32_t iterations;
    uint32_t converged;
    uint32_t spots; /* number found; the largest LENSPROF_FLAT_SPOTS of them follow */
    lensprof_flat_spot spot[LENSPROF_FLAT_SPOTS];
    double radius;         /* largest r of a cell used, half diagonals */
    double noise;          /* of a cell, expected from that of its pixels: share of the light */
    double residual;       /* of a cell: rms residual of the model, share of the light. Its components follow: */
    double texture;        /* finer than some cells and above the noise: the card is not uniform */
    double frame_residual; /* coarser, at the same place of the frame in all shots: the falloff is not radial (with a
                              single shot, the light may be uneven instead) */
    double shot_residual;  /* coarser, different in each shot: the light does not follow the model; 0 for one shot */
    double inlier_share;   /* share of cells within 3 sigma */
    double corner_sigma;   /* standard error of the falloff at r = 1, or at `radius` if there is an edge; with what a
                              curved light and the pattern that is left add, the latter not without a grid */
    double grid_residual;  /* what falloff and grid together leave of frame_residual; 0 without a grid */
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX];
    lensprof_gain_grid gain_grid; /* residual of the polynomial: the attenuation is M times this grid, which is 1 at the
                                     centre of M. 0 x 0 if not requested, or if the pictures do not constrain it */
    double corner;                /* M times grid: mean of the corners and channels; with an edge, mean along
                                     `radius` */
    double edge_radius; /* where the data end: the radius of the image circle, or the distance of what is nearest in
                           front of the lens from the middle of the frame, half diagonals; 0 = with the frame */
    double edge_share;  /* share of the frame beyond the edge, which was left out */
    double light_ev;    /* largest change of the falloff in a corner if the light were stated to be even (PLANE was
                           chosen) or a plane (EVEN was chosen), EV; 0 if the light was not chosen by the data */
    double polynomial_error; /* largest relative error of M without the grid, where the falloff is not a polynomial */
    lensprof_levels levels;  /* of the options, with the offset that was found */
    double black_offset;     /* of it: share of full scale, of the channel in which it is largest; 0 if none */
    double black_sigma;      /* standard error of the black level after the fit, share of full scale */
    double black_ev;         /* change of the falloff in the corner if the black level is off by this, EV */
    uint32_t black_shown;    /* 1: the pictures determine the black level better than the options do */
    uint32_t reserved;       /* 0 */
    lensprof_image_circle image_circle; /* if the data end at one; all 0 = none */
} lensprof_flat_result;

/* An empty result. */
static inline void lensprof_flat_result_init(lensprof_flat_result *result) {
    lensprof_init_sized(result, sizeof *result);
}

/* Bytes of memory that a fit of this number of pictures takes; 0 beyond LENSPROF_FLAT_IMAGES. */
LENSPROF_API size_t lensprof_flat_bytes(uint32_t image_count);

/* Fits the falloff to `image_count` pictures. *flat receives all that was found: in memory[size], 8-byte aligned, of at
 * least lensprof_flat_bytes, which must outlive it; or, if memory is NULL, in memory of its own. Release it with
 * lensprof_flat_destroy. A fit that ran returns OK even if the result is poor: see `usable`.
 * Errors: ARGUMENT or SIZE for unusable options, different rotation_deg within a shot or different frames; CAPACITY for
 * too little or unaligned memory; NOT_FINITE for NaN in a float view (the text names image and pixel); NO_SAMPLES if no
 * cell lies between black and white; NO_UNKNOWNS if nothing is free; RESPONSE for an invalid response; CANCELLED;
 * MEMORY. *flat is then unchanged. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_flat(const lensprof_flat_options *options,
                                                                 const lensprof_flat_image *images,
                                                                 uint32_t image_count, void *memory, size_t size,
                                                                 lensprof_flat **flat, lensprof_error *error);

/* Releases a fit, whose memory is the caller's again; NULL is allowed. */
LENSPROF_API void lensprof_flat_destroy(lensprof_flat *flat);

/* What was found, and what picture `index` gave to it. The structs must be initialised. Errors: ARGUMENT for NULL, a
 * number out of range, and a fit released in the caller's memory (one in memory of its own must not be used again);
 * STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_flat_get(const lensprof_flat *flat,
                                                                 lensprof_flat_result *result, lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_flat_image_at(const lensprof_flat *flat, uint32_t index,
                                                                      lensprof_flat_image_quality *quality,
                                                                      lensprof_error *error);

/* Finding `index`: of `findings`, then of `passed`. Errors: as lensprof_flat_get. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_flat_finding_at(const lensprof_flat *flat, uint32_t index,
                                                                        lensprof_finding *finding,
                                                                        lensprof_error *error);

/* Makes the profile in an initialised *profile, as lensprof_fit_profile does: the responses of the options (linear by
 * default), vignettings, covariance and gain grid; method "flat"; `pairs` counts cells. Errors: as lensprof_flat_get;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_flat_profile(const lensprof_flat *flat,
                                                                     lensprof_profile *profile, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
