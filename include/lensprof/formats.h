/* lensprof/formats.h - other tools' files, from and to memory: Hugin projects and point files, Lensfun databases.
 *
 * No function here opens a file. Threads: a handle belongs to one thread at a time. */
#ifndef LENSPROF_FORMATS_H
#define LENSPROF_FORMATS_H

#include "fit.h"
#include "geometry.h"
#include "profile.h"
#include "sample.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Hugin project (.pto) ------------------------------------------------------------------------------- */

typedef struct lensprof_pto lensprof_pto;

/* One `i` line with its links resolved, in lensprof's conventions. Frozen value struct. */
typedef struct lensprof_pto_image {
    lensprof_camera camera;
    lensprof_exposure exposure;     /* ev = -Eev (Hugin's larger Eev means less light); white balance Er, 1, Eb */
    lensprof_vignetting vignetting; /* Vb/Va, Vc/Va, Vd/Va; Vx, Vy in half diagonals; none where Vm asks for none */
    double emor[5];                 /* Ra..Re */
    uint32_t response_type;         /* Rt: 0 EMoR, 1 linear */
    uint32_t free; /* LENSPROF_FREE_* that the `v` lines ask for on this image or on the one it is linked to */
    uint32_t response_of;           /* index of the image at the end of the link, own index when not linked */
    uint32_t vignetting_of, center_of, ev_of, red_of, blue_of;
    int32_t crop[4];                /* left, top, right, bottom (right and bottom exclusive), the frame when none */
    uint32_t crop_circular; /* 1 when only the circle about the crop's middle that touches its nearer sides counts */
    uint32_t reserved;              /* 0 */
} lensprof_pto_image;

/* Parses a project. *pto is created and must be destroyed by the caller.
 * Errors (the text names the line): ARGUMENT; SIZE over 64 MiB; SYNTAX; VARIABLE for an unknown name or image number on
 * a `v` line; UNSUPPORTED for a lens type that is not in geometry.h, a response type above 1, or over 100000 images;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_read(const char *text, size_t bytes, lensprof_pto **pto,
                                                                 lensprof_error *error);
LENSPROF_API void lensprof_pto_destroy(lensprof_pto *pto); /* NULL is allowed */

LENSPROF_API uint32_t lensprof_pto_image_count(const lensprof_pto *pto);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_get_image(const lensprof_pto *pto, uint32_t index,
                                                                      lensprof_pto_image *image);

/* The response of an image as Hugin evaluates it: linear, or Ra..Re made monotone by a running maximum (then a
 * TABLE). */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_get_response(const lensprof_pto *pto, uint32_t index,
                                                                         lensprof_response *response);

/* File name of an image as written (relative to the project's folder). With capacity 0 or too small: CAPACITY.
 * *needed (may be NULL) receives the bytes in every case, here with the terminator. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_get_name(const lensprof_pto *pto, uint32_t index,
                                                                     char *name, size_t capacity, size_t *needed);

/* Changes the file name of an image, for a project that is written to another folder. ARGUMENT for an empty name or one
 * with quotes or control characters. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_set_name(lensprof_pto *pto, uint32_t index,
                                                                     const char *name);

/* Draws where pairs may be taken from an image, at the size of a (possibly reduced) view of its frame: 1 inside the
 * crop and outside all mask polygons, else 0. Mask types: 0 exclude, 1 include (which takes the place from all other
 * images, so that no pair is left there), 2/3 the same for the stack (images with linked j), 4 exclude for the lens
 * (linked v). */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_draw_mask(const lensprof_pto *pto, uint32_t index,
                                                                      uint8_t *mask, uint32_t width, uint32_t height,
                                                                      ptrdiff_t row_bytes);

/* Puts a result into the project: exposures[count of images], one response, one vignetting. A response other than
 * EMoR with at most 5 modes is written as its least squares projection on Hugin's 5 modes. Every image receives the
 * response and vignetting of the fit; links are kept. exposures and white balance are taken relative to those of image
 * `reference`, whose Eev, Er and Eb stay. Errors: ARGUMENT, what the model's validate functions say, MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status
lensprof_pto_set_result(lensprof_pto *pto, const lensprof_response *response, const lensprof_vignetting *vignetting,
                        const lensprof_exposure *exposures, uint32_t count, uint32_t reference);

/* The project as text: everything that was read, unchanged but for what was set. Returns CAPACITY when the buffer is
 * too small (capacity 0 asks for the size); *needed receives the bytes without terminator, which is added where there
 * is room. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_pto_write(const lensprof_pto *pto, char *text, size_t capacity,
                                                                  size_t *needed);

/* ---- Hugin point files (vig_optimize -i / -w) ------------------------------------------------------------- */

