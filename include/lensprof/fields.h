/* lensprof/fields.h - the shading that many pictures of different scenes have in common: microscopes, slides,
 * inspection.
 *
 * Example: the shading of three pictures that share neither scene nor overlap.
 *
 *     lensprof_fields *fields = NULL;
 *     lensprof_fields_options options;
 *     lensprof_fields_result result;
 *     lensprof_fields_options_init(&options), lensprof_fields_result_init(&result);
 *     options.width = images[0].width, options.height = images[0].height;
 *     status = lensprof_fields_create(&options, &fields, &error);
 *     for (int i = 0; status == LENSPROF_OK && i < 3; i++)
 *         status = lensprof_fields_add(fields, &images[i], NULL, 0, &error);
 *     if (status == LENSPROF_OK) status = lensprof_fields_fit(fields, &error);
 *     if (status == LENSPROF_OK) status = lensprof_fields_get(fields, &result, &error);
 *     if (status == LENSPROF_OK) printf("%.2f of the light in the first corner\n", result.shading.attenuation[0]);
 *     lensprof_fields_destroy(fields);
 *
 * Method `fields`: the linear value of a cell of picture n is
 *     B_n(x) = b + a_n S(x) C_n(x),
 * with the level a_n of the picture, the shading S, the content C_n of its scene, and one offset b (pedestal). The
 * logarithms of all contents are taken to have one density, a mixture of normal distributions that is estimated along
 * with the rest: an even background, if there is one, dominates the fit, and things that are darker or brighter have a
 * small influence; without background, the mean of the logarithms remains. Maximum likelihood by expectation
 * maximisation, from several beginnings. ln S is a smooth surface, not radial; its smoothness is the one that predicts
 * held-out pictures best. Pictures of different levels determine the offset.
 *
 * Only the means of up to 64 x 64 cells are kept of each picture.
 *
 * Threads: calls on different objects are independent; those on one object must not run at the same time. The pictures
 * are only read, during the call. Neither the order of the pictures nor the number of threads changes a byte of the
 * shading.
 */
#ifndef LENSPROF_FIELDS_H
#define LENSPROF_FIELDS_H

#include "apply.h"
#include "profile.h"
#include "reason.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_FIELDS_IMAGES 16384 /* maximum number of pictures */

/* Pictures of one camera and light, reduced to cells, and what was fitted to them. */
typedef struct lensprof_fields lensprof_fields;

typedef struct lensprof_fields_options {
    uint32_t struct_size;
    uint32_t channels;      /* 1 or 3; three channels require colour views */
    uint32_t width, height; /* frame of all pictures, px */
    uint32_t given_offset;  /* 1: the offset is `offset`; 0: it is estimated */
    uint32_t responses;     /* 1 for all channels, or 3 */
    uint32_t threads;       /* maximum number, including the caller's; 0 = one per core */
    uint32_t reserved;      /* 0 */
    double offset[3];       /* given offset per channel, in units of the samples, 0..1 for integers; the fit takes at
                               most what nearly all cells exceed, and the result states it */
    double white; /* samples at or above it are saturated; 0 = the end of the range of integer samples, whether
                     or not it is that of their type; no limit for float samples */
    const lensprof_response *response; /* array of `responses`, copied; NULL = linear */
    lensprof_progress progress;        /* of lensprof_fields_fit, or NULL; the fraction never decreases */
    void *progress_user;
} lensprof_fields_options;

/* 3 channels, no frame (the caller must set it), estimated offset, linear, threads on all cores. */
LENSPROF_API void lensprof_fields_options_init_sized(lensprof_fields_options *options, size_t size);
static inline void lensprof_fields_options_init(lensprof_fields_options *options) {
    lensprof_fields_options_init_sized(options, sizeof *options);
}

/* One picture. */
typedef struct lensprof_fields_image {
    uint32_t struct_size;
    uint32_t used;     /* 1: takes part */
    uint32_t same_as;  /* if not used: index of the picture whose cells it repeats; otherwise its own index */
    uint32_t reserved; /* 0 */
    double level[3]; /* light of the background in the middle of the frame per channel, in units of the samples; NaN if
                        not used */
    double white_share; /* of the cells: with saturated samples, left out */
    double pixel_share; /* of the frame: pixels that mask, alpha and NaN leave */
} lensprof_fields_image;

/* All zero. */
static inline void lensprof_fields_image_init(lensprof_fields_image *image) {
    lensprof_init_sized(image, sizeof *image);
}

/* A smoothness that was tried. Frozen value struct. */
typedef struct lensprof_fields_smoothness {
    uint32_t order;    /* of the derivatives that are kept small: 2 or 3 */
    uint32_t reserved; /* 0 */
    double weight;     /* of their mean square over the frame, in half diagonals, relative to the squared residual */
    double rms;        /* residual of held-out pictures, share of the light */
} lensprof_fields_smoothness;

