/* lensprof/reason.h - reason codes: why a result is not usable, or what is doubtful about it.
 *
 * Example: all codes and what they mean.
 *
 *     for (uint32_t code = 1; code < 1000; code++)
 *         if (*lensprof_reason_text(code))
 *             printf("%u %s: %s\n", (unsigned)code, lensprof_reason_name(code), lensprof_reason_text(code));
 *
 * Fits, flat fields and lookups report their verdict as data: a code, the image or shot concerned, and numbers. The
 * sentence next to it (`reason`) is composed of these, for people. docs/reasons.md has a remedy for every code.
 */
#ifndef LENSPROF_REASON_H
#define LENSPROF_REASON_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Values never change. In each hundred, values below 50 mark results that are not usable and lookups that found
 * nothing; values from 50 on are warnings. STILL_: pictures from a stationary camera. Comments give the item that a
 * reason names, then its numbers in order. Shares are 0..1; radii and distances from the centre are in half diagonals
 * of the frame. */
typedef enum lensprof_reason {
    LENSPROF_REASON_NONE = 0,

    /* Pairs and images: how many there are, and how well they agree. */
    LENSPROF_REASON_IMAGE_GROUPS = 101,    /* image: number of groups */
    LENSPROF_REASON_FEW_PAIRS = 102,       /* distinct pairs between black and white; unknowns */
    LENSPROF_REASON_FEW_AGREE = 103,       /* share of the pairs that agree */
    LENSPROF_REASON_STILL_FEW_AGREE = 104, /* share of the pairs that agree */
    LENSPROF_REASON_SCATTER = 105,         /* noise of a sample, levels of 255 */
    LENSPROF_REASON_NOT_SETTLED = 106,     /* iterations */
    LENSPROF_REASON_UNDETERMINED = 107,
    LENSPROF_REASON_FEW_BEHIND_EXPOSURE = 108,       /* image: pairs that agree */
    LENSPROF_REASON_STILL_FEW_BEHIND_EXPOSURE = 109, /* image: pairs that agree */
    LENSPROF_REASON_IMAGE_DISAGREES = 110,           /* image: pairs that agree; pairs of the image */
    LENSPROF_REASON_STILL_IMAGE_DISAGREES = 111,     /* image: pairs that agree; pairs of the image */
    LENSPROF_REASON_PATTERNS = 112,                  /* share of the residual's variance; levels of 255 */
    LENSPROF_REASON_PATTERNS_HELD = 113,             /* share of the residual's variance; levels of 255 */
    LENSPROF_REASON_STILL_PATTERNS = 114,            /* share of the residual's variance; levels of 255 */
    LENSPROF_REASON_IMAGE_ODD = 151,                 /* image: median residual, levels of 255 */
    LENSPROF_REASON_STILL_IMAGE_ODD = 152,           /* image: median residual, levels of 255 */
    LENSPROF_REASON_WEAK_PATTERNS = 153,             /* share of the residual's variance; levels of 255 */
    LENSPROF_REASON_IMAGES_LEFT_OUT = 154,           /* first image that disagrees and was left out: number of them */
    LENSPROF_REASON_MANY_OUTLIERS = 155,             /* share of the pairs that disagree; held-out RMS, levels of 255 */
    LENSPROF_REASON_SEAMS_STAY = 156,         /* median residual; median residual before the fit; levels of 255 */
    LENSPROF_REASON_LINKS_UNVERIFIED = 157,   /* first image: number of images */
    LENSPROF_REASON_LINKS_CONTRADICT = 158,   /* image of the first link: number of links */
    LENSPROF_REASON_IMAGES_UNCONNECTED = 159, /* first image left out, as none of them disagrees: number of images */

    /* Exposures, and the exponent gamma, which pictures alone do not determine. */
    LENSPROF_REASON_EXPOSURE_UNCERTAIN = 201, /* image: standard error, EV */
    LENSPROF_REASON_EXPOSURES_ALIKE = 204,    /* difference, EV */
    LENSPROF_REASON_KNOWN_ORDER = 251,        /* difference, EV */
    LENSPROF_REASON_KNOWN_WRONG = 252,        /* image: distance, EV */
    LENSPROF_REASON_KNOWN_MORE_FROM = 253,    /* image: step, EV */
    LENSPROF_REASON_KNOWN_LESS_FROM = 254,    /* image: step, EV */
    LENSPROF_REASON_KNOWN_CONTRADICT = 255,   /* distance, EV */
    LENSPROF_REASON_GAMMA_UNFOLLOWED = 256,   /* factor of all exposures */
    LENSPROF_REASON_BALANCES_HELD = 257,      /* image: difference, levels of 255 */

    /* Response. */
    LENSPROF_REASON_FEW_GREYS = 301,     /* tenths of the grey values */
    LENSPROF_REASON_MISSING_GREYS = 351, /* from, grey value 0..1; to, grey value 0..1 */
    LENSPROF_REASON_UNUSUAL_RESPONSE =
        352, /* distance, in units of the spread of the kind's measured cameras; standard error of ln gamma */
    LENSPROF_REASON_RESPONSE_NOT_SHOWN = 353, /* difference of the light, EV; standard error of ln gamma */

    /* Falloff. */
    LENSPROF_REASON_SMALL_RADIUS = 401,       /* largest radius, half diagonals */
    LENSPROF_REASON_CORNER_UNCERTAIN = 402,   /* standard error of M */
    LENSPROF_REASON_FALLOFF_RISES = 403,      /* largest M; its standard error */
    LENSPROF_REASON_CENTER_ON_LIMIT = 404,    /* distance, half diagonals */
    LENSPROF_REASON_FALLOFF_DARK = 405,       /* smallest M */
    LENSPROF_REASON_SAME_VIEW = 406,          /* change of r^2 between the ends of most pairs, at most */
    LENSPROF_REASON_EXPOSURES_ONLY = 407,     /* a simpler model predicts held-out pairs as well */
    LENSPROF_REASON_NOTHING_BETTER = 408,     /* no model predicts held-out pairs better than no correction */
    LENSPROF_REASON_NOT_RADIAL = 451,         /* share of the residual's variance; levels of 255 */
    LENSPROF_REASON_FAR_CENTER = 452,         /* distance, half diagonals */
    LENSPROF_REASON_FALLOFF_RISES_SOME = 453, /* largest M; its standard error */

    /* Flat fields. */
    LENSPROF_REASON_FLAT_WHITE = 501,          /* shot: share of the card */
    LENSPROF_REASON_FLAT_BLACK = 502,          /* shot: share of the card */
    LENSPROF_REASON_FLAT_NO_CARD = 503,        /* shot */
    LENSPROF_REASON_FLAT_FEW_CELLS = 504,      /* cells */
    LENSPROF_REASON_FLAT_SMALL_RADIUS = 505,   /* largest radius, half diagonals */
    LENSPROF_REASON_FLAT_RESPONSE_STEP = 506,  /* image: d ln light / d ln grey */
    LENSPROF_REASON_FLAT_RESPONSE_LEVEL = 507, /* image: d ln light / d ln grey */
    LENSPROF_REASON_FLAT_EXPOSURE_WRONG = 508, /* image: distance, EV */
    LENSPROF_REASON_FLAT_TEXTURE = 509,        /* share of the light */
    LENSPROF_REASON_FLAT_SHOTS_DIFFER = 510,   /* share of the light */
    LENSPROF_REASON_FLAT_FEW_AGREE = 511,      /* share of the cells */
    LENSPROF_REASON_FLAT_STEEP = 512,          /* shot: share of the light per half diagonal */
    LENSPROF_REASON_FLAT_STEEP_ALONE = 513,    /* shot: share of the light per half diagonal */
    LENSPROF_REASON_FLAT_UNDETERMINED = 514,
    LENSPROF_REASON_FLAT_CORNER_NOT_RADIAL = 515, /* share of the light that is not radial; standard error of M */
    LENSPROF_REASON_FLAT_CORNER_UNCERTAIN = 516,  /* standard error of M */
    LENSPROF_REASON_FLAT_EXTRAPOLATED = 551,      /* largest radius, half diagonals */
    LENSPROF_REASON_FLAT_SOME_WHITE = 552,        /* shot: share of the card */
    LENSPROF_REASON_FLAT_SOME_BLACK = 553,        /* shot: share of the card */
    LENSPROF_REASON_FLAT_EXPOSURE_DOUBTFUL = 554, /* image: distance, EV */
    LENSPROF_REASON_FLAT_SHOTS_DIFFER_SOME = 555, /* share of the light */
    LENSPROF_REASON_FLAT_SOME_TEXTURE = 556,      /* share of the light */
    LENSPROF_REASON_FLAT_SLANTED_LIGHT = 557,     /* share of the light per half diagonal */
    LENSPROF_REASON_FLAT_NOT_RADIAL_GRID = 558, /* share of the light that is not radial; share left by the gain grid */
    LENSPROF_REASON_FLAT_NOT_RADIAL = 559,      /* share of the light that is not radial */
    LENSPROF_REASON_FLAT_FAR_CENTER = 560,      /* distance, half diagonals */
    LENSPROF_REASON_FLAT_CENTER_BY_PRIOR = 561,
    LENSPROF_REASON_FLAT_DUST = 562, /* spots */

    /* Lookups of profiles. */
    LENSPROF_REASON_LOOKUP_NO_LENS = 601,
    LENSPROF_REASON_LOOKUP_NO_CAMERA = 602,
    LENSPROF_REASON_LOOKUP_OTHER_PROCESSING = 603,
    LENSPROF_REASON_LOOKUP_DOUBTFUL = 604,
    LENSPROF_REASON_LOOKUP_OTHER_CAMERA = 605,
    LENSPROF_REASON_LOOKUP_SEVERAL_LENSES = 606,
    LENSPROF_REASON_LOOKUP_SMALLER_SENSOR = 607,
    LENSPROF_REASON_LOOKUP_FOCAL_MISSING = 608,
    LENSPROF_REASON_LOOKUP_APERTURE_MISSING = 609,
    LENSPROF_REASON_LOOKUP_NO_FOCAL = 610,
    LENSPROF_REASON_LOOKUP_NO_APERTURE = 611,
    LENSPROF_REASON_LOOKUP_FOCAL_BEYOND = 612,
    LENSPROF_REASON_LOOKUP_APERTURE_BEYOND = 613,
    LENSPROF_REASON_LOOKUP_TOO_FAR = 614,
    LENSPROF_REASON_LOOKUP_CONTRADICTION = 615,
    LENSPROF_REASON_LOOKUP_CORRECTED = 616,
    LENSPROF_REASON_LOOKUP_FOCAL_ROUNDED = 651,
    LENSPROF_REASON_LOOKUP_FOCAL_OUTSIDE = 652,
    LENSPROF_REASON_LOOKUP_APERTURE_OUTSIDE = 653,
    LENSPROF_REASON_LOOKUP_OTHER_LIGHT = 654,
    LENSPROF_REASON_LOOKUP_SMALLEST_SENSOR = 655,
    LENSPROF_REASON_LOOKUP_BY_WORDS = 656,
    LENSPROF_REASON_LOOKUP_BUILT_IN = 657,
    LENSPROF_REASON_LOOKUP_WEAKEST_DISTANCE = 658,
    LENSPROF_REASON_LOOKUP_FARTHEST_DISTANCE = 659,
    LENSPROF_REASON_LOOKUP_USUAL_DISTANCE = 660,
    LENSPROF_REASON_LOOKUP_UNKNOWN_SENSOR = 661,
    LENSPROF_REASON_LOOKUP_ON_OTHER_CAMERA = 662,
    LENSPROF_REASON_LOOKUP_TYPICAL_RESPONSE = 663,
    LENSPROF_REASON_LOOKUP_OTHER_STYLE = 664,

    /* The profile given as the prior. */
    LENSPROF_REASON_PRIOR_OVERRULED =
        751, /* distance of its falloff, standard errors; distance of held-out pairs, standard errors */
    LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED = 752, /* distance of held-out pairs, standard errors */
    LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED =
        753 /* distance of its falloff, standard errors; distance of held-out pairs, standard errors */
} lensprof_reason;

/* Name of the enumerator in lower case without LENSPROF_REASON_, e.g. "image_groups"; "unknown" for other values.
 * Static storage. */
LENSPROF_API const char *lensprof_reason_name(uint32_t reason);

/* A short sentence without item and numbers, different for each code; empty for NONE and other values. Static storage.
 */
LENSPROF_API const char *lensprof_reason_text(uint32_t reason);

#ifdef __cplusplus
}
#endif
#endif
