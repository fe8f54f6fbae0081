/* lensprof/apply.h - correct (or simulate) falloff, exposure and white balance in pixels.
 *
 * Example: a picture corrected row by row, in place.
 *
 *     static uint64_t memory[1 << 14];
 *     const lensprof_plan *plan;
 *     lensprof_apply_options options;
 *     lensprof_apply_options_init(&options); // 8 bit RGB
 *     options.frame_width = picture.width, options.frame_height = picture.height;
 *     status = lensprof_apply_options_set_profile(&options, &profile);
 *     if (status == LENSPROF_OK) status = lensprof_plan_init(memory, sizeof memory, &options, &plan, &error);
 *     for (uint32_t y = 0; y < picture.height && status == LENSPROF_OK; y++) {
 *         lensprof_target row = picture;
 *         row.data = (uint8_t *)picture.data + (ptrdiff_t)y * picture.row_bytes, row.height = 1;
 *         status = lensprof_apply(plan, NULL, &row, 0, y);
 *     }
 *
 *   correct:  B' = f( g(B) / (M e w) * e' w' )                 Goldman & Chen 2005, equation 16
 *   simulate: B' = f( g(B) * M e w / (e' w') )                 the inverse, up to clipping
 *
 * B = (sample - black) / (white - black), and back for B', if levels are given.
 *
 * M: the falloff, times the gain grid if there is one. e, w: exposure and white balance of the picture; e', w': the
 * wanted ones.
 * A plan is prepared once per picture, in memory that the caller provides, and then applied to any tile. The kernels
 * use SSE4.1, AVX2, AVX-512 or NEON if the processor has it; all of them give the same bytes. No heap, no I/O. On a
 * microcontroller, where the kernel works on one sample at a time, lensprof_apply takes at most 2.5 KiB of stack and
 * lensprof_plan_init 2 KiB (docs/firmware.md). Threads: a plan is immutable after init and may be used by several
 * threads on different tiles. */
#ifndef LENSPROF_APPLY_H
#define LENSPROF_APPLY_H

#include "profile.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum lensprof_sample_type {
    LENSPROF_SAMPLE_U8 = 0,  /* 0..255 = 0..1 */
    LENSPROF_SAMPLE_U16 = 1, /* 0..65535 = 0..1, native byte order, 2-byte aligned */
    LENSPROF_SAMPLE_F32 = 2, /* 0..1, 4-byte aligned */
    LENSPROF_SAMPLE_F16 = 3  /* IEEE binary16, 0..1, 2-byte aligned */
} lensprof_sample_type;

typedef enum lensprof_layout {
    LENSPROF_LAYOUT_GREY = 0,
    LENSPROF_LAYOUT_GREY_ALPHA = 1,
    LENSPROF_LAYOUT_RGB = 2,
    LENSPROF_LAYOUT_RGBA = 3,
    LENSPROF_LAYOUT_BGR = 4,
    LENSPROF_LAYOUT_BGRA = 5,
    LENSPROF_LAYOUT_PLANAR = 6, /* red, green and blue each in an image of layout GREY: lensprof_apply_planar */
    LENSPROF_LAYOUT_RGGB = 7,   /* mosaics, one sample per pixel, named by the colours of the frame's pixels (0, 0), */
    LENSPROF_LAYOUT_GRBG = 8,   /* (1, 0), (0, 1), (1, 1) */
    LENSPROF_LAYOUT_GBRG = 9,
    LENSPROF_LAYOUT_BGGR = 10
} lensprof_layout;

/* A view of interleaved pixels owned by the caller, which are only read. Frozen value struct. */
typedef struct lensprof_image {
    const void *data;    /* upper left sample of the view */
    ptrdiff_t row_bytes; /* from one row to the next; negative for bottom-up images */
    uint32_t width, height;
    uint32_t sample; /* lensprof_sample_type */
    uint32_t layout; /* lensprof_layout */
} lensprof_image;

/* The same of pixels that are written. Frozen value struct. */
typedef struct lensprof_target {
    void *data;
    ptrdiff_t row_bytes;
    uint32_t width, height;
    uint32_t sample, layout;
} lensprof_target;

