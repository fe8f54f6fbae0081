/* lensprof/reason.h - findings and their codes: what a result was checked for, and what came of it.
 *
 * Example: all codes and what they mean.
 *
 *     for (uint32_t code = 1; code < 1000; code++)
 *         if (*lensprof_reason_text(code))
 *             printf("%u %s: %s\n", (unsigned)code, lensprof_reason_name(code), lensprof_reason_text(code));
 *
 * A fit answers with a list of findings: code, severity, the image or shot concerned, numbers, and a sentence composed
 * of these for people. A lookup answers with one code. docs/reasons.md has a remedy for every code.
 */
#ifndef LENSPROF_REASON_H
#define LENSPROF_REASON_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Values never change. Comments give the item that a finding names, then its numbers in order. Shares are 0..1; radii
 * and distances from the centre are in half diagonals of the frame. */
typedef enum lensprof_reason {
    LENSPROF_REASON_NONE = 0,

    /* Pairs and images: how many there are, and how well they agree. */
    LENSPROF_REASON_IMAGE_GROUPS = 101,  /* image: number of groups */
    LENSPROF_REASON_FEW_PAIRS = 102,     /* distinct pairs between black and white; unknowns */
    LENSPROF_REASON_FEW_AGREE = 103,     /* share of the pairs, or of the cells of a card, that agree */
    LENSPROF_REASON_SCATTER = 104,       /* noise of a sample, levels of 255 */
    LENSPROF_REASON_NOT_CONVERGED = 105, /* iterations */
    LENSPROF_REASON_UNDETERMINED = 106,
    LENSPROF_REASON_FEW_INLIERS = 107,        /* image: pairs that agree */
    LENSPROF_REASON_IMAGE_DISAGREES = 108,    /* image: pairs that agree; pairs of the image */
    LENSPROF_REASON_PATTERNS = 109,           /* share of the residual's variance; levels of 255 */
    LENSPROF_REASON_IMAGE_INCONSISTENT = 110, /* image: median residual, levels of 255 */
    LENSPROF_REASON_IMAGES_LEFT_OUT = 111,    /* first image that disagrees and was left out: number of them */
    LENSPROF_REASON_IMAGES_UNCONNECTED = 112, /* first image left out, as none of them disagrees: number of images */
    LENSPROF_REASON_MANY_OUTLIERS = 113,      /* share of the pairs that disagree; held-out RMS, levels of 255 */
    LENSPROF_REASON_SEAMS_REMAIN = 114,       /* median residual; median residual before the fit; levels of 255 */
    LENSPROF_REASON_LINKS_CONTRADICT = 115,   /* image of the first link: number of links */
    LENSPROF_REASON_LINKS_UNVERIFIED = 116,   /* first image: number of images */
    LENSPROF_REASON_IMAGES_MINORITY = 117,    /* images that take part; images of the set */

    /* Exposures, and the exponent gamma, which pictures alone do not determine. */
    LENSPROF_REASON_EXPOSURE_UNCERTAIN = 201,  /* image: standard error, EV */
    LENSPROF_REASON_EXPOSURES_EQUAL = 202,     /* difference, EV */
    LENSPROF_REASON_KNOWN_ORDER = 203,         /* difference, EV */
    LENSPROF_REASON_KNOWN_WRONG = 204,         /* image: known exposure minus that of the pictures, EV */
    LENSPROF_REASON_KNOWN_STEP = 205,          /* image: known exposures minus those of the pictures from it on, EV */
    LENSPROF_REASON_KNOWN_CONTRADICT = 206,    /* distance, EV */
    LENSPROF_REASON_GAMMA_INCONSISTENT = 207,  /* factor of all exposures */
    LENSPROF_REASON_WHITE_BALANCE_FIXED = 208, /* image: difference, levels of 255 */

    /* Response. */
    LENSPROF_REASON_FEW_GREYS = 301,        /* tenths of the grey values */
    LENSPROF_REASON_MISSING_GREYS = 302,    /* from, grey value 0..1; to, grey value 0..1 */
    LENSPROF_REASON_UNUSUAL_RESPONSE = 303, /* distance, in units of the spread of the kind's measured cameras; standard
                                               error of ln gamma */
    LENSPROF_REASON_RESPONSE_UNCONSTRAINED = 304, /* difference of the irradiance, EV; standard error of ln gamma */

    /* Falloff. */
    LENSPROF_REASON_SMALL_RADIUS = 401,     /* largest radius, half diagonals */
    LENSPROF_REASON_CORNER_UNCERTAIN = 402, /* standard error of M; of a card also the share that is not radial */
    LENSPROF_REASON_FALLOFF_RISES = 403,    /* largest M; its standard error */
    LENSPROF_REASON_CENTER_ON_LIMIT = 404,  /* distance, half diagonals */
    LENSPROF_REASON_FALLOFF_DARK = 405,     /* smallest M */
    LENSPROF_REASON_SAME_VIEW = 406,        /* change of r^2 between the ends of most pairs, at most */
    LENSPROF_REASON_EXPOSURES_ONLY = 407,   /* a simpler model predicts the pairs as well */
    LENSPROF_REASON_NOTHING_BETTER = 408,   /* no model predicts the pairs better than no correction */
    LENSPROF_REASON_NOT_RADIAL = 409,       /* share of the residual's variance; levels of 255 */
    LENSPROF_REASON_FAR_CENTER = 410,       /* distance, half diagonals */
    LENSPROF_REASON_FEW_IMAGES = 411,       /* images of a moving camera; images needed */

    /* Flat fields. */
    LENSPROF_REASON_FLAT_WHITE = 501,           /* shot: share of the card */
    LENSPROF_REASON_FLAT_BLACK = 502,           /* shot: share of the card */
    LENSPROF_REASON_FLAT_NO_CARD = 503,         /* shot */
    LENSPROF_REASON_FLAT_FEW_CELLS = 504,       /* cells */
    LENSPROF_REASON_FLAT_RESPONSE = 505,        /* image: d ln irradiance / d ln grey */
    LENSPROF_REASON_FLAT_EXPOSURE_WRONG = 506,  /* image: distance, EV */
    LENSPROF_REASON_FLAT_TEXTURE = 507,         /* share of the light; error of the falloff in the corner */
    LENSPROF_REASON_FLAT_SHOTS_DIFFER = 508,    /* share of the light */
    LENSPROF_REASON_FLAT_STEEP = 509,           /* shot: share of the light per half diagonal */
    LENSPROF_REASON_FLAT_NOT_RADIAL = 510,      /* share of the light that is not radial; with a gain grid, the share
                                                   that it leaves */
    LENSPROF_REASON_FLAT_CENTER_BY_PRIOR = 511, /* change of the falloff in a corner with the other light, EV */
    LENSPROF_REASON_FLAT_DUST = 512,            /* spots; standard error of the falloff in the corner */
    LENSPROF_REASON_FLAT_EDGE = 513,            /* radius, half diagonals; share of the frame outside */
    LENSPROF_REASON_FLAT_ONE_LIGHT = 514,
    LENSPROF_REASON_FLAT_NEEDS_GRID = 515,  /* relative error of k1..k3 without the gain grid */
    LENSPROF_REASON_FLAT_BLACK_LEVEL = 516, /* note: standard error of black; change of the falloff in the corner, EV */

    /* Fields: pictures of different scenes under one shading. */
    LENSPROF_REASON_FIELDS_FEW = 521,       /* pictures that differ; pictures needed */
    LENSPROF_REASON_FIELDS_REPEATED = 522,  /* first image that repeats another one: number of them */
    LENSPROF_REASON_FIELDS_PATTERN = 523,   /* share of the light; share of the variance of a cell */
    LENSPROF_REASON_FIELDS_UNCERTAIN = 524, /* standard error of the shading, share */
    LENSPROF_REASON_FIELDS_OFFSET = 525,
    LENSPROF_REASON_FIELDS_WHITE = 526,  /* share of the cells; or number of images left out */
    LENSPROF_REASON_FIELDS_BLACK = 527,  /* number of images left out */
    LENSPROF_REASON_FIELDS_UNSEEN = 528, /* share of the cells */
    LENSPROF_REASON_FIELDS_GAIN = 529,

    /* Lookups of profiles; from 651 on, the profile was found. */
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

    /* The profile given as the prior: distance of the part that contradicts the pictures, and distance of held-out
     * pairs, standard errors. */
    LENSPROF_REASON_PRIOR_OVERRULED = 701,
    LENSPROF_REASON_PRIOR_RESPONSE_OVERRULED = 702, /* its falloff was used */
    LENSPROF_REASON_PRIOR_FALLOFF_OVERRULED = 703   /* its response was used */
} lensprof_reason;

