/* lensprof/deflicker.h - exposures of the frames of a stationary camera, and the smooth curve that levels them.
 *
 * Example: the exposure that each of three frames should have had.
 *
 *     lensprof_deflicker *deflicker = NULL;
 *     lensprof_deflicker_options options;
 *     lensprof_exposure wanted[3];
 *     lensprof_deflicker_options_init(&options);
 *     status = lensprof_deflicker_create(&options, &deflicker, &error);
 *     for (int i = 0; status == LENSPROF_OK && i < 3; i++)
 *         status = lensprof_deflicker_add(deflicker, &images[i], NULL, &error);
 *     if (status == LENSPROF_OK) status = lensprof_deflicker_measure(deflicker, NULL, &error);
 *     if (status == LENSPROF_OK) status = lensprof_deflicker_curve(deflicker, NULL, wanted, 3, NULL, &error);
 *     lensprof_deflicker_destroy(deflicker);
 *
 * Method: a frame is reduced to the mean irradiance of up to 96 x 96 cells. The ratio of two frames, per channel, is
 * the mode of the ratios of their cells: what moves (clouds, people, water) and what is saturated or dark in one of
 * them has no influence. Cells that often disagree count less. A slow movement of the camera, or a bump, is a shift
 * that is measured along with the ratio. Every frame is compared with the one before it, and every 4th, 16th, 64th, ...
 * with the one as many frames before it, so that errors do not add up. The exposures of all frames are the least
 * squares solution of these ratios. A frame that agrees with none before it begins a new segment (a cut), unless the
 * frames after it agree again with those before it; then it is left out.
 *
 * Two effects change a part of the frame only. Lamps flicker from line to line where the shutter is fast: on request,
 * the ratio of each row of cells is compared with that of the frame. The falloff depends on the aperture: where the
 * aperture changes, the difference of the falloffs is measured as exp2(q1 r^2 + q2 r^4). Both are gain grids.
 *
 * A stationary camera does not show light and exposure apart: `ev` contains both. The wanted curve decides what
 * stays: a smooth curve through them, or through what remains without the settings of the camera.
 *
 * Memory: about 2 MiB, and 400 bytes per frame, 1.3 KiB with rows. Threads: calls on different objects are independent;
 * those on one object must not run at the same time. The pictures are only read, during the call. Same input, same
 * bytes.
 */
#ifndef LENSPROF_DEFLICKER_H
#define LENSPROF_DEFLICKER_H

#include "apply.h"
#include "model.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_DEFLICKER_FRAMES 4194304 /* maximum number of frames */

/* Frames of one camera, and their exposures. */
typedef struct lensprof_deflicker lensprof_deflicker;

typedef struct lensprof_deflicker_options {
    uint32_t struct_size;
    uint32_t responses;                /* 1 for all channels, or 3; ignored without response */
    const lensprof_response *response; /* array of `responses`, copied; NULL = the transfer function of sRGB for
                                          integer samples, and linear for float samples */
    uint32_t rows;                     /* 1: measure the flicker of lines, too */
    uint32_t reserved;                 /* 0 */
    double region[4]; /* left, top, right, bottom: what is compared, as shares of the frame, 0..1; all 0 = all of it */
} lensprof_deflicker_options;

/* No response, the whole frame. */
LENSPROF_API void lensprof_deflicker_options_init_sized(lensprof_deflicker_options *options, size_t size);
static inline void lensprof_deflicker_options_init(lensprof_deflicker_options *options) {
    lensprof_deflicker_options_init_sized(options, sizeof *options);
}

/* What is known of a frame. */
typedef struct lensprof_deflicker_facts {
    uint32_t struct_size;
    uint32_t reserved;  /* 0 */
    double seconds;     /* time of the frame, which never decreases; NaN for all frames: their numbers */
    double settings_ev; /* what the settings of the camera add to its exposure (lensprof_settings_ev); NaN =
                           unknown */
    double f_number;    /* aperture; NaN = unknown */
} lensprof_deflicker_facts;

