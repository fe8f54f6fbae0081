/* lensprof/exposures.h - files of measured exposures (exposures.json), from and to memory. No function here opens a
 * file. docs/reconstructions.md has the members of the file.
 *
 * Example: the file of one picture, with a lens that loses 35 % of the light in the corners.
 *
 *     static char file[20000];
 *     size_t size;
 *     lensprof_exposures_info info;
 *     lensprof_exposures_camera camera;
 *     lensprof_exposures_lens lens;
 *     lensprof_exposures_image shot;
 *     lensprof_exposures_info_init(&info), lensprof_exposures_camera_init(&camera);
 *     lensprof_exposures_lens_init(&lens), lensprof_exposures_image_init(&shot);
 *     info.camera_count = info.lens_count = info.image_count = 1;
 *     lens.vignetting[0].k[0] = -0.35;
 *     shot.name = "a.jpg", shot.width = 640, shot.height = 480;
 *     status = lensprof_exposures_write(&info, &camera, &lens, &shot, file, sizeof file, &size, &error);
 *     if (status == LENSPROF_OK) fwrite(file, 1, size, stdout);
 *
 * Threads: a handle is not changed after it was read; any thread may use it. */
#ifndef LENSPROF_EXPOSURES_H
#define LENSPROF_EXPOSURES_H

#include "model.h"
#include "profile.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A file that was read. Texts of the structs below are UTF-8. Those that the library gives belong to the handle; those
 * that it receives are not kept. */
typedef struct lensprof_exposures lensprof_exposures;

/* The file as a whole. */
typedef struct lensprof_exposures_info {
    uint32_t struct_size;
    uint32_t camera_count, lens_count, image_count; /* at least 1 each */
    uint32_t reference;   /* image whose exposure is 0 EV: the exposures of the others are relative to it */
    uint32_t reserved;    /* 0 */
    const char *software; /* program that wrote the file, or NULL; NULL to write: this version of lensprof */
} lensprof_exposures_info;

/* A camera. */
typedef struct lensprof_exposures_camera {
    uint32_t struct_size;
    uint32_t reserved;          /* 0 */
    const char *name;           /* such as "Canon EOS 6D"; NULL: not stated */
    lensprof_response response; /* of red, green and blue */
} lensprof_exposures_camera;

/* A lens setting of a camera. */
typedef struct lensprof_exposures_lens {
    uint32_t struct_size;
    uint32_t camera;                   /* index */
    const char *name;                  /* such as "50 mm, f/2.8"; NULL: not stated */
    uint32_t vignettings;              /* 1, or 3: red, green, blue */
    uint32_t reserved;                 /* 0 */
    lensprof_vignetting vignetting[3]; /* with the same centre */
} lensprof_exposures_lens;

/* An image. */
typedef struct lensprof_exposures_image {
    uint32_t struct_size;
    uint32_t lens;                 /* index */
    uint32_t width, height;        /* of the picture as stored, 1..1048576 px */
    const char *name;              /* of which no two images have the same */
    const char *file;              /* path of the picture, relative to the folder of the file; NULL: not stated */
    lensprof_exposure exposure;    /* ev NaN: it has no result, and the white balance has no meaning */
    double ev_sigma;               /* standard error of ev, EV, or LENSPROF_UNKNOWN */
    double white_balance_sigma[3]; /* standard errors of the factors, or LENSPROF_UNKNOWN */
} lensprof_exposures_image;

/* No cameras, lenses and images; reference 0. */
static inline void lensprof_exposures_info_init(lensprof_exposures_info *info) {
    lensprof_init_sized(info, sizeof *info);
}

/* A linear response. */
LENSPROF_API void lensprof_exposures_camera_init_sized(lensprof_exposures_camera *camera, size_t size);
static inline void lensprof_exposures_camera_init(lensprof_exposures_camera *camera) {
    lensprof_exposures_camera_init_sized(camera, sizeof *camera);
}

/* Camera 0, one curve, no falloff. */
LENSPROF_API void lensprof_exposures_lens_init_sized(lensprof_exposures_lens *lens, size_t size);
static inline void lensprof_exposures_lens_init(lensprof_exposures_lens *lens) {
    lensprof_exposures_lens_init_sized(lens, sizeof *lens);
}

/* Lens 0; 0 EV and 1, 1, 1, with unknown standard errors; no name and size. */
LENSPROF_API void lensprof_exposures_image_init_sized(lensprof_exposures_image *image, size_t size);
static inline void lensprof_exposures_image_init(lensprof_exposures_image *image) {
    lensprof_exposures_image_init_sized(image, sizeof *image);
}

/* Reads a file. Creates *exposures, which the caller must destroy. The members that follow from others (`mean`,
 * `light_of_level`) may be missing; only their form is checked.
 * Errors (the text names the member or the line): ARGUMENT; SIZE over 64 MiB, or over 4 million values; SYNTAX;
 * UNSUPPORTED for another version of the format; RESPONSE, VIGNETTING and EXPOSURE for values that are not valid;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_exposures_read(const void *data, size_t size,
                                                                       lensprof_exposures **exposures,
                                                                       lensprof_error *error);
LENSPROF_API void lensprof_exposures_destroy(lensprof_exposures *exposures); /* NULL is allowed */

/* What the file holds. The structs must be initialised. Errors: ARGUMENT for NULL and an index out of range;
 * STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_exposures_get_info(const lensprof_exposures *exposures,
                                                                           lensprof_exposures_info *info,
                                                                           lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_exposures_get_camera(const lensprof_exposures *exposures,
                                                                             uint32_t index,
                                                                             lensprof_exposures_camera *camera,
                                                                             lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_exposures_get_lens(const lensprof_exposures *exposures,
                                                                           uint32_t index,
                                                                           lensprof_exposures_lens *lens,
                                                                           lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_exposures_get_image(const lensprof_exposures *exposures,
                                                                            uint32_t index,
                                                                            lensprof_exposures_image *image,
                                                                            lensprof_error *error);

/* Writes cameras[info->camera_count], lenses[info->lens_count] and images[info->image_count] as a file, with the
 * members that follow from them: the mean of the exposures (lensprof_exposure_mean) and the light of 256 grey levels
 * per camera. Numbers read back the same; bytes of names that are not UTF-8 become U+FFFD. Output as in base.h. Errors
 * (the text names the image, or the number of the camera or lens): ARGUMENT for NULL, counts, indices, sizes and names
 * that are not valid, and if no image has an exposure; STRUCT_SIZE; SIZE for a file of over 64 MiB; RESPONSE;
 * VIGNETTING; EXPOSURE; CAPACITY; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_exposures_write(const lensprof_exposures_info *info,
                                                                        const lensprof_exposures_camera *cameras,
                                                                        const lensprof_exposures_lens *lenses,
                                                                        const lensprof_exposures_image *images,
                                                                        void *data, size_t capacity, size_t *count,
                                                                        lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
