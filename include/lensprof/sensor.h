/* lensprof/sensor.h - samples as a raw sensor delivers them, corrected in integers by a grid of gains.
 *
 * Example: packed rows of 10 bits of a sensor that bins 2 x 2, corrected in place; the profile has its levels.
 *
 *     static uint32_t memory[1024];
 *     static uint8_t sensor[480 * 640 * 5 / 4];
 *     const lensprof_packed_target tile = {sensor, 640 * 5 / 4, 640, 480};
 *     const lensprof_sensor_plan *plan;
 *     lensprof_apply_options options;
 *     lensprof_readout readout;
 *     lensprof_apply_options_init(&options), lensprof_readout_init(&readout);
 *     options.frame_width = 1280, options.frame_height = 960, readout.step = 2;
 *     status = lensprof_readout_set_mosaic(&readout, "GRBG");
 *     if (status == LENSPROF_OK) status = lensprof_apply_options_set_profile(&options, &profile);
 *     if (status == LENSPROF_OK)
 *         status = lensprof_sensor_plan_init(memory, sizeof memory, &options, &readout, &plan, &error);
 *     if (status == LENSPROF_OK)
 *         status = lensprof_sensor_apply_packed(plan, LENSPROF_PACKING_RAW10, NULL, &tile, 0, 0);
 *
 *   B' = black' + (B - black) G(x, y)        clipped to 0 and white'
 *
 * G is bilinear between nodes that divide the frame evenly, as in the shading correction of image signal processors:
 * along a row, a gain is the one before plus a constant. The nodes hold all that apply.h does in linear light: falloff,
 * gain grid, exposure and white balance. A grid is less exact than the polynomial; lensprof_sensor_plan_error returns
 * by how much (docs/sensor.md has a table).
 *
 * Preparing a plan takes floating point. A plan contains no address, so it may be made on a PC and lie in flash; the
 * rest is integers, with results that are equal on all machines. A sample takes one multiplication of 32 by 32 bits.
 * No heap, no I/O. Threads: a plan is immutable after init and may be used by several threads on different tiles.
 *
 * The result of a sample depends on its position alone, so a frame may be processed in rows or tiles of any shape and
 * order, in place, or from one buffer to another while the next row arrives. */
#ifndef LENSPROF_SENSOR_H
#define LENSPROF_SENSOR_H

#include "packed.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_SENSOR_PLANES 4
#define LENSPROF_SENSOR_GRID_SIDE 33

/* Direction in which a sensor reads its pixels. */
typedef enum lensprof_flip {
    LENSPROF_FLIP_NONE = 0,
    LENSPROF_FLIP_HORIZONTAL = 1, /* rows from right to left */
    LENSPROF_FLIP_VERTICAL = 2,   /* the lowest row first */
    LENSPROF_FLIP_BOTH = 3        /* the sensor is mounted upside down */
} lensprof_flip;

/* Codes without light and at saturation, per plane of the mosaic. Frozen value struct. */
typedef struct lensprof_sensor_levels {
    double black[LENSPROF_SENSOR_PLANES]; /* may have fractions; -32768..65535 */
    double white;                         /* 1..65535, and more than each black by at least 1 */
} lensprof_sensor_levels;

/* What a sensor reads of its frame. The window is x..x + width step - 1, y..y + height step - 1 of the frame, whichever
 * direction it is read in. */
typedef struct lensprof_readout {
    uint32_t struct_size;
    uint32_t x, y;          /* upper left pixel of the frame in the window */
    uint32_t width, height; /* samples of a row, and rows; 0 = to the end of the frame */
    uint32_t step;          /* pixels of the frame per sample, 1..16: above 1 if it bins or skips pixels. The
                               position of a sample is the mean of its step x step pixels */
    uint32_t flip;          /* lensprof_flip */
    uint32_t side;          /* of the mosaic's pattern, in samples: 1, 2 or 4 */
    uint8_t plane[16];      /* plane 0..3 of sample (i, j) of the pattern: plane[j * side + i] */
    uint8_t channel[4];     /* channel of the profile for each plane: 0 red, 1 green, 2 blue */
    uint32_t columns, rows; /* of the grid: 2..33 each */
    const float *gains;     /* a grid of the caller, which multiplies the profile's: [plane][row][column] over the
                               frame, node (0, 0) at its first pixel, the last at its last; each within
                               0.001..1000. NULL = none; read during plan init only */
    const lensprof_sensor_levels *levels;        /* of the input; NULL = those of the options or the blob, if any */
    const lensprof_sensor_levels *output_levels; /* NULL = `levels`: black is put back; those of
                                                    the options if `levels` is NULL, too */
} lensprof_readout;

