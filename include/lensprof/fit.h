/* lensprof/fit.h - recover response, vignetting, exposure and white balance from correspondences.
 *
 * Method `radiance` (Goldman & Chen 2005): minimise the error of every grey value,
 *     B_xi - f( e_i w_i M(r_xi) L_x )                                             (equations 2, 3, 11, 12)
 * over the same unknowns and the radiance L of every scene point x, which points of two and more images share.
 *
 * Method `transfer` (d'Angelo 2007): minimise the symmetric grey value transfer error
 *     B1 - f( g(B2) s1/s2 )   and   B2 - f( g(B1) s2/s1 ),      s = M e w            (equations 5, 8, 10)
 * over one response f (EMoR) per camera, one vignetting M per lens setting and the exposure and white balance of every
 * image.
 *
 * Method `transfer-function` (Kim & Pollefeys 2004): the most likely brightness transfer function of every image pair
 * and channel, from its joint histogram; then linear least squares for ln f^-1 and the log exposures (equations 5 to
 * 13), the vignetting by alternation. Here `modes` counts components of ln f^-1, and the result's response has all EMoR
 * modes; SQUARED loss is the paper's variant, iterations are rounds, 20 at most. Pictures that differ by less than 0.15
 * EV are not usable.
 *
 * Method `debevec` (Debevec & Malik 1997, equation 3), a reference: linear least squares for ln f^-1 at the grey levels
 * 1..255, smooth by 10 prior_weight, from known exposures of all images (known_ev_sigma > 0), which are taken as exact;
 * white balances and falloff are as given. The response, which alone is free, is a TABLE, made to rise at the end.
 * modes, loss, vignettings, gamma_from, refine and max_iterations mean nothing; there is no covariance.
 *
 * Threads: calls are independent. One call uses as many threads as its options say, all gone when it returns; progress
 * is told on the caller's. The result does not depend on their number: same input, same bytes.
 */
#ifndef LENSPROF_FIT_H
#define LENSPROF_FIT_H

#include "model.h"
#include "profile.h"
#include "reason.h"
#include "sample.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is unknown. Response to centre: lensprof_fit_options.free. EV, RED, BLUE: lensprof_fit_image.free. */
#define LENSPROF_FREE_RESPONSE 0x01u
#define LENSPROF_FREE_K1 0x02u
#define LENSPROF_FREE_K2 0x04u
#define LENSPROF_FREE_K3 0x08u
#define LENSPROF_FREE_CENTER 0x10u
#define LENSPROF_FREE_EV 0x20u
#define LENSPROF_FREE_RED 0x40u
#define LENSPROF_FREE_BLUE 0x80u

#define LENSPROF_SETTINGS_MAX 64
#define LENSPROF_CAMERAS_MAX 64

/* How the unknowns are told from the correspondences. All give the same kind of result. */
typedef enum lensprof_fit_method {
    LENSPROF_METHOD_TRANSFER = 0, /* default: d'Angelo 2007, grey values transferred from one image to the other */
    LENSPROF_METHOD_RADIANCE = 1, /* Goldman & Chen 2005: with one radiance a scene point */
    LENSPROF_METHOD_TRANSFER_FUNCTION = 2, /* Kim & Pollefeys 2004: by the transfer functions of image pairs */
    LENSPROF_METHOD_DEBEVEC = 3            /* Debevec & Malik 1997: from known exposures; lensprof_fit_overlap only */
} lensprof_fit_method;

typedef enum lensprof_loss {
    LENSPROF_LOSS_ROBUST = 0, /* default: noise-weighted, redescending, a pair is trusted as a whole */
    LENSPROF_LOSS_HUBER = 1,  /* the paper's, equation 11 */
    LENSPROF_LOSS_SQUARED = 2
} lensprof_loss;

#define LENSPROF_MODES_AUTO 0xFFFFFFFFu /* number of EMoR modes chosen by held-out error */

/* What settles the exponent gamma that pictures leave open: (f, M, e) and (f o x^(1/gamma), M^gamma, e^gamma) make the
 * same pictures. */
