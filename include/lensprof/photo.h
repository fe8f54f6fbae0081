/* lensprof/photo.h - pictures, scenes of them, their calibration, and corrected copies: liblensprof-photo.
 *
 * Example: a folder of overlapping photographs, calibrated, and a corrected copy of one of them.
 *
 *     const char *folder = "holiday";
 *     lensprof_scene *scene = NULL;
 *     lensprof_calibration *calibration = NULL;
 *     lensprof_copy copy = {"holiday/img000.png", "corrected.png"};
 *     status = lensprof_scene_open(&folder, 1, NULL, NULL, &scene, &error);
 *     if (status == LENSPROF_OK) status = lensprof_calibrate(scene, NULL, NULL, &calibration, &error);
 *     if (status == LENSPROF_OK) status = lensprof_calibration_save(calibration, "exposures.json", &error);
 *     if (status == LENSPROF_OK) status = lensprof_correct_files(calibration, &copy, 1, NULL, NULL, NULL, &error);
 *     lensprof_calibration_destroy(calibration);
 *     lensprof_scene_destroy(scene);
 *
 * The functions are in a library of their own, liblensprof-photo, which needs liblensprof and the libraries of the
 * picture formats that it was built with. Link it as lensprof::photo or with pkg-config lensprof-photo.
 *
 * Paths are UTF-8 on systems that require it, else bytes as the system takes them. The text of an error names the file
 * and the next step. Files appear complete or not at all. Same input, same bytes, whatever the number of threads.
 *
 * Errors of every function that takes a path: READ for a file that cannot be read, or is not what it should be; WRITE
 * for one that cannot be written; ARGUMENT for NULL, unknown values and inputs that do not go together; CANCELLED if
 * the events cancel; MEMORY. Others are named with the function.
 *
 * Threads: calls on different handles are independent. Calls on one handle must not run at the same time, except those
 * that take it as const. The functions use several threads themselves; events are called on any of them, one at a time.
 */
#ifndef LENSPROF_PHOTO_H
#define LENSPROF_PHOTO_H

#include "apply.h"
#include "fit.h"
#include "profile.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Events: what a call reports while it runs, and the way to end it ------------------------------------------- */

/* The strings are valid during the call. */
typedef struct lensprof_notice {
    uint32_t severity; /* LENSPROF_SEVERITY_WARNING or _NOTE */
    uint32_t reserved; /* 0 */
    const char *item;  /* the file or scene that it is about; may be empty */
    const char *text;  /* a sentence, without the item */
} lensprof_notice;

/* A step such as "matching pictures", the fraction of it that is done (0..1), and details such as ", 3 of 40"; the
 * strings may be empty. A non-zero return value cancels the call. */
typedef int (*lensprof_on_step)(const char *step, double done, const char *detail, void *user);
typedef void (*lensprof_on_notice)(const lensprof_notice *notice, void *user);

typedef struct lensprof_events {
    uint32_t struct_size;
    uint32_t reserved;         /* 0 */
    void *user;                /* passed on */
    lensprof_on_step progress; /* may be NULL */
    lensprof_on_notice notice; /* may be NULL */
} lensprof_events;

/* No functions. */
static inline void lensprof_events_init(lensprof_events *events) { lensprof_init_sized(events, sizeof *events); }

/* ---- Pictures --------------------------------------------------------------------------------------------------- */

/* A picture file, open: PNG, TIFF, JPEG; with the libraries of the build also camera raw files, HEIC, AVIF, WebP and
 * JPEG XL. */
typedef struct lensprof_picture lensprof_picture;

typedef struct lensprof_picture_info {
    uint32_t struct_size;
    uint32_t width, height;  /* as stored, px */
    uint32_t sample, layout; /* lensprof_sample_type, lensprof_layout of what lensprof_picture_read gives */
    uint32_t reduction;      /* of the size asked for: one pixel read is this many pixels of the file wide; 1: none */
    uint32_t read_width, read_height; /* so many are read */
    uint32_t orientation;             /* of EXIF, 1..8: how to rotate the stored pixels; not applied by reading */
    uint64_t icc_bytes;               /* of its colour profile; 0: none */
} lensprof_picture_info;

