/* lensprof/rendering.h - the response of a camera, from raw frames and the pictures that it rendered of them.
 *
 * Example: the response of a camera, from a raw frame (linear) and the camera's own JPEG of the same shot.
 *
 *     lensprof_rendering *rendering = NULL;
 *     lensprof_rendering_result result;
 *     lensprof_rendering_result_init(&result);
 *     status = lensprof_rendering_create(NULL, NULL, NULL, &rendering, &error);
 *     if (status == LENSPROF_OK) status = lensprof_rendering_add(rendering, &raw, &jpeg, &error);
 *     if (status == LENSPROF_OK) status = lensprof_rendering_fit(rendering, &result, &error);
 *     lensprof_rendering_destroy(rendering);
 *
 * Both pictures are aligned; means over smooth areas of both are compared. The model is
 *     y_c = f( exp(q1 r^2 + q2 r^4 + q3 r^6) sum_k A_ck raw_k ),   B_c = y_c + s (y_c - Y),   Y = luma of y,
 * with one response f for all channels and shots, and of each shot a matrix A (white balance, exposure and colour
 * matrix in one), the correction q of the falloff by the camera, and a saturation s. f(0) = 0, f(1) = 1: irradiance 1
 * is where the rendering reaches white. A map of residuals over the frame that two halves of the areas agree on shows
 * tones that the camera mapped locally.
 *
 * Threads: calls on different objects are independent; those on one object must not run at the same time. The pictures
 * are only read, during the call. Same input, same bytes.
 */
#ifndef LENSPROF_RENDERING_H
#define LENSPROF_RENDERING_H

#include "apply.h"
#include "model.h"
#include "reason.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_RENDERING_SHOTS 16    /* at most */
#define LENSPROF_RENDERING_SIDE 256    /* px, least longer side of a rendered picture */
#define LENSPROF_RENDERING_RAW_SIDE 64 /* px, least side of a raw frame */

/* Shots of one camera, compared, and what was fitted to them. */
typedef struct lensprof_rendering lensprof_rendering;

/* One shot: how its two pictures correspond, and what the camera did. */
typedef struct lensprof_rendering_shot {
    uint32_t struct_size;
    uint32_t width, height; /* of the rendered picture, rotated as the raw frame, px */
    uint32_t quarter_turns; /* clockwise, which rotate it so */
    double shift[2],
        scale;          /* from rendered picture to raw frame, each in units of its half diagonal about its middle: */
    double k1, k2;      /* raw = shift + scale p (1 + k1 |p|^2 + k2 |p|^4) */
    double correlation; /* of the local structure of both, aligned */
    double texture;     /* share of the frame with structure; without any, the alignment is not checked */
    uint32_t channels;  /* 1 or 3 */
    uint32_t squares;   /* of the rendered picture, of which these were left out: */
    uint32_t black, white;       /* in the rendered picture */
    uint32_t colourful;          /* a channel may have been clipped at 0 */
    uint32_t saturated;          /* in the raw frame */
    uint32_t rough;              /* not among the smoothest of their grey level */
    uint32_t areas;              /* compared. The following members are those of a fit; 0 before */
    uint32_t corrects_falloff;   /* 1: the camera brightened the corners, by three standard errors and 2 % */
    uint32_t tones;              /* 0: mapped globally; 1: perhaps locally; 2: locally, by pattern_levels */
    double radius;               /* largest r of an area, half diagonals of the raw frame */
    double corner, corner_sigma; /* irradiance of the rendering over that of the sensor at that r, and its standard
                                    error; in the middle 1 */
    double pattern_levels, pattern_ev; /* RMS of the map of residuals over the frame, levels of 255 and EV */
    double noise_levels;               /* of an area of neutral colour, levels of 255 */
    double white_ev;           /* from the white of the rendering to the saturation of the sensor, for a neutral */
    double gamma, gamma_sigma; /* from this shot alone, as in the result */
    double colour[9];          /* A, a row for each rendered channel; with one channel only [0] */
    double falloff[3];         /* q1, q2, q3 */
    double saturation;         /* s */
} lensprof_rendering_shot;