typedef enum lensprof_gamma_from {
    LENSPROF_GAMMA_AUTO = 0,      /* default: known exposures and the prior, each by its standard error */
    LENSPROF_GAMMA_PRIOR = 1,     /* the prior on the response alone */
    LENSPROF_GAMMA_EXPOSURES = 2, /* known_ev of the images alone; without differences there, the prior */
    LENSPROF_GAMMA_KNOWN = 3,     /* results only: parameters held fixed, be it response, falloff or exposures */
    LENSPROF_GAMMA_NONE = 4,      /* results only: nothing, for want of a prior (the paper's method): it is arbitrary */
    LENSPROF_GAMMA_PROFILE = 5,   /* results only: the response of the profile that the options give as the prior */
    LENSPROF_GAMMA_FALLOFF = 6,   /* results only: its falloff, as it says how deep M is */
    LENSPROF_GAMMA_CAMERAS = 7    /* results only: another camera of the fit, whose gamma is known better */
} lensprof_gamma_from;

/* One image of the fit. */
typedef struct lensprof_fit_image {
    uint32_t struct_size;
    uint32_t width, height;     /* full frame, px */
    uint32_t free;              /* LENSPROF_FREE_EV | _RED | _BLUE */
    uint32_t ev_of;             /* index of the image whose ev this one shares (links); own index = its own */
    uint32_t red_of, blue_of;   /* the same for the white balance factors */
    uint32_t setting;           /* 0..LENSPROF_SETTINGS_MAX - 1: images of one lens at one focal length, aperture and
                                   focus have the same. Every setting has a vignetting of its own, TRANSFER and RADIANCE
                                   alone */
    lensprof_exposure exposure; /* the value where fixed, else unused */
    double known_ev;            /* exposure from elsewhere (EXIF), EV up to a common offset: a soft observation */
    double known_ev_sigma;      /* its standard error, 0.001..100 EV; 0 = not known. Rounded EXIF: about 0.1; below
                                   0.02 counts as 0.02. One alone says nothing: only differences do */
    uint32_t camera;            /* 0..LENSPROF_CAMERAS_MAX - 1: every camera has a response of its own, where that is
                                   free. Images of one setting are of one camera. What is fixed or known of exposures is
                                   of images of one camera relative to each other. Several: not with DEBEVEC */
    uint32_t reserved;          /* 0 */
} lensprof_fit_image;

/* Image `index` of the array, of a frame of width x height px: setting 0, camera 0, exposure and white balance of its
 * own, free, 0 EV and 1, 1, 1 where fixed, and not known from elsewhere. */
LENSPROF_API void lensprof_fit_image_init_sized(lensprof_fit_image *image, size_t size, uint32_t index, uint32_t width,
                                                uint32_t height);
static inline void lensprof_fit_image_init(lensprof_fit_image *image, uint32_t index, uint32_t width, uint32_t height) {
    lensprof_fit_image_init_sized(image, sizeof *image, index, width, height);
}

/* Where the response of a result is from. */
typedef enum lensprof_fit_response {
    LENSPROF_FIT_RESPONSE_PICTURES = 0, /* fitted */
    LENSPROF_FIT_RESPONSE_OPTIONS = 1,  /* held as given */
    LENSPROF_FIT_RESPONSE_KIND = 2,     /* the pictures do not show it: the typical one of the kind of camera, with the
                                            covariance of that kind */
    LENSPROF_FIT_RESPONSE_PROFILE = 3   /* the pictures do not show it: that of the profile given as the prior */
} lensprof_fit_response;

/* What became of lensprof_fit_options.profile. */
typedef enum lensprof_profile_prior {
    LENSPROF_PROFILE_PRIOR_NONE = 0,      /* none was given */
    LENSPROF_PROFILE_PRIOR_USED = 1,      /* it is in the result, which takes its place */
    LENSPROF_PROFILE_PRIOR_OVERRULED = 2, /* the pictures contradict it; the result is without it, `reason` says so */
    LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED = 3, /* its response alone; its falloff is in the result */
    LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED = 4   /* its falloff alone; its response is in the result */
} lensprof_profile_prior;