/* Zero. */
static inline void lensprof_picture_info_init(lensprof_picture_info *info) { lensprof_init_sized(info, sizeof *info); }

/* What a file states about the exposure. Unknown values are LENSPROF_UNKNOWN. */
typedef struct lensprof_picture_metadata {
    uint32_t struct_size;
    uint32_t is_corrected;    /* 1: lensprof, the camera or a program corrected the falloff */
    lensprof_profile_key key; /* camera, lens, focal length, aperture, distance, processing */
    double exposure_time_s, iso, f_number;
    double ev;         /* log2(time iso / 100 / f_number^2); larger is a brighter picture of the same scene */
    char captured[40]; /* date and time with fraction of a second, as in EXIF; empty: unknown */
} lensprof_picture_metadata;

/* Everything unknown. */
LENSPROF_API void lensprof_picture_metadata_init_sized(lensprof_picture_metadata *metadata, size_t size);
static inline void lensprof_picture_metadata_init(lensprof_picture_metadata *metadata) {
    lensprof_picture_metadata_init_sized(metadata, sizeof *metadata);
}

/* Opens the file `path`, or the bytes of a file, which are copied; its format is that of its content. Reads its header
 * and metadata. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_picture_open(const char *path, lensprof_picture **picture,
                                                                     lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_picture_open_memory(const void *data, size_t size,
                                                                            lensprof_picture **picture,
                                                                            lensprof_error *error);

/* Releases it; NULL is allowed. */
LENSPROF_API void lensprof_picture_destroy(lensprof_picture *picture);

/* Sizes and kind of pixels. max_side: 0 = full size, else the picture is reduced by a whole number that keeps its
 * longer side at or above this; see read_width. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_picture_get_info(const lensprof_picture *picture,
                                                                         uint32_t max_side, lensprof_picture_info *info,
                                                                         lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_picture_get_metadata(const lensprof_picture *picture,
                                                                             lensprof_picture_metadata *metadata,
                                                                             lensprof_error *error);

/* The bytes of its ICC profile; none: *count is 0. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_picture_get_icc(const lensprof_picture *picture, void *buffer,
                                                                        size_t capacity, size_t *count,
                                                                        lensprof_error *error);

/* Decodes into `pixels`, whose size, sample type and layout are those of lensprof_picture_get_info for this max_side.
 * SIZE for others. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_picture_read(const lensprof_picture *picture, uint32_t max_side,
                                                                     const lensprof_target *pixels,
                                                                     lensprof_error *error);

typedef struct lensprof_picture_options {
    uint32_t struct_size;
    uint32_t jpeg_quality;        /* 1..100; 0 = that of `like` if it is a JPEG, else 95 */
    const lensprof_picture *like; /* EXIF, XMP, ICC profile, resolution and compression are taken from it; or NULL */
    /* Written as EXIF, over that of `like`: exposure time, ISO (rounded), f-number (that of the key if unknown),
     * captured, and of the key maker, camera, lens, focal length and distance. What is unknown or empty stays. Or NULL.
     */
    const lensprof_picture_metadata *metadata;
} lensprof_picture_options;

/* Without a picture to take them from, and without metadata. */
static inline void lensprof_picture_options_init(lensprof_picture_options *options) {
    lensprof_init_sized(options, sizeof *options);
}

/* Writes the file `path` in the format of its name: .png, .jpg, .tif (or .exr, with OpenEXR). `options` may be NULL.
 * ARGUMENT for pixels that the format does not hold, and for metadata that are neither in range nor unknown. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_picture_write(const char *path, const lensprof_image *pixels,
                                                                      const lensprof_picture_options *options,
                                                                      lensprof_error *error);

/* The same as bytes, in the format of `name`, such as ".png". A query of the size encodes, too: a first buffer of the
 * bytes of the pixels and 64 KiB is almost always enough. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_picture_encode(const char *name, const lensprof_image *pixels,
                                                                       const lensprof_picture_options *options,
                                                                       void *buffer, size_t capacity, size_t *count,
                                                                       lensprof_error *error);

/* ---- Scenes: pictures that show the same, and where ------------------------------------------------------------- */