/* The whole frame, one plane (channel green), a grid of 17 x 13. */
LENSPROF_API void lensprof_readout_init_sized(lensprof_readout *readout, size_t size);
static inline void lensprof_readout_init(lensprof_readout *readout) {
    lensprof_readout_init_sized(readout, sizeof *readout);
}

/* Sets side, plane and channel by the colours of the samples as they are read, row by row: 1, 4 or 16 letters of R, G,
 * g, B, I (infrared), W (clear). Each letter that occurs is a plane, in this order; at most four do. Planes use the
 * profile's channel of the same colour; all but R and B use green. If flips or the window change the pattern, state
 * the changed one, as drivers do.
 *     "G" monochrome, "RGGB", "RGgB" the greens of red and blue rows apart, "RRGGRRGGGGBBGGBB" Quad Bayer,
 *     "BGRGGIGIRGBGGIGI" RGBIR
 * Errors: ARGUMENT for NULL, other letters and too many planes; SIZE for another number of letters; STRUCT_SIZE. The
 * readout is unchanged then. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_readout_set_mosaic(lensprof_readout *readout,
                                                                           const char *colors);

typedef struct lensprof_sensor_plan lensprof_sensor_plan;

/* Bytes of memory that lensprof_sensor_plan_init needs: about 200, and 4 per node and plane. 0 if the readout is
 * invalid. */
LENSPROF_API size_t lensprof_sensor_plan_bytes(const lensprof_readout *readout);

/* Prepares a plan in memory[size] (4-byte aligned, owned by the caller, must outlive the plan). Of the options it uses
 * the frame, the model or blob, the exposures, direction, saturated, strength, gain_cap, chroma and the levels, unless
 * the readout has its own. Levels of the options are shares of 65535. If `saturated` is NEUTRAL and there are two
 * planes or more, output is clipped at the level of a saturated sample of the plane and node with the smallest gain, if
 * that is below white, so that clipped highlights keep no cast. Errors: as lensprof_plan_init; SIZE for sides above
 * 65535, a window outside of the frame, another grid, and cells of less than a pattern or more than 1024 samples of a
 * colour; ARGUMENT for levels out of range; VIGNETTING for gains that are not within 0.001..1000; UNSUPPORTED for a
 * response that is not linear (state LINEAR input and output of linear samples), an image circle, dither, and gains of
 * 4096 or more in all. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_plan_init(void *memory, size_t size,
                                                                         const lensprof_apply_options *options,
                                                                         const lensprof_readout *readout,
                                                                         const lensprof_sensor_plan **plan,
                                                                         lensprof_error *error);

/* The largest relative error of the gains of a plan's nodes, interpolated, against the options' own: over the readout,
 * at about 8 x 8 positions per cell. The options and readout are those from which the plan was made. Errors: as
 * lensprof_sensor_plan_init; ARGUMENT for a plan of another readout. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_plan_error(const lensprof_sensor_plan *plan,
                                                                          const lensprof_apply_options *options,
                                                                          const lensprof_readout *readout,
                                                                          double *largest);

/* Opens a plan that was prepared elsewhere: the bytes of its memory, copied to data[size] (4-byte aligned; may be
 * read-only), on a machine of the same byte order. Errors: ARGUMENT for NULL or unaligned data; CAPACITY for fewer
 * bytes than the plan has; LAYOUT for another version; CORRUPT for damage, detected by the CRC-32 or by values that no
 * plan has. A plan that opens is safe to apply, whatever the origin of its bytes. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_plan_open(const void *data, size_t size,
                                                                         const lensprof_sensor_plan **plan);

/* A plan between two that differ in their gains only, such as those of two colour temperatures: gains are (1 - s) a +
 * s b with s = share / 65536. In memory[size] as above, of the size of plan a; in integers. Errors: ARGUMENT for NULL,
 * plans of different readouts, grids or levels, and a share above 65536; CAPACITY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_plan_mix(void *memory, size_t size,
                                                                        const lensprof_sensor_plan *a,
                                                                        const lensprof_sensor_plan *b, uint32_t share,
                                                                        const lensprof_sensor_plan **plan);

/* The share of b for light of `kelvin`, if a and b are for light of a_kelvin and b_kelvin: linear in mired, 10^6 / K,
 * as lookups of profiles are; 0 or 65536 outside. In integers; temperatures count as 1..100000 K. */
