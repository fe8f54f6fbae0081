/* lensprof/hugin.h - Hugin projects and point files, from and to memory. No function here opens a file.
 *
 * Example: the field of view of the first image of a project.
 *
 *     static const char project[] = "i w640 h480 f0 v50 y20 n\"a.jpg\"\ni w640 h480 f0 v50 y0 n\"b.jpg\"\n";
 *     lensprof_pto *pto = NULL;
 *     lensprof_pto_image first;
 *     lensprof_pto_image_init(&first);
 *     status = lensprof_pto_read(project, strlen(project), &pto, &error);
 *     if (status == LENSPROF_OK) status = lensprof_pto_get_image(pto, 0, &first, &error);
 *     if (status == LENSPROF_OK) printf("%.1f degrees\n", first.camera.hfov_deg);
 *     lensprof_pto_destroy(pto);
 *
 * Threads: a handle belongs to one thread at a time. */
#ifndef LENSPROF_HUGIN_H
#define LENSPROF_HUGIN_H

#include "fit.h"
#include "geometry.h"
#include "sample.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Hugin project (.pto) ------------------------------------------------------------------------------- */

typedef struct lensprof_pto lensprof_pto;

/* One `i` line with its links resolved, in the conventions of lensprof. */
typedef struct lensprof_pto_image {
    uint32_t struct_size;
    uint32_t response_type; /* Rt: 0 EMoR, 1 linear */
    lensprof_camera camera;
    lensprof_exposure exposure;     /* ev = -Eev (a larger Eev in Hugin means less light); white balance Er, 1, Eb */
    lensprof_vignetting vignetting; /* Vb/Va, Vc/Va, Vd/Va; Vx, Vy in half diagonals; no falloff if Vm disables it */
    double emor[5];                 /* Ra..Re */
    uint32_t free;        /* LENSPROF_FREE_* requested by `v` lines for this image or the one it is linked to */
    uint32_t response_of; /* index of the image at the end of the link; own index if not linked */
    uint32_t vignetting_of, center_of, ev_of, red_of, blue_of;
    int32_t crop[4];        /* left, top, right, bottom (right and bottom exclusive); the frame if there is no crop */
    uint32_t crop_circular; /* 1: only the circle about the centre of the crop that touches its nearer sides is used */
    uint32_t left_out;      /* 1: the result in the project excludes this image, whose exposure is unknown */
    uint32_t of_crop;       /* 1: the crop is a picture of its own, because the file has other images of the project in
                               other crops, or because it is a circle off the middle of the file. Then `vignetting` is
                               that of the crop as a frame: about its middle, r = 1 in its corners */
} lensprof_pto_image;

/* All zero, to be filled by lensprof_pto_get_image. */
static inline void lensprof_pto_image_init(lensprof_pto_image *image) { lensprof_init_sized(image, sizeof *image); }

/* Parses a project. Creates *pto, which the caller must destroy.
 * Errors (the text names the line): ARGUMENT; SIZE over 64 MiB; SYNTAX; VARIABLE for an unknown name or image number on
 * a `v` line; UNSUPPORTED for a lens type that is not in geometry.h, a response type above 1, or over 100000 images;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_read(const void *data, size_t size, lensprof_pto **pto,
                                                                 lensprof_error *error);
LENSPROF_API void lensprof_pto_destroy(lensprof_pto *pto); /* NULL is allowed */

LENSPROF_API uint32_t lensprof_pto_image_count(const lensprof_pto *pto);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_get_image(const lensprof_pto *pto, uint32_t index,
                                                                      lensprof_pto_image *image, lensprof_error *error);

/* The response of an image as evaluated by Hugin: linear, or Ra..Re made monotone by a running maximum (then a
 * TABLE). */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_get_response(const lensprof_pto *pto, uint32_t index,
                                                                         lensprof_response *response,
                                                                         lensprof_error *error);