/* One channel. Frozen value struct. */
typedef struct lensprof_fields_channel {
    double offset;         /* b, in units of the samples */
    double offset_sigma;   /* standard error, by the scatter of the pictures or of fits without some of them, whichever
                              is larger; of a given offset, of what the pictures would have given; INFINITY: they do
                              not determine it */
    uint32_t offset_found; /* 1: estimated; 0: given, or not determined and taken as 0 */
    uint32_t smoothness;   /* index of the one chosen, of those tried */
    double shading_error;  /* standard error of S, rms over the frame, share: of chance, by fits without each of ten
                              groups of pictures, of the smoothness, and of what no smooth surface follows */
    double heldout_rms;    /* residual of held-out pictures, share of the light, with the shading */
    double even_rms;       /* the same with S = 1 */
    double pattern;        /* rms of fine detail that all pictures have in common, in the shading or beyond it, share of
                              the light: dust, edges, or one scene */
    double pattern_share;  /* its share of the variance of a cell */
    double background_share; /* share of the cells in the narrowest component of the content */
    double background_sigma; /* standard deviation of ln C in it */
    uint32_t iterations;
    uint32_t converged; /* 1: the last step changed S by less than 0.0005 % */
} lensprof_fields_channel;

typedef struct lensprof_fields_result {
    uint32_t struct_size;
    uint32_t usable;   /* 1, or 0 as the findings state */
    uint32_t findings; /* number of lensprof_fields_finding_at: refusals, then warnings, then notes; */
    uint32_t passed;   /* after them, the rules that hold */
    uint32_t images;   /* pictures added, of which */
    uint32_t used;     /* these took part; */
    uint32_t repeated; /* the cells of these equal those of another picture; */
    uint32_t black;    /* these show no light or only one value; */
    uint32_t white;    /* fewer than half of the cells of these are usable */
    uint32_t channels;
    uint32_t columns, rows; /* cells */
    uint32_t smoothnesses;  /* tried: number of lensprof_fields_smoothness_at */
    uint32_t reserved;      /* 0 */
    double unseen_share;    /* of the cells: usable in no picture */
    double white_share;     /* of the cells of the pictures used: with saturated samples */
    lensprof_fields_channel channel[3];
    lensprof_gain_grid shading; /* S, 1 in the middle of the frame */
} lensprof_fields_result;

/* An empty result. */
static inline void lensprof_fields_result_init(lensprof_fields_result *result) {
    lensprof_init_sized(result, sizeof *result);
}

/* Makes an object without pictures in *fields, to be released with lensprof_fields_destroy. Errors: ARGUMENT or SIZE
 * for unusable options; STRUCT_SIZE; RESPONSE for an invalid response; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fields_create(const lensprof_fields_options *options,
                                                                      lensprof_fields **fields, lensprof_error *error);

/* Releases it; NULL is allowed. */
LENSPROF_API void lensprof_fields_destroy(lensprof_fields *fields);

/* Adds a picture: its view, which has the size of the frame or is reduced by one whole number in both directions, and a
 * mask of one byte per view pixel, 0 = excluded; NULL = without. In layouts with alpha, alpha below half = excluded. So
 * are pixels with a sample that is not finite. Errors: ARGUMENT for NULL, grey views with three channels, and more than
 * LENSPROF_FIELDS_IMAGES pictures; SIZE for a view that does not fit the frame; those of lensprof_image_validate;
 * MEMORY. The picture is then not added. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fields_add(lensprof_fields *fields, const lensprof_image *view,
                                                                   const uint8_t *mask, ptrdiff_t mask_row_bytes,
                                                                   lensprof_error *error);

/* Fits the shading to all pictures. A fit that ran returns OK even if the result is poor: see `usable`. More pictures
 * may be added later, and fitted again. Errors: ARGUMENT for NULL; NO_SAMPLES if no picture shows light; CANCELLED;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fields_fit(lensprof_fields *fields, lensprof_error *error);

/* What the last fit found; picture `index` in the order of adding; smoothness `index` in a channel; finding `index`: of
 * `findings`, then of `passed`. The structs must be initialised. Errors: ARGUMENT for NULL, numbers out of range, and
 * without a fit; STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fields_get(const lensprof_fields *fields,
                                                                   lensprof_fields_result *result,
                                                                   lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fields_image_at(const lensprof_fields *fields, uint32_t index,
                                                                        lensprof_fields_image *image,
                                                                        lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fields_smoothness_at(const lensprof_fields *fields,
                                                                             uint32_t channel, uint32_t index,
                                                                             lensprof_fields_smoothness *smoothness,
                                                                             lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fields_finding_at(const lensprof_fields *fields, uint32_t index,
                                                                          lensprof_finding *finding,
                                                                          lensprof_error *error);

/* Makes the profile of the last fit in an initialised *profile: the responses of the options (linear by default), no
 * falloff, the shading as its gain grid, and the offsets of linear pictures with samples within 0..1 as its black
 * level; method "fields"; `pairs` counts cells. The key stays. Errors: as lensprof_fields_get; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fields_profile(const lensprof_fields *fields,
                                                                       lensprof_profile *profile,
                                                                       lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