typedef struct lensprof_fit_options {
    uint32_t struct_size;
    uint32_t channels;   /* 1 or 3 */
    uint32_t reference;  /* image whose exposure is the gauge: its ev and white balance stay as given */
    uint32_t free;       /* LENSPROF_FREE_RESPONSE .. _CENTER */
    uint32_t modes;      /* EMoR modes, 0..25, or LENSPROF_MODES_AUTO */
    uint32_t loss;       /* lensprof_loss */
    double huber_levels; /* HUBER: sigma in levels of 255 (paper: 5) */
    double prior_weight; /* weight of the priors on response, vignetting and centre; 0 = none (paper), 1 = default */
    uint32_t max_iterations;
    uint32_t vignettings; /* falloff curves: 1 for all channels, 3, or 0 = chosen by held-out error */
    uint32_t gamma_from;  /* lensprof_gamma_from */
    uint32_t
        camera_kind;   /* lensprof_camera_kind: whose exponents the prior is of. LINEAR: the response is held linear */
    uint32_t threads;  /* at most so many, the caller's included; 0 = one a core. The result does not depend on it */
    uint32_t method;   /* lensprof_fit_method */
    uint32_t refine;   /* 1: the response is freed of the EMoR modes at every grey level, and becomes a TABLE, where
                          held-out pairs are not clearly worse for it. Wants pairs of all greys; for TRANSFER with
                          at most 256 images and 100 pairs or more, else without effect. 0 = EMoR alone */
    uint32_t reserved; /* 0 */
    const lensprof_profile *profile; /* of the same camera, lens and setting, from other pictures: the prior in place of
                                        that of all cameras, where a response of EMoR modes and a falloff have a
                                        covariance, and where a TABLE has a gamma_sigma above 0, as refined responses
                                        have; one of these it must have. TRANSFER and RADIANCE, a prior_weight above
                                        0. Response and falloff are each overruled where held-out pairs are clearly
                                        worse for them (three standard errors), or the falloff or the response's
                                        shape is far from theirs (five). Its falloff is that of the reference's setting.
                                        NULL = none. Read during the call */
    const lensprof_response *response; /* the response where it is fixed; NULL = EMoR mean. Read during the call */
    lensprof_vignetting vignetting;    /* the value where fixed, of all settings */
    lensprof_progress progress;        /* or NULL */
    void *progress_user;
    const lensprof_link *links; /* what sampling said of the links: a usable result warns of images that only links
                                   without texture join. NULL = not known. Read during the call */
    uint32_t link_count;
    uint32_t reserved2; /* 0 */
} lensprof_fit_options;

/* 3 channels, reference 0, everything free, modes AUTO, loss ROBUST, Huber 5 levels, prior weight 1,
 * 200 iterations, vignettings and gamma AUTO, any camera, threads on all cores. */
LENSPROF_API void lensprof_fit_options_init_sized(lensprof_fit_options *options, size_t size);
static inline void lensprof_fit_options_init(lensprof_fit_options *options) {
    lensprof_fit_options_init_sized(options, sizeof *options);
}

/* How well one image is determined. It grows by lensprof_fit_result.image_quality_size. */
typedef struct lensprof_fit_image_quality {
    double ev_sigma;               /* standard error of ev, EV; 0 where fixed or not determined */
    double white_balance_sigma[3]; /* of the factors */
    double median_residual;        /* median absolute transfer residual of its pairs, levels of 255; 0 without pairs */
    double known_ev_residual;      /* ev minus known_ev, less the common offset, EV; 0 where not known */
    double radius;                 /* largest r of a pair, half diagonals */
    double grey_low, grey_high;    /* 5 % and 95 % quantile of its grey values, 0..1 */
    uint32_t pairs;
    uint32_t inliers;           /* of these, those within 3 sigma of the noise */
    uint32_t component;         /* smallest index of an image it is tied to through pairs */
    uint32_t known_ev_left_out; /* 1: known_ev contradicts the pictures and those of other images, and had no part */
    uint32_t joined;            /* 1: pairs that agree join it to the reference of the result; 0: it was left out */
    uint32_t reserved;          /* 0 */
} lensprof_fit_image_quality;