/* Images with their cameras or matches, found in pictures or read from files. */
typedef struct lensprof_scene lensprof_scene;

typedef struct lensprof_scene_options {
    uint32_t struct_size;
    uint32_t one_lens;      /* 1: all pictures are from one camera and lens, whatever EXIF states */
    const char *images;     /* folder of a reconstruction's pictures; NULL: next to it */
    const char *image_list; /* of a reconstruction: file with names of the images to use, one per line; NULL: all */
} lensprof_scene_options;

/* Defaults: zero. */
static inline void lensprof_scene_options_init(lensprof_scene_options *options) {
    lensprof_init_sized(options, sizeof *options);
}

typedef struct lensprof_scene_info {
    uint32_t struct_size;
    uint32_t images;
    uint32_t left_out;          /* pictures given that are not part of it; see lensprof_scene_left_out_at */
    uint32_t matches;           /* positions at which two images show the same point */
    uint32_t reference;         /* image whose exposure is 0 EV */
    uint32_t is_reconstruction; /* 1: read from a reconstruction: linked by matches, not by its cameras */
    uint32_t links;             /* 0 for a Hugin project, whose images overlap where its cameras do */
} lensprof_scene_info;

/* Zero. */
static inline void lensprof_scene_info_init(lensprof_scene_info *info) { lensprof_init_sized(info, sizeof *info); }

/* Opens pictures and folders of pictures, whose overlaps are found (by OpenCV, UNSUPPORTED without it); or one Hugin
 * project or one reconstruction (COLMAP, OpenSfM, OpenDroneMap, Bundler, AliceVision, OpenMVG). The kind is that of the
 * content. Of several groups of overlapping pictures the largest is the scene. `options` and
 * `events` may be NULL. NOT_USABLE if no two pictures overlap. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_scene_open(const char *const *paths, uint32_t count,
                                                                   const lensprof_scene_options *options,
                                                                   const lensprof_events *events,
                                                                   lensprof_scene **scene, lensprof_error *error);

/* Releases it; NULL is allowed. */
LENSPROF_API void lensprof_scene_destroy(lensprof_scene *scene);

LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_scene_get_info(const lensprof_scene *scene,
                                                                       lensprof_scene_info *info,
                                                                       lensprof_error *error);

/* Image `index`: its camera (any may be NULL), its name, and its file. The texts belong to the scene. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_scene_image_at(const lensprof_scene *scene, uint32_t index,
                                                                       lensprof_camera *camera, const char **name,
                                                                       const char **file, lensprof_error *error);

/* Two images that show the same. Frozen value struct. */
typedef struct lensprof_scene_link {
    uint32_t image[2];     /* indices, the smaller one first */
    uint32_t points;       /* found in both */
    uint32_t fits_cameras; /* 1: the cameras explain them, 0: they do not, or none are known */
} lensprof_scene_link;

/* Link `index`, by images. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_scene_link_at(const lensprof_scene *scene, uint32_t index,
                                                                      lensprof_scene_link *link, lensprof_error *error);

/* Match `index`: at the same point of the scene in two images. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_scene_match_at(const lensprof_scene *scene, uint32_t index,
                                                                       lensprof_match *match, lensprof_error *error);

/* A picture that is not part of the scene, and why. The texts belong to the scene. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_scene_left_out_at(const lensprof_scene *scene, uint32_t index,
                                                                          const char **name, const char **reason,
                                                                          lensprof_error *error);

/* Writes a Hugin project of it, for Hugin and for lensprof_scene_open. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_scene_save(const lensprof_scene *scene, const char *path,
                                                                   lensprof_error *error);

/* ---- Calibration ------------------------------------------------------------------------------------------------ */

/* What was found about the cameras, lenses and exposures of a scene. */
typedef struct lensprof_calibration lensprof_calibration;