/* Samples per pixel (1..4; planes and mosaics 1) and colour channels (1 or 3) of a layout; 0 if it is unknown. */
LENSPROF_API uint32_t lensprof_layout_samples(uint32_t layout);
LENSPROF_API uint32_t lensprof_layout_channels(uint32_t layout);

/* Bytes of one sample (1, 2 or 4); 0 if the type is unknown. */
LENSPROF_API uint32_t lensprof_sample_type_bytes(uint32_t type);

/* LENSPROF_OK if data is aligned and not NULL, the sizes are in 1..2^20, and |row_bytes| holds a row and is at most
 * 2^28. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_image_validate(const lensprof_image *image);

typedef enum lensprof_direction {
    LENSPROF_DIRECTION_CORRECT = 0,
    LENSPROF_DIRECTION_SIMULATE = 1
} lensprof_direction;

typedef enum lensprof_encoding {
    LENSPROF_ENCODING_RESPONSE = 0, /* grey values, encoded by the response; output by output_response if given */
    LENSPROF_ENCODING_LINEAR = 1    /* irradiance; 1 is what the response maps to 1 */
} lensprof_encoding;

/* Treatment of nearly saturated pixels, whose true colour is unknown. */
typedef enum lensprof_saturated {
    LENSPROF_SATURATED_NEUTRAL = 0, /* towards white, all channels get the gain of the largest channel, so clouds keep
                                       no cast. Changes only pixels with a channel above 0.9 and none below 0.6, and no
                                       mosaics, which have one channel per pixel. Linear output with levels, mosaics
                                       too: see below */
    LENSPROF_SATURATED_AS_VALUE = 1 /* no special treatment */
} lensprof_saturated;

typedef struct lensprof_apply_options {
    uint32_t struct_size;
    uint32_t direction;                    /* lensprof_direction */
    uint32_t input, output;                /* lensprof_encoding */
    uint32_t frame_width, frame_height;    /* the full frame that contains the tiles, px */
    uint32_t source_sample, source_layout; /* pixel format of the input */
    uint32_t target_sample;                /* sample type of the output; the layout is that of the input */
    uint32_t saturated; /* lensprof_saturated; NEUTRAL applies if direction is CORRECT and both input and output are
                           encoded, or linear with levels */
    uint32_t responses, vignettings;       /* 1 for all channels, or 3: red, green, blue; grey uses green */
    const lensprof_response *response;     /* read during plan init only; pass a linear one if nothing is encoded */
    const lensprof_vignetting *vignetting; /* read during plan init only. Single precision represents M to about
                                              1e-7 (1 + |k1| + |k2| + |k3|) */
    lensprof_exposure source;              /* exposure and white balance of the picture */
    lensprof_exposure target;              /* wanted exposure and white balance; equal to source = keep */
    const lensprof_gain_grid *grid;        /* multiplied by the vignetting; NULL = none; read during plan init only */
    double strength;                       /* 0..1: M becomes 1 + strength (M - 1); 0 leaves the falloff alone */
    double gain_cap;   /* lower limit of M is 1 / gain_cap, 1..1e6, which limits the gain in corners; 0 = no cap */
    uint32_t dither;   /* 1: ordered 8 x 8 dither instead of rounding, for U8 output; 0: none */
    uint32_t reserved; /* 0 */
    const void *blob;  /* replaces response, vignetting and grid, which must be NULL: a profile blob (profile.h), at any
                          address, read during plan init only; its counts replace responses and vignettings */
    size_t blob_bytes;
    const lensprof_response *output_response; /* encodes the output instead of the response, for pictures of several
                                                 cameras side by side; NULL = `response`, or the blob's. Read during
                                                 plan init only */
    uint32_t output_responses;                /* 1 for all channels, or 3; 0 without output_response */
    uint32_t reserved2;                       /* 0 */
    uint32_t chroma;                          /* 1: correct only the colour of the falloff; 0: all of it. See below */
    uint32_t reserved3;                       /* 0 */
    const lensprof_levels *levels;            /* of the input; NULL = none; read during plan init only. Levels of a
                                                 blob count for both if `levels` and `output_levels` are NULL */
    const lensprof_levels *output_levels; /* of the output; `levels` again: black is put back; NULL: the output is B' */
    const lensprof_image_circle *image_circle; /* outside of it M is 1; NULL = none, or the blob's, with which it must
                                                  be NULL; read during plan init only */
} lensprof_apply_options;