/* Nothing is known. */
LENSPROF_API void lensprof_deflicker_facts_init_sized(lensprof_deflicker_facts *facts, size_t size);
static inline void lensprof_deflicker_facts_init(lensprof_deflicker_facts *facts) {
    lensprof_deflicker_facts_init_sized(facts, sizeof *facts);
}

/* What became of a frame. */
typedef enum lensprof_deflicker_state {
    LENSPROF_FRAME_LEVELLED = 0,
    LENSPROF_FRAME_DARK = 1,     /* no information: black or nearly so; left as it is */
    LENSPROF_FRAME_WHITE = 2,    /* no information: saturated or nearly so; left as it is */
    LENSPROF_FRAME_DISAGREES = 3 /* with the frames before and after it, which agree; left as it is */
} lensprof_deflicker_state;

/* One frame. */
typedef struct lensprof_deflicker_frame {
    uint32_t struct_size;
    uint32_t state;     /* lensprof_deflicker_state */
    uint32_t segment;   /* number of cuts before it */
    uint32_t repeats;   /* 1: its cells are those of the frame before it */
    double seconds;     /* as given, or its number */
    double settings_ev; /* as given */
    lensprof_exposure
        exposure;       /* light and exposure relative to the first frame of its segment; 0 EV unless levelled */
    double ev_sigma;    /* standard error of its ratio to the frame before it, EV; 0 for the first */
    double agreeing;    /* share of the cells that agree with the frame before it */
    double shift[2];    /* of the scene since the first frame of its segment, right and down, as shares of the
                           longer side */
    double white_share; /* of its samples that are saturated */
    double dark_share;  /* of its cells without information because they are dark */
} lensprof_deflicker_frame;

/* All zero. */
static inline void lensprof_deflicker_frame_init(lensprof_deflicker_frame *frame) {
    lensprof_init_sized(frame, sizeof *frame);
}

typedef struct lensprof_deflicker_result {
    uint32_t struct_size;
    uint32_t frames;   /* added, of which */
    uint32_t levelled; /* these have an exposure */
    uint32_t segments; /* 1 + number of cuts; 0 without levelled frames */
    uint32_t repeated; /* frames that repeat the one before them */
    uint32_t moving;   /* 1: the camera moves too far from frame to frame for this method; see `motion` */
    double motion;     /* median shift from frame to frame, share of the longer side */
    double unlinked;   /* share of the frames that agree with none of the frames before them */
    double flicker;    /* median difference of a frame from the mean of its two neighbours, EV */
    double tone_error; /* by how much ratios of dark and bright cells differ, as a share of the ratio, rms: the response
                          is not that of the frames; 0 where no two frames differ by .15 EV */
    double known_range; /* largest minus smallest settings_ev, EV; NaN if any is unknown */
} lensprof_deflicker_result;

/* All zero. */
static inline void lensprof_deflicker_result_init(lensprof_deflicker_result *result) {
    lensprof_init_sized(result, sizeof *result);
}

/* What the frames should have. */
typedef enum lensprof_deflicker_to {
    LENSPROF_TO_SMOOTH =
        0, /* a smooth curve through the exposures: slow changes stay; of fewer than 5 frames the mean */
    LENSPROF_TO_LIGHT = 1, /* the light, as a smooth curve, at one exposure of the camera: the largest that brightens
                              no frame by more than the flicker. Needs settings_ev of all frames */
    LENSPROF_TO_MEAN = 2,  /* the geometric mean of all */
    LENSPROF_TO_FRAME = 3, /* that of one frame; of other segments the mean */
    LENSPROF_TO_CURVE = 4 /* given values: `exposure.ev` that each frame should have, relative to the first frame of its
                             segment */
} lensprof_deflicker_to;