#define LENSPROF_CAMERA_AUTO 0xFFFFFFFFu /* the kind of camera that the pictures' EXIF states */

typedef struct lensprof_calibrate_options {
    uint32_t struct_size;
    uint32_t method;                 /* lensprof_method: TRANSFER or RADIANCE */
    uint32_t modes;                  /* of the response; LENSPROF_MODES_AUTO: by held-out error */
    uint32_t loss;                   /* lensprof_loss */
    uint32_t falloff_curves;         /* 1, 3 (one per channel); 0: by held-out error */
    uint32_t gamma_from;             /* lensprof_gamma_from: what determines the common exponent */
    uint32_t free;                   /* LENSPROF_FREE_... of every image; 0: those of the project, or all */
    uint32_t pairs;                  /* number of pairs; 0: by the number of images */
    uint32_t seed;                   /* of the sampling */
    uint32_t max_side;               /* pictures are read reduced to at least this many px; 0: full size */
    uint32_t one_lens;               /* 1: one response and one falloff for all images, whatever EXIF states */
    uint32_t use_stored;             /* 1: the profile stored for the camera and lens in `databases` is the prior */
    double prior_weight;             /* 0: no prior */
    double exif_sigma;               /* standard error of exposures in EXIF, EV; 0: not used; negative: by EXIF */
    const char *const *databases;    /* profile databases for priors and sensor sizes */
    uint32_t database_count;         /* 0: the user's own and the installed one */
    uint32_t reserved;               /* 0 */
    uint32_t camera_kind;            /* lensprof_camera_kind that the prior describes, or LENSPROF_CAMERA_AUTO */
    uint32_t sampling;               /* lensprof_sampling: BALANCED or PAPER */
    double huber_levels;             /* of the loss HUBER: sigma in levels of 255 */
    const char *reference;           /* name or number of the image whose exposure is 0 EV; NULL: chosen */
    const lensprof_profile_key *key; /* of the profile: replaces what EXIF states where it is known; NULL: EXIF. Its
                                        processing is known unless it is JPEG */
} lensprof_calibrate_options;

/* Defaults: TRANSFER, automatic modes, ROBUST, by held-out error, AUTO, 0, 0 pairs, seed 1, 800 px, 0, 1, 1, -1, none,
 * AUTO, BALANCED, 5 levels, NULL, NULL: those of `lensprof build`. */
LENSPROF_API void lensprof_calibrate_options_init_sized(lensprof_calibrate_options *options, size_t size);
static inline void lensprof_calibrate_options_init(lensprof_calibrate_options *options) {
    lensprof_calibrate_options_init_sized(options, sizeof *options);
}

/* Samples the pictures of a scene, or takes its matches, and fits. A fit that ran returns OK even if the result is
 * poor: see `usable` of its result and the findings. `options` and `events` may be NULL. NO_OVERLAP, NO_SAMPLES and
 * NOT_USABLE if the pictures do not suffice for a fit. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibrate(const lensprof_scene *scene,
                                                                  const lensprof_calibrate_options *options,
                                                                  const lensprof_events *events,
                                                                  lensprof_calibration **calibration,
                                                                  lensprof_error *error);

/* Opens a result that was written before: an exposures.json, whose pictures are in the folder `images` (NULL: where it
 * states), or a Hugin project. It has exposures, and corrects; it has no fit, profiles and findings. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibration_open(const char *path, const char *images,
                                                                         lensprof_calibration **calibration,
                                                                         lensprof_error *error);

/* Releases it; NULL is allowed. */
LENSPROF_API void lensprof_calibration_destroy(lensprof_calibration *calibration);

/* The fit, with the result of each lens setting and camera (fit.h); NULL for an opened result. It belongs to the
 * calibration. Its images are those of the scene. */
LENSPROF_API const lensprof_fit *lensprof_calibration_get_fit(const lensprof_calibration *calibration);

