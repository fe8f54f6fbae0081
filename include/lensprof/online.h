/* lensprof/online.h - exposure, response and falloff of a camera that runs, from tracked points, frame by frame.
 *
 * Example: two frames of a tracker; the exposure of the second one relative to the first.
 *
 *     static uint64_t memory[1 << 17];
 *     static lensprof_online_observation seen[200];
 *     lensprof_online_options options; lensprof_online_frame frame; lensprof_online_exposure exposure;
 *     lensprof_online *online = NULL;
 *     lensprof_online_options_init(&options), lensprof_online_exposure_init(&exposure);
 *     options.width = 640, options.height = 480, options.tracks = 200;
 *     status = lensprof_online_begin(memory, sizeof memory, &options, &online, &error);
 *     for (uint32_t i = 0; i < 2 && status == LENSPROF_OK; i++) {
 *         for (uint32_t t = 0; t < 200; t++) // a tracker finds these; here all grey values rise by a fifth
 *             seen[t] = (lensprof_online_observation){t, 3.0f * t, 2.0f * t, {(50 + t) / (i ? 400.0f : 480.0f)}, 1};
 *         lensprof_online_frame_init(&frame), frame.number = i, frame.count = 200, frame.observations = seen;
 *         status = lensprof_online_add(online, &frame, &exposure, &error);
 *     }
 *     if (status == LENSPROF_OK) status = lensprof_online_solve(online, 1, NULL, &error);
 *     printf("%+.3f EV, standard error %.3f\n", exposure.step_ev, exposure.step_sigma);
 *
 *     B = f( L M(r) e )        of every observation of a track: one L per track and channel, one e per frame and
 * channel
 *
 * lensprof_online_add finds e of a frame from the tracks that it shares with earlier ones (robust weights), updates L
 * of its tracks, and keeps the observations of some frames, the keyframes. lensprof_online_solve fits f (the typical
 * response of the kind of camera, and some EMoR modes), M, and all L and e of the keyframes of a window by Gauss-Newton
 * steps (Goldman & Chen 2005, equations 2 and 3). When the window is full and its fit has converged, its information
 * about f and M is kept as a quadratic prior, and its observations are dropped: memory and time per frame do not grow.
 *
 * Tracks leave the common exponent of f, M and e open. It is not part of the fit: only known exposures, and otherwise
 * what is known of the kind of camera or the given profile, determine it. All standard errors include its error.
 *
 * The caller provides all memory, and there is no heap in begin, add, solve and exposure_at. The library reads no
 * clock: the budget of a solve is a number of steps, and the same calls give the same bytes. Memory contains no
 * address: it may be copied, and the copy used, with the same version of the library. Threads: one at a time per
 * memory. */
#ifndef LENSPROF_ONLINE_H
#define LENSPROF_ONLINE_H

#include "model.h"
#include "profile.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_ONLINE_TRACKS 8192   /* most observations per frame */
#define LENSPROF_ONLINE_KEYFRAMES 24  /* most keyframes of a window */
#define LENSPROF_ONLINE_MODES 8       /* most EMoR modes */
#define LENSPROF_ONLINE_HISTORY 65536 /* most exposures kept */

typedef struct lensprof_online_options {
    uint32_t struct_size;
    uint32_t width, height; /* frame, px */
    uint32_t channels;      /* 1 or 3 */
    uint32_t camera_kind;   /* lensprof_camera_kind: the response to start from, and its scatter. LINEAR: f(x) = x */
    uint32_t tracks;        /* most observations per frame, 8..8192 */
    uint32_t keyframes;     /* of a window, 4..24 */
    uint32_t modes;         /* EMoR modes that the fit adds to the response it starts from, 0..8 */
    uint32_t history;       /* frames whose exposures can be asked for later, 2..65536 */
    uint32_t reserved;      /* 0 */
    double center[2];       /* of the falloff, half diagonals from the middle of the frame, -0.5..0.5 */
    double black, white;    /* grey values that are used: 0 <= black < white <= 1 */
    const lensprof_profile *profile; /* of the same camera and lens, to start from: response 0, falloff and its centre.
                                        Its covariance, if any, is the prior; NULL = none. Read during begin */
} lensprof_online_options;