typedef struct lensprof_deflicker_target {
    uint32_t struct_size;
    uint32_t to;         /* lensprof_deflicker_to */
    uint32_t frame;      /* of TO_FRAME: index of a levelled frame */
    uint32_t reserved;   /* 0 */
    double window_s;     /* of SMOOTH and LIGHT: seconds (frames, if no times are given) before and after a frame that
                            shape its curve; 0 = the one, of at least 30 frames, that best predicts frames left out */
    const double *curve; /* of TO_CURVE: an EV per frame */
} lensprof_deflicker_target;

/* A smooth curve, with the best window. */
LENSPROF_API void lensprof_deflicker_target_init_sized(lensprof_deflicker_target *target, size_t size);
static inline void lensprof_deflicker_target_init(lensprof_deflicker_target *target) {
    lensprof_deflicker_target_init_sized(target, sizeof *target);
}

/* Makes an object without frames in *deflicker, to be released with lensprof_deflicker_destroy. `options` NULL = the
 * defaults. Errors: ARGUMENT for NULL and unusable options; STRUCT_SIZE; RESPONSE for an invalid response; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_deflicker_create(const lensprof_deflicker_options *options,
                                                                         lensprof_deflicker **deflicker,
                                                                         lensprof_error *error);

/* Releases it; NULL is allowed. */
LENSPROF_API void lensprof_deflicker_destroy(lensprof_deflicker *deflicker);

/* Adds the next frame: any view of U8, U16 or F32 in grey, RGB or BGR, at full size or reduced, of at least 24 pixels,
 * all of one size, sample type and layout; `facts` NULL = nothing is known. Errors: ARGUMENT for NULL, times that
 * decrease or are given for some frames only, facts that are infinite, more than LENSPROF_DEFLICKER_FRAMES frames;
 * STRUCT_SIZE; SIZE for frames of different sizes or kinds; UNSUPPORTED for F16, mosaics and planar frames; those of
 * lensprof_image_validate; MEMORY. The frame is then not added. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_deflicker_add(lensprof_deflicker *deflicker,
                                                                      const lensprof_image *frame,
                                                                      const lensprof_deflicker_facts *facts,
                                                                      lensprof_error *error);

/* Determines the exposures of all frames added so far; more may be added later, and all must then be measured again.
 * `result` may be NULL. Errors: ARGUMENT for NULL; STRUCT_SIZE; NO_SAMPLES if no frame has information; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_deflicker_measure(lensprof_deflicker *deflicker,
                                                                          lensprof_deflicker_result *result,
                                                                          lensprof_error *error);

/* Frame `index` in the order of adding, as last measured. Errors: ARGUMENT for NULL, without a measurement, and out of
 * range; STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_deflicker_frame_at(const lensprof_deflicker *deflicker,
                                                                           uint32_t index,
                                                                           lensprof_deflicker_frame *frame,
                                                                           lensprof_error *error);

/* The exposure that each frame should have: correct frame i from its `exposure` to exposures[i]
 * (lensprof_apply_options) to level it. Of a frame that is not levelled both are equal. `count` is the number of frames
 * measured. `target` NULL = the default. *window (may be NULL) receives the window that was used, s; 0 without one.
 * Errors: ARGUMENT for NULL, without a measurement, another `count`, a target that is not levelled, out of range or not
 * finite, and LIGHT where settings are unknown; STRUCT_SIZE; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_deflicker_curve(const lensprof_deflicker *deflicker,
                                                                        const lensprof_deflicker_target *target,
                                                                        lensprof_exposure *exposures, uint32_t count,
                                                                        double *window, lensprof_error *error);

/* What else differs between frame `index` and the others, as the attenuation of its light over the frame: flicker of
 * lines, and the falloff at its aperture relative to that at the aperture of most frames. No grid
 * (lensprof_gain_grid_init) if neither was measured, or the frame is not levelled. Errors: as
 * lensprof_deflicker_frame_at. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_deflicker_shading(const lensprof_deflicker *deflicker,
                                                                          uint32_t index, lensprof_gain_grid *shading,
                                                                          lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