/* File name of an image as written in the project (relative to its folder). name[capacity] and *count (bytes) as in
 * base.h. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_get_name(const lensprof_pto *pto, uint32_t index,
                                                                     char *name, size_t capacity, size_t *count,
                                                                     lensprof_error *error);

/* Changes the file name of an image, for a project that is written to another folder. Error: ARGUMENT for an empty name
 * or one with quotes or control characters. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_set_name(lensprof_pto *pto, uint32_t index,
                                                                     const char *name, lensprof_error *error);

/* Draws the mask of places where pairs may be taken from an image, at the size of a (possibly reduced) view of its
 * frame: 1 inside the crop and outside all mask polygons, otherwise 0. Mask types: 0 exclude; 1 include (the place is
 * removed from all other images, so no pair is left there); 2/3 the same for the stack (images with linked j);
 * 4 exclude for the lens (linked v). */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_draw_mask(const lensprof_pto *pto, uint32_t index,
                                                                      uint8_t *mask, uint32_t width, uint32_t height,
                                                                      ptrdiff_t row_bytes, lensprof_error *error);

/* Writes a result into the project: exposures[image_count], one response and one vignetting, which every image
 * receives; links are kept. A response other than EMoR with at most 5 modes is written as its least squares projection
 * on Hugin's 5 modes. Exposures and white balances are taken relative to those of image `reference`, whose Eev, Er and
 * Eb stay. An image whose ev is NaN was left out of the fit (lensprof_fit_result): its exposure stays, and a comment
 * line
 * (`#-lensprof left_out 3 7`), which other programs ignore, lists it. Errors: ARGUMENT; those of the model's validate
 * functions; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_set_result(
    lensprof_pto *pto, const lensprof_response *response, const lensprof_vignetting *vignetting,
    const lensprof_exposure *exposures, uint32_t image_count, uint32_t reference, lensprof_error *error);

/* Writes a falloff per lens setting: the first image with setting[i] = s receives vignetting[s], and the other images
 * of this setting are linked to it. All setting[image_count] must be below setting_count. Errors: ARGUMENT; those of
 * lensprof_vignetting_validate; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_set_settings(lensprof_pto *pto, const uint32_t *setting,
                                                                         uint32_t image_count,
                                                                         const lensprof_vignetting *vignetting,
                                                                         uint32_t setting_count, lensprof_error *error);

/* Writes a response per camera: the first image with camera[i] = k receives response[k], in the form used by
 * lensprof_pto_set_result, and the other images of this camera are linked to it. Call it after that function. All
 * camera[image_count] must be below camera_count. Errors: ARGUMENT; those of lensprof_response_validate; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_set_cameras(lensprof_pto *pto, const uint32_t *camera,
                                                                        uint32_t image_count,
                                                                        const lensprof_response *response,
                                                                        uint32_t camera_count, lensprof_error *error);

/* The project as text. Everything that was read stays unchanged, except what was set. data[capacity] and *count (bytes)
 * as in base.h. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_write(const lensprof_pto *pto, void *data, size_t capacity,
                                                                  size_t *count, lensprof_error *error);

/* ---- Hugin point files (vig_optimize -i / -w) ------------------------------------------------------------- */

/* 16 numbers per line: image1 image2 x1 y1 x2 y2 R1 G1 B1 R2 G2 B2 0 r1 r2 0. Grey values up to 0.25 outside 0..1,
 * which result from vig_optimize's interpolation at edges, are clamped. pairs[capacity] and *count as in base.h. Error:
 * SYNTAX (the text names the line). */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_points_read(const void *data, size_t size, lensprof_pair *pairs,
                                                                    uint32_t capacity, uint32_t *count,
                                                                    lensprof_error *error);

/* Writes the same format. cameras[camera_count] give the frame sizes for the radius columns. Output as in base.h. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_points_write(const lensprof_pair *pairs, uint32_t pair_count,
                                                                     const lensprof_camera *cameras,
                                                                     uint32_t camera_count, void *data, size_t capacity,
                                                                     size_t *count, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