/* No frame, which must be set; 1 channel, kind ANY, 512 tracks, 12 keyframes, 6 modes, history of 64 frames, centre 0,
 * grey values 0.04..0.94, no profile. */
LENSPROF_API void lensprof_online_options_init_sized(lensprof_online_options *options, size_t size);
static inline void lensprof_online_options_init(lensprof_online_options *options) {
    lensprof_online_options_init_sized(options, sizeof *options);
}

/* What a tracker sees of one point in one frame. Frozen value struct. */
typedef struct lensprof_online_observation {
    uint64_t track; /* any number, the same for one point in all frames; once per frame */
    float x, y;     /* position, px, -0.5..width - 0.5 and height - 0.5 */
    float value[3]; /* grey value 0..1 per channel; with one channel only [0] */
    float weight;   /* inverse of the variance of its noise relative to others, 0..1000; 1 = as most. 0: not used */
} lensprof_online_observation;

typedef struct lensprof_online_frame {
    uint32_t struct_size;
    uint32_t count;        /* of observations; 0 = the tracker lost all */
    uint64_t number;       /* increases from frame to frame; gaps are allowed */
    double known_ev;       /* exposure stated by the camera, EV up to a common offset */
    double known_ev_sigma; /* its standard error, 0.001..100 EV; 0 = unknown. Values below 0.02 count as 0.02 */
    const lensprof_online_observation *observations; /* read during the call */
} lensprof_online_frame;

/* No observations, number 0, no known exposure. */
LENSPROF_API void lensprof_online_frame_init_sized(lensprof_online_frame *frame, size_t size);
static inline void lensprof_online_frame_init(lensprof_online_frame *frame) {
    lensprof_online_frame_init_sized(frame, sizeof *frame);
}

typedef enum lensprof_online_state {
    LENSPROF_ONLINE_FIRST = 0, /* begins a chain of exposures: the exposures of frames from here on refer to this one */
    LENSPROF_ONLINE_CHAINED = 1, /* shares tracks with earlier frames of the chain */
    LENSPROF_ONLINE_LOST = 2     /* too few usable observations: no exposure. If tracks of the chain come back soon, the
                                    chain goes on; otherwise the next usable frame begins another one */
} lensprof_online_state;

/* Exposure of one frame. Unknown values are NaN, and their standard errors infinite. */
typedef struct lensprof_online_exposure {
    uint32_t struct_size;
    uint32_t state;             /* lensprof_online_state */
    uint64_t number;            /* the frame */
    uint64_t since;             /* first frame of the chain */
    uint64_t before;            /* the measured frame of the chain before this one, to which the step refers */
    double ev, ev_sigma;        /* relative to frame `since` */
    double step_ev, step_sigma; /* relative to frame `before` */
    double white_balance[3];    /* relative to frame `since`; 1, 1, 1 with one channel */
    uint32_t tracks;            /* that determine it */
    uint32_t outliers;          /* tracks that contradict it */
    uint32_t unusable;          /* observations outside of black..white or of weight 0 */
    uint32_t keyframe;          /* 1: the observations are kept for the next solves */
} lensprof_online_exposure;

/* Zeros. */
LENSPROF_API void lensprof_online_exposure_init_sized(lensprof_online_exposure *exposure, size_t size);
static inline void lensprof_online_exposure_init(lensprof_online_exposure *exposure) {
    lensprof_online_exposure_init_sized(exposure, sizeof *exposure);
}

/* What is determined well enough to rely on. */
typedef enum lensprof_online_known {
    LENSPROF_ONLINE_KNOWS_EXPONENT = 1, /* standard error of ln gamma at most 0.05 */
    LENSPROF_ONLINE_KNOWS_SHAPE = 2,    /* of the response with this exponent: at most 0.01 in grey value */
    LENSPROF_ONLINE_KNOWS_FALLOFF = 4   /* of the corner's falloff with this exponent: at most 2 % */
} lensprof_online_known;