typedef struct lensprof_calibration_info {
    uint32_t struct_size;
    uint32_t images;    /* of lensprof_calibration_image_at and _exposure_at */
    uint32_t profiles;  /* lens settings, of lensprof_calibration_profile_at; 0 for an opened result */
    uint32_t findings;  /* of lensprof_calibration_finding_at; 0 for an opened result */
    uint32_t usable;    /* 1: a fit whose profile may be stored; 0 for an opened result */
    uint32_t equalizes; /* 1: corrects the pictures, as every opened result does */
} lensprof_calibration_info;

/* Zero. */
static inline void lensprof_calibration_info_init(lensprof_calibration_info *info) {
    lensprof_init_sized(info, sizeof *info);
}

LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibration_get_info(const lensprof_calibration *calibration,
                                                                             lensprof_calibration_info *info,
                                                                             lensprof_error *error);

/* Name and file of an image; either may be NULL. The texts belong to the calibration. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibration_image_at(const lensprof_calibration *calibration,
                                                                             uint32_t index, const char **name,
                                                                             const char **file, lensprof_error *error);

/* Exposure of an image relative to the reference, and its standard errors: EV, and of red, green and blue, relative.
 * `errors` has room for 4 values or is NULL; they are NaN if unknown. An image that was left out has an ev of NaN. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibration_exposure_at(const lensprof_calibration *calibration,
                                                                                uint32_t image,
                                                                                lensprof_exposure *exposure,
                                                                                double *errors, lensprof_error *error);

/* The profile of a lens setting: falloff and response with covariance, key of EXIF, provenance. NOT_FOUND if none of
 * the setting's images agrees with the others. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibration_profile_at(const lensprof_calibration *calibration,
                                                                               uint32_t index,
                                                                               lensprof_profile *profile,
                                                                               lensprof_error *error);

/* Finding `index` on the result, most severe first, with names of files in its text. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibration_finding_at(const lensprof_calibration *calibration,
                                                                               uint32_t index,
                                                                               lensprof_finding *finding,
                                                                               lensprof_error *error);

/* Stores the profiles of all usable lens settings in a database, made if missing; NULL: the user's own. *stored, unless
 * NULL, receives their number. NOT_USABLE if none is usable; ARGUMENT if EXIF names neither camera nor lens: then take
 * the profile, set its key and use store.h. Errors of store.h. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibration_store(lensprof_calibration *calibration,
                                                                          const char *database, uint32_t *stored,
                                                                          lensprof_error *error);

/* Writes the result in the format of the name: .pto a Hugin project; exposures*.json the file of exposures; other names
 * a profile of the reference's lens setting, in one of the formats of formats.h by its name, such as profile.json or
 * pcalib.txt. NOT_USABLE for a result that neither is usable nor equalizes the pictures. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibration_save(lensprof_calibration *calibration,
                                                                         const char *path, lensprof_error *error);

/* ---- Corrected copies ------------------------------------------------------------------------------------------- */

/* One copy. The format is that of the name: .png, .jpg, .tif, .exr. */
typedef struct lensprof_copy {
    const char *source, *target;
} lensprof_copy;

typedef enum lensprof_copy_exposure {
    LENSPROF_COPY_EXPOSURE_MEAN = 0, /* all copies as if taken at the mean exposure and white balance of the scene */
    LENSPROF_COPY_EXPOSURE_KEEP = 1, /* each at its own: the falloff alone is corrected */
    LENSPROF_COPY_EXPOSURE_REFERENCE = 2 /* that of the reference */
} lensprof_copy_exposure;

typedef struct lensprof_correct_options {
    uint32_t struct_size;
    uint32_t exposure;            /* lensprof_copy_exposure; without a calibration KEEP */
    uint32_t linear;              /* 1: irradiance as 32 bit float */
    uint32_t overwrite;           /* 1: replace existing files even if they were made from other pictures */
    uint32_t threads;             /* 0: all cores */
    uint32_t force_falloff;       /* 1: correct also pictures whose falloff was corrected before */
    double strength;              /* of the falloff correction; 1 */
    const char *const *databases; /* without a calibration: profile databases, searched in order */
    uint32_t database_count;      /* 0: the user's own and the installed one */
    uint32_t reserved;            /* 0 */
    double gain_cap;              /* largest gain of the falloff correction, 1 or more; 0: unlimited */
    uint32_t simulate;            /* 1: add the falloff instead of correcting it */
    uint32_t dither;              /* 1: ordered dither instead of rounding in 8 bit pictures, against banding */
    uint32_t chroma;              /* 1: correct only the colour of the falloff, and keep luminance (apply.h) */
    uint32_t reserved2;           /* 0 */
} lensprof_correct_options;