#define LENSPROF_COVERAGE_BINS 10

/* What a fit found of one lens setting: as the members of lensprof_fit_result with these names. */
typedef struct lensprof_fit_setting {
    uint32_t struct_size;
    uint32_t images;  /* of this setting that joined; 0: the rest means nothing */
    uint32_t pairs;   /* with an end in them */
    uint32_t usable;  /* 1: the response and this vignetting are a profile to store */
    char reason[256]; /* why not, or what to mind */
    lensprof_vignetting vignetting[3];
    uint32_t radius_ends[LENSPROF_COVERAGE_BINS];
    uint32_t reason_code;
    uint32_t reason_values;
    lensprof_item reason_item;
    double reason_value[2];
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX]; /* covariance_size is the result's */
    double gamma_direction[LENSPROF_COVARIANCE_MAX];
} lensprof_fit_setting;

/* No falloff, not usable. */
LENSPROF_API void lensprof_fit_setting_init_sized(lensprof_fit_setting *setting, size_t size);
static inline void lensprof_fit_setting_init(lensprof_fit_setting *setting) {
    lensprof_fit_setting_init_sized(setting, sizeof *setting);
}

/* What a fit found of one camera of several: the members named as those of lensprof_fit_result are of its own fit, on
 * the pairs between its own images. Pairs with other cameras then join it to that of the reference: they say the
 * exponent gamma by which both see the same light, with what each fit knows of its own, and the offset of its exposures
 * in each channel. */
typedef struct lensprof_fit_camera {
    uint32_t struct_size;
    uint32_t images; /* of this camera that joined its fit; 0: the rest means nothing, for no pairs are between two of
                        its images */
    uint32_t joined; /* 1: the exposures of these are relative to the reference; 0: too few pairs with other cameras, or
                        most of them contradict it; the ev of its images is NaN */
    uint32_t shared_pairs;      /* with an end in it and the other in another camera that joined */
    double agreeing_share;      /* of these, those within 3 sigma of what is left */
    double light_difference_ev; /* median absolute difference of the light at their ends, EV */
    double log_gamma;           /* by which its own fit was moved along its family, to agree with the others */
    double offset_sigma_ev;     /* standard error of the offset of its exposures, most of it of the light at white,
                                   which no pair shows; 0 for that of the reference */
    lensprof_response response;
    uint32_t vignettings, pairs, evens, gamma_from;
    uint32_t response_from, profile_prior, covariance_size, converged;
    double gamma_sigma, before_rms, heldout_rms, heldout_median, noise_levels, inlier_share, frame_share, image_share,
        light_spread_ev;
    uint32_t grey_ends[LENSPROF_COVERAGE_BINS];
    uint32_t reference; /* image whose exposure its own fit held */
    uint32_t setting;   /* of that image */
    uint32_t attached;  /* images beside those of its fit, for no pairs with these join them, whose exposures pairs with
                           other cameras say */
    uint32_t reserved;  /* 0 */
} lensprof_fit_camera;
/* No images, a linear response. */
LENSPROF_API void lensprof_fit_camera_init_sized(lensprof_fit_camera *camera, size_t size);
static inline void lensprof_fit_camera_init(lensprof_fit_camera *camera) {
    lensprof_fit_camera_init_sized(camera, sizeof *camera);
}

/* Of several cameras, the members are those of the reference's, but exposures, image_quality, settings, left_out and
 * seconds, which are of all; `cameras` has the others. Where the reference's own pictures are not evened out, the
 * reference is an image of the camera with most images that are.
 * Of several lens settings, that of the reference stands in vignetting, radius_ends, usable, reason, covariance and
 * gamma_direction; `settings` has all. */