typedef struct lensprof_online_result {
    uint32_t struct_size;
    uint32_t known;          /* lensprof_online_known: what is certain */
    uint64_t frames;         /* added */
    uint64_t lost;           /* of these, without an exposure */
    uint64_t chains;         /* of exposures */
    uint64_t keyframes;      /* kept since the beginning */
    uint64_t observations;   /* of keyframes */
    uint64_t windows;        /* that were completed */
    double gamma;            /* exponent of the response between grey levels 48 and 208, e.g. 2.2 */
    double log_gamma_sigma;  /* standard error of ln gamma, the common exponent of response, falloff and exposures */
    double shape_sigma;      /* of the response at a given exponent: largest of three grey values, 0..1 */
    double corner;           /* falloff M in the corner, r = 1 */
    double corner_sigma;     /* its standard error, with that of the exponent */
    double falloff_sigma;    /* standard error of ln M in the corner at a given exponent */
    double noise_levels;     /* of one observation, grey levels of 255 */
    double known_ev_scatter; /* of known exposures about those found, in their standard errors; 0 = fewer than three */
    double inlier_share;     /* of the observations of tracks that frames of a chain share, 0..1 */
} lensprof_online_result;

/* Zeros. */
LENSPROF_API void lensprof_online_result_init_sized(lensprof_online_result *result, size_t size);
static inline void lensprof_online_result_init(lensprof_online_result *result) {
    lensprof_online_result_init_sized(result, sizeof *result);
}

typedef struct lensprof_online lensprof_online;

/* Bytes of memory that lensprof_online_begin needs: about 0.68 MB with the default options. 0 for NULL and for options
 * that begin refuses by their sizes. */
LENSPROF_API size_t lensprof_online_bytes(const lensprof_online_options *options);

/* Begins in memory[size] (8-byte aligned, owned by the caller, must outlive *online). Errors: ARGUMENT for NULL,
 * unaligned memory, unknown kinds and options out of range; SIZE for an empty frame; CAPACITY for too little memory;
 * NOT_FINITE; STRUCT_SIZE; those of lensprof_profile_validate for the profile; RESPONSE for a profile with a
 * response per channel. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_online_begin(void *memory, size_t size,
                                                                     const lensprof_online_options *options,
                                                                     lensprof_online **online, lensprof_error *error);

/* Adds a frame, and returns its exposure (NULL: not wanted). Takes at most about 1 microsecond per observation and
 * channel. Errors: ARGUMENT for NULL, a number that does not increase, a track that occurs twice, positions outside of
 * the frame, grey values and weights out of range, and known exposures beyond 64 EV; NOT_FINITE; CAPACITY for more
 * observations than options.tracks; STRUCT_SIZE. Nothing is added then. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_online_add(lensprof_online *online,
                                                                   const lensprof_online_frame *frame,
                                                                   lensprof_online_exposure *exposure,
                                                                   lensprof_error *error);

/* Takes up to `steps` steps of the fit of the window; one step takes time in proportion to the observations of the
 * window, at most about 1.5 microseconds each. *pending (may be NULL) receives whether another step would change
 * anything: 0 if there is nothing to do, e.g. before the second keyframe. Exposures kept so far follow the new response
 * and falloff. If nobody calls this function, add goes on with the first response and keeps no keyframes beyond a
 * window. One step per frame is enough. Errors: ARGUMENT for NULL. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_online_solve(lensprof_online *online, uint32_t steps,
                                                                     uint32_t *pending, lensprof_error *error);

/* The exposure of an earlier frame as it is known now. Errors: ARGUMENT for NULL; NOT_FOUND for a frame that was not
 * added or is no longer kept (options.history); STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_online_exposure_at(const lensprof_online *online,
                                                                           uint64_t number,
                                                                           lensprof_online_exposure *exposure,
                                                                           lensprof_error *error);

/* What is known now; before any frame, what was known to begin with. Errors: ARGUMENT for NULL; STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_online_get(const lensprof_online *online,
                                                                   lensprof_online_result *result,
                                                                   lensprof_error *error);

/* The same as a profile: response, falloff, their covariance, and provenance are set, and one response and one falloff
 * serve all channels; key, levels, gain grid and image circle are left. provenance.not_usable is set unless the falloff
 * is certain. Uses the heap. Errors: ARGUMENT for NULL; MEMORY; STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_online_profile(const lensprof_online *online,
                                                                       lensprof_profile *profile,
                                                                       lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