/* No shot. */
static inline void lensprof_rendering_shot_init(lensprof_rendering_shot *shot) {
    lensprof_init_sized(shot, sizeof *shot);
}

typedef struct lensprof_rendering_result {
    uint32_t struct_size;
    uint32_t usable;            /* 1, or 0 as the findings state */
    uint32_t findings;          /* number of lensprof_rendering_finding_at: refusals, then warnings, then notes; */
    uint32_t passed;            /* after them, the rules that hold */
    lensprof_response response; /* a TABLE */
    double gamma;           /* of the curve x^(1/gamma) with the same ratio of irradiance at grey levels 208 and 48 */
    double gamma_sigma;     /* standard error of ln gamma */
    double lowest, highest; /* grey values 0..1 that are measured, without one in 100 at each end */
    uint32_t tenths;        /* of the grey values that are measured */
    uint32_t shows_white;   /* 1: the rendering reaches white before the sensor saturates */
    uint32_t corrects_falloff; /* 1: in most shots */
    uint32_t shots;
    uint32_t areas;    /* compared in all shots */
    uint32_t reserved; /* 0 */
} lensprof_rendering_result;

/* An empty result. */
static inline void lensprof_rendering_result_init(lensprof_rendering_result *result) {
    lensprof_init_sized(result, sizeof *result);
}

/* Makes an object without shots in *rendering, to be released with lensprof_rendering_destroy. Unmeasured grey levels
 * are drawn to `prior`, which is copied; NULL = the typical response of current cameras. `progress`, or NULL, is called
 * during the calls below with 0, and cancels them. Errors: ARGUMENT for NULL; RESPONSE or ARGUMENT for an invalid
 * prior; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_rendering_create(const lensprof_response *prior,
                                                                         lensprof_progress progress,
                                                                         void *progress_user,
                                                                         lensprof_rendering **rendering,
                                                                         lensprof_error *error);

/* Releases it; NULL is allowed. */
LENSPROF_API void lensprof_rendering_destroy(lensprof_rendering *rendering);

/* Compares a shot: a raw frame, linear, U16, GREY or RGB, 65535 = saturated, at its full size or reduced, and the
 * picture rendered from it, U8, GREY or RGB, in any orientation. Errors: ARGUMENT for NULL, other pixels, more than
 * LENSPROF_RENDERING_SHOTS shots, or as many channels as no shot before has; SIZE for pictures that are too small;
 * UNSUPPORTED for a grey picture of a frame in colours; NO_OVERLAP if their structure does not match; those of
 * lensprof_image_validate; CANCELLED; MEMORY. The shot is then not added. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_rendering_add(lensprof_rendering *rendering,
                                                                      const lensprof_image *raw,
                                                                      const lensprof_image *rendered,
                                                                      lensprof_error *error);

/* Fits the response to all shots. A fit that ran returns OK even if the result is poor: see `usable`. More shots may be
 * added later, and fitted again. Errors: ARGUMENT for NULL; STRUCT_SIZE; NO_SAMPLES without shots, or for one with too
 * few smooth, unclipped areas, which the error names; CANCELLED; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_rendering_fit(lensprof_rendering *rendering,
                                                                      lensprof_rendering_result *result,
                                                                      lensprof_error *error);

/* Shot `index`, in the order of adding, and finding `index` of the last fit: of `findings`, then of `passed`. The
 * structs must be initialised. Errors: ARGUMENT for NULL and numbers out of range; STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_rendering_shot_at(const lensprof_rendering *rendering,
                                                                          uint32_t index, lensprof_rendering_shot *shot,
                                                                          lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_rendering_finding_at(const lensprof_rendering *rendering,
                                                                             uint32_t index, lensprof_finding *finding,
                                                                             lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