typedef enum lensprof_severity {
    LENSPROF_SEVERITY_PASSED = 0,  /* the rule was checked, and holds */
    LENSPROF_SEVERITY_NOTE = 1,    /* worth knowing; the corrected pictures do not show it */
    LENSPROF_SEVERITY_WARNING = 2, /* the corrected pictures show it, or a number that people use is wrong */
    LENSPROF_SEVERITY_REFUSAL = 3  /* the result is not a profile to store */
} lensprof_severity;

/* One finding. The text names the item and has its numbers; it is empty for a rule that holds. */
typedef struct lensprof_finding {
    uint32_t struct_size;
    uint32_t code;          /* lensprof_reason */
    uint32_t severity;      /* lensprof_severity */
    uint32_t value_count;   /* number of `value`, 0..2 */
    uint32_t rule_severity; /* of the rule: what it would find if it did not hold */
    uint32_t reserved;      /* 0 */
    double value[2];        /* as the comment on the code lists them */
    double measured;        /* number that the rule compares with its limit, in the unit of that limit; NaN: none */
    double limit;
    lensprof_item item; /* the image or shot concerned; its position in the text */
    char text[256];     /* always terminated */
} lensprof_finding;

/* An empty finding. */
static inline void lensprof_finding_init(lensprof_finding *finding) { lensprof_init_sized(finding, sizeof *finding); }

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