LENSPROF_API uint32_t lensprof_mired_share(uint32_t a_kelvin, uint32_t b_kelvin, uint32_t kelvin);

/* Applies a plan to a tile of U16 samples, layout GREY, whose first sample is sample (x0, y0) of the readout. source
 * NULL: in place; otherwise, and the errors, as for lensprof_apply. Takes at most 512 bytes of stack. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_apply(const lensprof_sensor_plan *plan,
                                                                     const lensprof_image *source,
                                                                     const lensprof_target *target, uint32_t x0,
                                                                     uint32_t y0);

/* The same for packed rows, as lensprof_fixed_apply_packed. Takes 384 bytes of stack more. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_apply_packed(const lensprof_sensor_plan *plan,
                                                                            uint32_t packing,
                                                                            const lensprof_packed_image *source,
                                                                            const lensprof_packed_target *target,
                                                                            uint32_t x0, uint32_t y0);

/* A flat field captured on a device: sums of the samples of an evenly lit picture, from which gains follow. It has no
 * address: a device without floating point copies its memory to a PC of the same byte order, which opens it. Threads:
 * one at a time. */
typedef struct lensprof_sensor_flat lensprof_sensor_flat;

/* Bytes of memory that lensprof_sensor_flat_init needs: about 200, and 8 per node and plane. 0 if the readout is
 * invalid. */
LENSPROF_API size_t lensprof_sensor_flat_bytes(const lensprof_readout *readout);

/* Begins a flat field in memory[size] (8-byte aligned, owned by the caller). Of the readout it uses all but gains and
 * output_levels; levels NULL: black 0, white 65535. Errors: as lensprof_sensor_plan_init. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_flat_init(void *memory, size_t size,
                                                                         uint32_t frame_width, uint32_t frame_height,
                                                                         const lensprof_readout *readout,
                                                                         lensprof_sensor_flat **flat,
                                                                         lensprof_error *error);

/* Adds a tile of U16 samples, layout GREY, whose first sample is sample (x0, y0) of the readout, in integers. All
 * samples must be added equally often, up to 256 times (cells of more than 2^22 samples: fewer): rows of one or more
 * pictures of the same light, as they arrive. Errors: as lensprof_sensor_apply; CAPACITY for more pictures. Nothing is
 * added then. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_flat_add(lensprof_sensor_flat *flat,
                                                                        const lensprof_image *samples, uint32_t x0,
                                                                        uint32_t y0);

/* Opens a copy of the memory of a flat field in data[size] (8-byte aligned). Errors: as lensprof_sensor_plan_open, but
 * there is no CRC: CORRUPT for numbers that no flat field has, and damaged sums are not detected. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_flat_open(void *data, size_t size,
                                                                         lensprof_sensor_flat **flat);

/* Bytes of work memory (8-byte aligned) that lensprof_sensor_flat_gains needs; 0 for NULL. */
LENSPROF_API size_t lensprof_sensor_flat_work_bytes(const lensprof_sensor_flat *flat);

/* The gains that make the flat field even, for lensprof_readout: gains[plane][row][column], 1 where a plane is
 * brightest. The light at the nodes is the bilinear surface nearest to the samples (least squares, by conjugate
 * gradients in double precision). Errors: ARGUMENT for NULL; CAPACITY for too little work memory; NO_SAMPLES if samples
 * were not added equally often, more than 0.1 % of them are saturated, the brightest node of a plane has less than
 * 1/64 of white less black, another less than 1/1000 of the brightest, or the window leaves nodes without samples;
 * gains are not written then. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_sensor_flat_gains(const lensprof_sensor_flat *flat, void *work,
                                                                          size_t work_bytes, float *gains,
                                                                          lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