typedef struct lensprof_fit_result {
    uint32_t struct_size;
    uint32_t usable;             /* 1: a profile to store; 0: not one, with the reason in words */
    uint32_t image_quality_size; /* bytes of an element of image_quality, set by the _init function */
    uint32_t reserved;           /* 0 */
    char reason[256];            /* why not usable; when usable empty, or what to mind */
    lensprof_response response;
    lensprof_vignetting vignetting[3]; /* of the channels; all alike when `vignettings` is 1; they share one centre */
    uint32_t vignettings;              /* 1 or 3 */
    uint32_t pairs;                    /* pairs used */
    uint32_t components;               /* connected groups of images; 1 when all are tied together */
    uint32_t iterations;
    uint32_t converged;
    uint32_t gamma_from;   /* what settled gamma: PRIOR, EXPOSURES, KNOWN, NONE, PROFILE or FALLOFF: most */
    double gamma_sigma;    /* standard error of ln gamma; 0 when KNOWN, LENSPROF_UNKNOWN when NONE */
    double before_rms;     /* |B1 - B2| of the held-out pairs, levels of 255 */
    double heldout_rms;    /* transfer residual of pairs left out of the fit, levels of 255 */
    double heldout_median; /* median absolute value of the same */
    double noise_levels;   /* estimated noise of a sample, levels of 255 */
    double inlier_share;   /* pairs within 3 sigma of the noise */
    double frame_share;    /* share of the inliers' residual variance that follows one map over the frame: the
                              falloff is not radial. 0 for noise */
    double image_share;    /* share beyond that which follows a map of each image's own: no camera model explains it
                              (local tone mapping, changing light). 0 for noise */
    double seconds;        /* time taken by the solver */
    uint32_t radius_ends[LENSPROF_COVERAGE_BINS]; /* pair ends in rings of r, each 1/10 half diagonal wide */
    uint32_t grey_ends[LENSPROF_COVERAGE_BINS];   /* pair ends in tenths of the grey range, all channels */
    uint32_t covariance_size; /* order as in profile.h; parameters held fixed have zero rows; 0 = not determined */
    uint32_t profile_prior;   /* lensprof_profile_prior */
    double covariance[LENSPROF_COVARIANCE_MAX
                      * LENSPROF_COVARIANCE_MAX];    /* of the data, of gamma and of a profile together */
    double gamma_direction[LENSPROF_COVARIANCE_MAX]; /* change of each parameter per unit of ln gamma */
    lensprof_fit_image_quality *image_quality; /* the caller's array of image_count, set before the call; or NULL */
    uint32_t reason_code;                      /* lensprof_reason: what `reason` states, */
    uint32_t reason_values;                    /* how many numbers, 0..2, */
    lensprof_item reason_item;                 /* which image, */
    double reason_value[2];                    /* and the numbers, in the units of reason.h */
    uint32_t evens;     /* 1: the result evens out these pictures, whether or not it is a profile to store: held-out
                           pairs differ far less than before, and between no two images by more */
    uint32_t left_out;  /* images that do not agree with the largest group of those that do; the fit is without them */
    uint32_t reference; /* image whose exposure is the gauge: that of the options, or where that one was left out the
                           first of the group */
    uint32_t response_from; /* lensprof_fit_response */
    double light_spread_ev; /* root mean square difference of the light at the two ends of a pair, EV: what shows the
                               response */
    lensprof_fit_setting *settings; /* the caller's array of setting_count initialised elements, by setting, set before
                                       the call; or NULL */
    uint32_t setting_count;
    uint32_t reserved2;           /* 0 */
    lensprof_fit_camera *cameras; /* the caller's array of camera_count initialised elements, by camera, set before the
                                     call; or NULL */
    uint32_t camera_count;
    uint32_t reserved3; /* 0 */
} lensprof_fit_result;

/* No result, a linear response. */
LENSPROF_API void lensprof_fit_result_init_sized(lensprof_fit_result *result, size_t size, size_t image_quality_size);
static inline void lensprof_fit_result_init(lensprof_fit_result *result) {
    lensprof_fit_result_init_sized(result, sizeof *result, sizeof(lensprof_fit_image_quality));
}

