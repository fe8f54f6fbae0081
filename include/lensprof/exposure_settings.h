/* lensprof/exposure_settings.h - exposures of pictures by the settings of their camera, with their errors.
 *
 * Example: what EXIF states of two pictures becomes the known exposures of a fit.
 *
 *     lensprof_exposure_settings settings[2] = {{.time_s = 1.0 / 125, .f_number = 8, .iso = 100},
 *                                               {.time_s = 1.0 / 60, .f_number = 8, .iso = 100}};
 *     lensprof_known_exposure known[2];
 *     lensprof_fit_image fitted[2];
 *     status = lensprof_known_exposures(settings, 2, known, &error);
 *     for (uint32_t i = 0; i < 2 && status == LENSPROF_OK; i++) {
 *         lensprof_fit_image_init(&fitted[i], i, images[i].width, images[i].height);
 *         fitted[i].known_ev = known[i].ev, fitted[i].known_ev_sigma = known[i].sigma;
 *     }
 *
 * Threads: calls are independent of each other. Same input, same bytes.
 */
#ifndef LENSPROF_EXPOSURE_SETTINGS_H
#define LENSPROF_EXPOSURE_SETTINGS_H

#include "profile.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Exposure settings of one picture, as EXIF rounds them; LENSPROF_UNKNOWN = not stated. Frozen value struct. */
typedef struct lensprof_exposure_settings {
    double time_s;   /* of the shutter, s */
    double f_number; /* of the aperture */
    double iso;
    uint32_t camera;    /* any number, the same for pictures of one camera */
    uint32_t lens;      /* any number, the same for pictures of one lens on one body */
    uint32_t is_manual; /* 1: time, aperture and ISO were set by hand, not metered */
    uint32_t reserved;  /* 0 */
} lensprof_exposure_settings;

/* Whether the exposure of a picture is known, or why not. */
typedef enum lensprof_exposure_state {
    LENSPROF_EXPOSURE_KNOWN = 0,
    LENSPROF_EXPOSURE_NO_TIME = 1,     /* not stated. Cameras vary it, so it never cancels */
    LENSPROF_EXPOSURE_NO_ISO = 2,      /* not stated, but of other pictures of the camera */
    LENSPROF_EXPOSURE_NO_APERTURE = 3, /* not stated, but of other pictures of the lens */
    LENSPROF_EXPOSURE_APART = 4, /* stated, but of a lens without apertures, or with them, unlike more pictures of the
                                    camera, to which it cannot be compared */
    LENSPROF_EXPOSURE_IMPLAUSIBLE = 5 /* beyond 40 EV from 1 s, f/1, ISO 100 */
} lensprof_exposure_state;

/* The exposure of one picture, for lensprof_fit_image. Frozen value struct. */
typedef struct lensprof_known_exposure {
    double ev;         /* known_ev: larger = brighter rendering of the same scene. NaN unless KNOWN or IMPLAUSIBLE */
    double sigma;      /* known_ev_sigma, EV; 0 unless KNOWN */
    uint32_t state;    /* lensprof_exposure_state */
    uint32_t reserved; /* 0 */
} lensprof_known_exposure;

/* log2(time_s iso / (100 f_number^2)): 0 for 1 s, f/1, ISO 100. */
LENSPROF_API double lensprof_settings_ev(double time_s, double f_number, double iso);

/* The exposures of `count` pictures, to known[count]. A value that no picture of a camera (ISO) or of a lens (aperture)
 * states cancels: the exposures are then relative to each other. The error is 0.1 EV, because EXIF rounds to thirds of
 * a stop; but pictures of one lens at one manual exposure agree to 0.03 EV, the scatter of shutter and aperture. Of
 * several such groups only the largest gets this error, because rounding counts between groups. Errors: ARGUMENT for
 * NULL, an is_manual other than 0 and 1, and a reserved other than 0; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_known_exposures(const lensprof_exposure_settings *settings,
                                                                        uint32_t count, lensprof_known_exposure *known,
                                                                        lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