/* chroma: M of a channel is replaced by M / Y, where Y = 0.2126 M_red + 0.7152 M_green + 0.0722 M_blue is the luminance
 * that falls on this place of a neutral scene, by the weights of ITU-R BT.709. Neutral grey becomes neutral and keeps
 * its linear luminance exactly; a colour changes it by at most max |M / Y - 1| of the channels. gain_cap limits Y / M.
 * A model whose channels have one falloff, grey pixels too, keep theirs.
 *
 * Levels: a linear response then counts as linear encoding, which is not clipped at black, so that noise about black
 * keeps its mean. Integer output is clipped at the white level of the output. If `saturated` is NEUTRAL, linear output
 * of three channels, mosaics too, is clipped where a saturated sample of the channel with the least ratio of exposures
 * and white balances lies, if that is below white: otherwise clipped highlights would have the colour of the others.
 * Integer plans (fixed.h) are UNSUPPORTED with an image circle. */

/* Correct, encoded input and output, u8 RGB in and out, exposures 0 EV, strength 1. The rest is zero; the caller must
 * set it. */
LENSPROF_API void lensprof_apply_options_init_sized(lensprof_apply_options *options, size_t size);
static inline void lensprof_apply_options_init(lensprof_apply_options *options) {
    lensprof_apply_options_init_sized(options, sizeof *options);
}

/* Uses the model of a profile: responses, vignettings, gain grid, levels (of input and output) and image circle point
 * into *profile, which must not change until the plan is made; the blob is cleared. All other options stay.
 * Errors: ARGUMENT; STRUCT_SIZE of either; UNSUPPORTED if the profile has levels or an image circle and options of an
 * older version have no room for them. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_apply_options_set_profile(lensprof_apply_options *options,
                                                                                  const lensprof_profile *profile);

typedef struct lensprof_plan lensprof_plan;

/* Bytes of memory that lensprof_plan_init needs for these options; 0 if a field they depend on is invalid. */
LENSPROF_API size_t lensprof_plan_bytes(const lensprof_apply_options *options);

/* Prepares a plan in memory[size] (8-byte aligned, owned by the caller, must outlive the plan). There is nothing to
 * release. A plan made from a blob equals one made from the profile unpacked from it. Takes well under a millisecond.
 * Errors: ARGUMENT for NULL or unknown values; STRUCT_SIZE; SIZE for a zero frame; CAPACITY for too little or unaligned
 * memory; those of the model's validate functions (three vignettings must share one centre); EXPOSURE unless target
 * over source is within 1e-12..1e12; for a blob CORRUPT and LAYOUT as from lensprof_profile_unpack. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_plan_init(void *memory, size_t size,
                                                                  const lensprof_apply_options *options,
                                                                  const lensprof_plan **plan, lensprof_error *error);

/* Applies the plan to a tile whose upper left pixel is pixel (x0, y0) of the frame. `target` has the size of the tile.
 * source NULL: in place, the pixels of `target` are read and replaced. It may also be the same memory as `source` (same
 * sample type and row_bytes). Otherwise the byte ranges from the first to the last sample of the two must not overlap
 * (so they cannot be two tiles side by side in one buffer). Alpha samples are copied (converted to the target type).
 * Integer output is rounded to nearest and clipped; linear float output is not clipped. NaN in float input gives NaN. A
 * saturated sample stays saturated if light is added; if light is removed, it becomes grey (see lensprof_saturated).
 * Errors: SIZE or ARGUMENT for views that do not fit the plan or the frame; nothing is written then. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_apply(const lensprof_plan *plan, const lensprof_image *source,
                                                              const lensprof_target *target, uint32_t x0, uint32_t y0);

/* The same for three planes of layout GREY (red, green, blue) of one size; the layout of the plan is PLANAR. source
 * NULL: in place. Each target may be the same memory as its own source; no other two of the six may overlap. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_apply_planar(const lensprof_plan *plan,
                                                                     const lensprof_image source[3],
                                                                     const lensprof_target target[3], uint32_t x0,
                                                                     uint32_t y0);

#ifdef __cplusplus
}
#endif
#endif