/* 16 numbers a line: image1 image2 x1 y1 x2 y2 R1 G1 B1 R2 G2 B2 0 r1 r2 0. Grey values up to 0.25 beyond 0..1, which
 * vig_optimize's interpolation leaves at edges, are cut to it. With capacity 0, *found receives the
 * number of lines and nothing else is done; CAPACITY when there are more than capacity. SYNTAX names the line. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_points_read(const char *text, size_t bytes,
                                                                    lensprof_pair *pairs, uint32_t capacity,
                                                                    uint32_t *found, lensprof_error *error);

/* Writes the same. cameras[count] give the frame sizes for the radius columns. Sizes as lensprof_pto_write. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status
lensprof_points_write(const lensprof_pair *pairs, uint32_t pair_count, const lensprof_camera *cameras, uint32_t count,
                      char *text, size_t capacity, size_t *needed);

/* ---- Falloffs of other programs' databases ---------------------------------------------------------------- */

/* One falloff of a file. Frozen value struct. */
typedef struct lensprof_import_entry {
    const lensprof_profile *profile; /* until the visitor returns: key, provenance, vignetting; a linear response */
    uint32_t usable; /* 0: what the file has is no falloff (provenance.doubt says why), and lensprof_profile_validate
                      * refuses it; 1: a valid profile, which provenance.doubt may still warn of */
    uint32_t reserved; /* 0 */
} lensprof_import_entry;

/* Receives the entries in the order of the file. Anything but OK stops the reading and is what it returns, with the
 * error text as the visitor left it. */
typedef lensprof_status (*lensprof_import_visitor)(void *user, const lensprof_import_entry *entry);

/* ---- Lensfun database (.xml) ------------------------------------------------------------------------------ */

/* Every <vignetting> of a database of version 1 or 2, as a profile of raw pictures in lensprof's conventions
 * (docs/formats.md):
 *  - lens = "<maker> <model>", or the model alone where it begins with the maker; texts without a `lang` count before
 *    English ones. For a lens with one mount whose first letter is small (a camera with a fixed lens), camera_maker and
 *    camera_model too, where the file has exactly one <camera> with this mount.
 *  - crop_factor of the lens or of its <calibration>; focal_mm, aperture and distance_m as written, but 1000 m, which
 *    Lensfun's tools write for it, is INFINITY.
 *  - model "pa": k as written. Model "acm", with radii in focal lengths: rescaled, by the <distortion>'s real-focal of
 *    that focal length where there is one. <center> by the <aspect-ratio>, 3:2 where there is none.
 *  - provenance: method "import", source = `source` (a file's name, say; may be NULL, cut where it is too long) and the
 *    licence of Lensfun's database. doubt: M below 0.001 (usable = 0); coefficients -0.3, 0, 0, which a fit of
 *    Lensfun's calibrate.py starts from; M, followed outwards, rises by more than 0.05.
 * All of the text is checked before the first entry is visited. Document types are skipped and entities not expanded.
 * Errors (the text names line and lens): ARGUMENT; SIZE over 64 MiB, or over 2 million elements or attributes; SYNTAX;
 * UNSUPPORTED for another version or model; MEMORY; what the visitor returns. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_read(const char *text, size_t bytes,
                                                                     const char *source, lensprof_import_visitor visit,
                                                                     void *user, lensprof_error *error);

/* The falloffs of profiles as a database of version 1, which every Lensfun reads: model "pa", one <lens> for each lens
 * and crop factor. Sizes as lensprof_pto_write. Doubles are written so that they read back the same.
 *  - <maker> is the first word of key.lens, <model> all of it; the mount is Lensfun's "Generic".
 *  - Lensfun has one curve for all channels: of three, their mean is written. It has no responses, covariances, units
 *    and provenance: these are left out.
 *  - Infinite and unknown distances are 1000 m.
 *  - A centre is converted for frames of 3:2; Lensfun has one a lens.
 * Errors (the text names the profile, counted from 0): ARGUMENT for an unknown lens, crop factor, focal length or
 * aperture, texts that are not UTF-8, two profiles of the same lens and setting, or centres of one lens that differ;
 * UNSUPPORTED for a gain grid or pictures corrected in camera; what lensprof_profile_validate says; CAPACITY;
 * MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_lensfun_write(const lensprof_profile *const *profiles,
                                                                      uint32_t count, char *text, size_t capacity,
                                                                      size_t *needed, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