/* Defaults: MEAN, 0, 0, 0, 0, 1, none, 0, 0, 0, 0. */
LENSPROF_API void lensprof_correct_options_init_sized(lensprof_correct_options *options, size_t size);
static inline void lensprof_correct_options_init(lensprof_correct_options *options) {
    lensprof_correct_options_init_sized(options, sizeof *options);
}

/* Writes corrected copies of pictures of the calibrated scene; without a calibration (NULL) with the profile that the
 * databases have for the camera, lens and setting that EXIF states. Pictures are decoded in strips and in parallel;
 * copies appear in the order of the list. Metadata are kept, and copies are marked. The first picture that cannot be
 * corrected ends the call with its error: nothing is written if that is known before the work. *written, unless NULL,
 * receives the number of copies, also with the error of such a picture. `options` and `events` may be NULL. NOT_FOUND
 * for a picture that is not part of the result, or has no profile; NOT_USABLE for a result that does not equalize the
 * pictures. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_correct_files(const lensprof_calibration *calibration,
                                                                      const lensprof_copy *copies, uint32_t count,
                                                                      const lensprof_correct_options *options,
                                                                      const lensprof_events *events, uint32_t *written,
                                                                      lensprof_error *error);

/* ---- The whole job of a folder ---------------------------------------------------------------------------------- */

typedef struct lensprof_folder_options {
    uint32_t struct_size;
    uint32_t one_lens;            /* 1: all pictures of a panorama are from one camera and lens, whatever EXIF states */
    uint32_t no_store;            /* 1: profiles are not stored */
    uint32_t overwrite;           /* 1: replace files in the output folder that this function did not write */
    uint32_t threads;             /* that correct pictures; 0: all cores */
    uint32_t database_count;      /* 0: the user's own and the installed one */
    const char *const *databases; /* searched in order; profiles are stored in the first */
} lensprof_folder_options;

/* Defaults: zero. */
static inline void lensprof_folder_options_init(lensprof_folder_options *options) {
    lensprof_init_sized(options, sizeof *options);
}

typedef struct lensprof_folder_result {
    uint32_t struct_size;
    uint32_t found;     /* pictures */
    uint32_t panoramas; /* groups of overlapping pictures; */
    uint32_t fitted;    /* of these, fitted by this call: the others were, by an earlier one */
    uint32_t corrected; /* pictures with a corrected copy; */
    uint32_t written;   /* of these, by this call */
    uint32_t left_out;  /* pictures without one; calibrate.json has the reasons */
    uint32_t reserved;  /* 0 */
} lensprof_folder_result;

/* Zero. */
static inline void lensprof_folder_result_init(lensprof_folder_result *result) {
    lensprof_init_sized(result, sizeof *result);
}

/* Finds all panoramas in pictures and folders (with subfolders), fits them, stores their profiles, and corrects them;
 * other pictures are corrected by the databases. The folder `output` receives a copy of each under its own name, per
 * panorama a project and a mosaic, contact sheets, and calibrate.json with all numbers and reasons. A second call does
 * what is missing or has changed, also after a cancellation. Originals are never modified. A panorama that somebody has
 * edited in Hugin in between is corrected as its project states, with a notice. `options`, `events` and `result` may be
 * NULL. A picture or panorama that fails does not stop the others. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_calibrate_folder(
    const char *const *paths, uint32_t count, const char *output, const lensprof_folder_options *options,
    const lensprof_events *events, lensprof_folder_result *result, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