/* Fits `pair_count` pairs over `image_count` images. exposures[image_count] receives what every image got,
 * relative to the reference. A fit that ran returns OK even when the result is poor: see `usable` and `evens`.
 * Where images do not all agree, the fit is of the largest group that does; the ev of an image that was left out is NaN
 * (image_quality.joined 0). Pictures of a camera that did not move are one group or none.
 * Method TRANSFER_FUNCTION with several settings of a camera, or DEBEVEC with several settings, UNSUPPORTED; a setting
 * beyond `settings` or a camera beyond `cameras` ARGUMENT. Several cameras, none of which has pairs between two of its
 * own images, NO_SAMPLES.
 * Method DEBEVEC: an image whose exposure is not known, a falloff that is free or a response that is not ARGUMENT.
 * Method RADIANCE: pairs that have an end in common (image, position and values) are joined to a track.
 * Errors: indices, values outside 0..1, unusable options ARGUMENT; NaN NOT_FINITE; no pairs NO_SAMPLES;
 * nothing free NO_UNKNOWNS; a method that this version lacks UNSUPPORTED; CANCELLED; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_overlap(const lensprof_fit_options *options,
                                                                    const lensprof_fit_image *images,
                                                                    uint32_t image_count, const lensprof_pair *pairs,
                                                                    uint32_t pair_count, lensprof_exposure *exposures,
                                                                    lensprof_fit_result *result, lensprof_error *error);

/* Fits the tracks of `observation_count` observations, given in any order, by the method `radiance`; options, exposures
 * and result as for lensprof_fit_overlap. Pairs in the result are neighbouring unsaturated observations of a track.
 * Errors: as there; and a point with one observation, or with two of one image, ARGUMENT; no point with two
 * observations that are neither black nor saturated NO_SAMPLES; another method UNSUPPORTED. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status
lensprof_fit_radiance(const lensprof_fit_options *options, const lensprof_fit_image *images, uint32_t image_count,
                      const lensprof_observation *observations, uint32_t observation_count,
                      lensprof_exposure *exposures, lensprof_fit_result *result, lensprof_error *error);

/* Puts what a fit found into an initialised profile, to be stored or applied: response, vignettings, covariance, no
 * gain grid, and in its provenance method (that of the options), software, pictures and pairs (with those of the
 * profile that is in the result as its prior), heldout_rms, inlier_share, not_usable and doubt (none, or that the
 * pictures do not show the response). All else stays: key, source, time, prior_id and forced are the caller's to set.
 * options: those of the fit, whose profile is read; NULL = not known. image_count: of the fit; pictures that it left
 * out do not count. Errors: ARGUMENT, also for a result that no fit has filled; STRUCT_SIZE; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_profile_from_fit(lensprof_profile *profile,
                                                                         const lensprof_fit_result *result,
                                                                         const lensprof_fit_options *options,
                                                                         uint32_t image_count, lensprof_error *error);

/* Puts what a fit found of a lens setting in the place of the reference's, so that lensprof_profile_from_fit makes its
 * profile (give that function setting->images as the number of images). Vignetting, radius_ends, pairs, covariance,
 * gamma_direction, usable and reason are the setting's then, and left_out is 0. Errors: ARGUMENT, also for a setting
 * without images; STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_result_take_setting(lensprof_fit_result *result,
                                                                                const lensprof_fit_setting *setting,
                                                                                lensprof_error *error);
/* The same of a camera of several: what its own fit found takes the place of that of the reference's camera. The result
 * is not usable until one of its settings is taken. Errors: ARGUMENT, also for a camera without images; STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_result_take_camera(lensprof_fit_result *result,
                                                                               const lensprof_fit_camera *camera,
                                                                               lensprof_error *error);

/* Root mean square of the symmetric transfer residual (levels of 255) and, when not NULL, its median absolute
 * value, of pairs under a given model (vignetting of the three channels, of all settings): the figure that
 * lensprof_fit_result.heldout_rms states. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_transfer_rms(
    const lensprof_response *response, const lensprof_vignetting vignetting[3], const lensprof_fit_image *images,
    const lensprof_exposure *exposures, uint32_t image_count, const lensprof_pair *pairs, uint32_t pair_count,
    uint32_t channels, double *rms, double *median, lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
