/* lensprof/fit.h - recover response, vignetting, exposure and white balance from correspondences.
 *
 * Example: self-calibration from three overlapping pictures, which are then corrected and equalised in place.
 *
 *     static lensprof_pair pairs[2000];
 *     lensprof_sample_image samples[3]; lensprof_fit_image fitted[3]; lensprof_exposure exposures[3]; uint32_t count;
 *     lensprof_sample_options sampling; lensprof_fit_options options; lensprof_fit *fit = NULL;
 *     lensprof_sample_options_init(&sampling), lensprof_fit_options_init(&options), lensprof_profile_init(&profile);
 *     for (uint32_t i = 0; i < 3; i++) {
 *         lensprof_sample_image_init(&samples[i]), samples[i].view = images[i], samples[i].camera = cameras[i];
 *         lensprof_fit_image_init(&fitted[i], i, images[i].width, images[i].height);
 *     }
 *     status = lensprof_sample_overlap(&sampling, samples, 3, pairs, 2000, &count, &error);
 *     if (status == LENSPROF_OK)
 *         status = lensprof_fit_overlap(&options, fitted, 3, pairs, count, NULL, 0, exposures, &fit, &error);
 *     if (status == LENSPROF_OK) status = lensprof_fit_profile(fit, LENSPROF_FIT_REFERENCE, &profile, &error);
 *     for (uint32_t i = 0; i < 3 && status == LENSPROF_OK; i++)
 *         status = lensprof_correct(&profile, &exposures[i], &pictures[i], &error);
 *     lensprof_fit_destroy(fit);
 *
 * Method `radiance` (Goldman & Chen 2005) minimises the error of every grey value,
 *     B_xi - f( e_i w_i M(r_xi) L_x )                                             (equations 2, 3, 11, 12)
 * over the unknowns of `transfer` and the radiance L of every scene point x that is observed in two or more images.
 *
 * Method `transfer` (d'Angelo 2007) minimises the symmetric grey value transfer error
 *     B1 - f( g(B2) s1/s2 )   and   B2 - f( g(B1) s2/s1 ),      s = M e w            (equations 5, 8, 10)
 * over one response f (EMoR) per camera, one vignetting M per lens setting, and the exposure and white balance of every
 * image.
 *
 * Method `transfer-function` (Kim & Pollefeys 2004) finds the most likely brightness transfer function of every image
 * pair and channel from its joint histogram. It then solves linear least squares for ln f^-1 and the log exposures
 * (equations 5 to 13), alternating with the vignetting. Here `modes` counts components of ln f^-1, and the response of
 * the result has all EMoR modes. SQUARED loss is the variant of the paper; iterations are rounds, at most 20. Pictures
 * that differ by less than 0.15 EV are not usable.
 *
 * Threads: calls are independent. One call uses up to the number of threads in its options, and joins them before it
 * returns; progress is reported on the caller's thread. The result does not depend on that number: same input, same
 * bytes.
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

/* Free parameters. RESPONSE to CENTER: lensprof_fit_options.free. EV, RED, BLUE: lensprof_fit_image.free. */
#define LENSPROF_FREE_RESPONSE 0x01u
#define LENSPROF_FREE_K1 0x02u
#define LENSPROF_FREE_K2 0x04u
#define LENSPROF_FREE_K3 0x08u
#define LENSPROF_FREE_CENTER 0x10u
#define LENSPROF_FREE_EV 0x20u
#define LENSPROF_FREE_RED 0x40u
#define LENSPROF_FREE_BLUE 0x80u

/* The falloff about its centre; everything that belongs to camera and lens; and everything of one image. */
#define LENSPROF_FREE_FALLOFF (LENSPROF_FREE_K1 | LENSPROF_FREE_K2 | LENSPROF_FREE_K3)
#define LENSPROF_FREE_LENS (LENSPROF_FREE_RESPONSE | LENSPROF_FREE_FALLOFF | LENSPROF_FREE_CENTER)
#define LENSPROF_FREE_IMAGE (LENSPROF_FREE_EV | LENSPROF_FREE_RED | LENSPROF_FREE_BLUE)

#define LENSPROF_SETTINGS_MAX 64
#define LENSPROF_CAMERAS_MAX 64

/* Estimation method. All methods give the same kind of result. */
typedef enum lensprof_fit_method {
    LENSPROF_METHOD_TRANSFER = 0, /* default: d'Angelo 2007, transfers grey values from one image to the other */
    LENSPROF_METHOD_RADIANCE = 1, /* Goldman & Chen 2005: estimates one radiance per scene point */
    LENSPROF_METHOD_TRANSFER_FUNCTION = 2 /* Kim & Pollefeys 2004: uses transfer functions of image pairs */
} lensprof_fit_method;

typedef enum lensprof_loss {
    LENSPROF_LOSS_ROBUST = 0, /* default: noise-weighted, redescending, one weight per pair */
    LENSPROF_LOSS_HUBER = 1,  /* the paper's, equation 11 */
    LENSPROF_LOSS_SQUARED = 2
} lensprof_loss;

#define LENSPROF_MODES_AUTO 0xFFFFFFFFu /* number of EMoR modes chosen by held-out error */

/* What determines the exponent gamma, which pictures alone leave open: (f, M, e) and (f o x^(1/gamma), M^gamma,
 * e^gamma) give the same pictures. */
typedef enum lensprof_gamma_from {
    LENSPROF_GAMMA_AUTO = 0,      /* default: known exposures and the prior, weighted by their standard errors */
    LENSPROF_GAMMA_PRIOR = 1,     /* only the priors on response and falloff */
    LENSPROF_GAMMA_EXPOSURES = 2, /* only known_ev of the images; the prior if these do not differ */
    LENSPROF_GAMMA_KNOWN = 3,     /* results only: fixed parameters, i.e. response, falloff or exposures */
    LENSPROF_GAMMA_NONE = 4, /* results only: nothing, as there is no prior (the paper's method): gamma is arbitrary */
    LENSPROF_GAMMA_PROFILE = 5, /* results only: the response of the profile given as the prior */
    LENSPROF_GAMMA_FALLOFF = 6, /* results only: the falloff of that profile, which fixes the depth of M */
    LENSPROF_GAMMA_CAMERAS = 7  /* results only: another camera of the fit, whose gamma is known better */
} lensprof_gamma_from;

/* One image of a fit. */
typedef struct lensprof_fit_image {
    uint32_t struct_size;
    uint32_t width, height;   /* full frame, px */
    uint32_t free;            /* LENSPROF_FREE_EV | _RED | _BLUE */
    uint32_t ev_of;           /* index of the image whose ev this one shares (links); own index = not shared */
    uint32_t red_of, blue_of; /* the same for the white balance factors */
    uint32_t setting; /* 0..LENSPROF_SETTINGS_MAX - 1: images of one lens at the same focal length, aperture and focus
                         share a setting. Each setting has its own vignetting, with TRANSFER and RADIANCE only */
    lensprof_exposure exposure; /* value if fixed, otherwise unused */
    double known_ev;            /* exposure from another source (EXIF), EV up to a common offset: a soft observation */
    double known_ev_sigma; /* standard error of known_ev, 0.001..100 EV; 0 = unknown. About 0.1 for rounded EXIF; values
                              below 0.02 count as 0.02. Only differences matter, so a single known_ev has no effect */
    uint32_t camera;   /* 0..LENSPROF_CAMERAS_MAX - 1: each camera has its own response if that is free. All images of a
                          setting belong to one camera. Fixed or known exposures apply relative to other images of the
                          same camera */
    uint32_t reserved; /* 0 */
    double f_number_ratio; /* f-number over the widest one of the lens, 1..1024: 1 wide open, 2 two stops down; 0 =
                              unknown. Selects the lenses whose falloffs a falloff that pictures leave open resembles */
    double crop_factor;    /* diagonal of 36 x 24 mm over that of the sensor, 0.1..100; 0 = unknown. The same */
} lensprof_fit_image;

/* Image `index` of the array, with a frame of width x height px: setting 0, camera 0; exposure and white balance not
 * shared, free, 0 EV and 1, 1, 1 if fixed; no known exposure. */
LENSPROF_API void lensprof_fit_image_init_sized(lensprof_fit_image *image, size_t size, uint32_t index, uint32_t width,
                                                uint32_t height);
static inline void lensprof_fit_image_init(lensprof_fit_image *image, uint32_t index, uint32_t width, uint32_t height) {
    lensprof_fit_image_init_sized(image, sizeof *image, index, width, height);
}

/* Origin of the response of a result. */
typedef enum lensprof_fit_response {
    LENSPROF_FIT_RESPONSE_PICTURES = 0, /* fitted */
    LENSPROF_FIT_RESPONSE_OPTIONS = 1,  /* fixed to the given response */
    LENSPROF_FIT_RESPONSE_KIND = 2, /* the pictures do not show it: the typical response of the kind of camera, with the
                                       covariance of that kind */
    LENSPROF_FIT_RESPONSE_PROFILE = 3 /* the pictures do not show it: that of the profile given as the prior */
} lensprof_fit_response;

/* What a result consists of: the most complex description of the pictures that predicts held-out pairs better than all
 * simpler ones. */
typedef enum lensprof_fit_model {
    LENSPROF_FIT_MODEL_FULL = 0,      /* everything that was free */
    LENSPROF_FIT_MODEL_LENS = 1,      /* exposures and white balances, and the falloff of the profile as it is */
    LENSPROF_FIT_MODEL_EXPOSURES = 2, /* exposures and white balances alone, with the typical response of the kind */
    LENSPROF_FIT_MODEL_NOTHING = 3    /* none of these is better than the pictures as they are. The members are those of
                                         the full description, which should not be applied */
} lensprof_fit_model;

/* How lensprof_fit_options.profile was used. */
typedef enum lensprof_profile_prior {
    LENSPROF_PROFILE_PRIOR_NONE = 0,               /* no profile was given */
    LENSPROF_PROFILE_PRIOR_USED = 1,               /* combined with the pictures; the result supersedes it */
    LENSPROF_PROFILE_PRIOR_OVERRULED = 2,          /* the pictures contradict it: not used, as a finding states */
    LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED = 3, /* only its response was not used; its falloff was */
    LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED = 4   /* only its falloff was not used; its response was */
} lensprof_profile_prior;

typedef struct lensprof_fit_options {
    uint32_t struct_size;
    uint32_t channels;   /* 1 or 3 */
    uint32_t reference;  /* image that fixes the gauge: its ev and white balance stay as given */
    uint32_t free;       /* LENSPROF_FREE_RESPONSE .. _CENTER */
    uint32_t modes;      /* EMoR modes, 0..25, or LENSPROF_MODES_AUTO */
    uint32_t loss;       /* lensprof_loss */
    double huber_levels; /* HUBER: sigma in levels of 255 (paper: 5) */
    double prior_weight; /* weight of the priors on response, vignetting and centre; 0 = none (paper), 1 = default */
    uint32_t max_iterations;
    uint32_t vignettings; /* falloff curves: 1 for all channels, 3, or 0 = chosen by held-out error */
    uint32_t gamma_from;  /* lensprof_gamma_from */
    uint32_t camera_kind; /* lensprof_camera_kind: selects the exponents of the prior. LINEAR fixes a linear response */
    uint32_t threads;     /* maximum number, including the caller's; 0 = one per core. Does not affect the result */
    uint32_t method;      /* lensprof_fit_method */
    uint32_t refine; /* 1: the response leaves the EMoR modes, is free at every grey level and becomes a TABLE, unless
                        held-out pairs get clearly worse. Requires pairs of all grey levels. Only for TRANSFER with at
                        most 256 images and at least 100 pairs, otherwise no effect. 0 = EMoR only */
    uint32_t moving_camera; /* 1: the camera moved between the images, so that pairs show objects from other sides,
                               which resembles falloff: a finding notes few images. 0 = it only rotated */
    const lensprof_profile *profile;   /* profile of the same camera, lens and setting from other pictures; replaces the
                                          prior of all cameras. Used are its falloff and EMoR response if they have a
                                          covariance, and a TABLE response if gamma_sigma is above 0, as for refined
                                          responses; at least one of them is required. TRANSFER and RADIANCE with a
                                          prior_weight above 0 only. Response and falloff are each overruled if held-out
                                          pairs are clearly worse with them (three standard errors), or if the falloff or
                                          the shape of the response deviates by five. The falloff applies to the setting
                                          of the reference. NULL = none. Read during the call */
    const lensprof_response *response; /* the response if it is fixed; NULL = EMoR mean. Read during the call */
    lensprof_vignetting vignetting;    /* values of fixed parameters, for all settings */
    lensprof_progress progress;        /* or NULL */
    void *progress_user;
    const lensprof_link *links; /* links reported by sampling: a usable result warns of images connected only by links
                                   without texture. NULL = unknown. Read during the call */
    uint32_t link_count;
    uint32_t unlinked_images; /* images of the same set that overlap none of these and are not among them: if there are
                                 links and none is verified, they count against a result of fewer images. 0 = none */
    const uint32_t *points;   /* of lensprof_fit_overlap, per pair: the scene point that it shows, any number. For pairs
                                 that a reconstruction matched in images of a moving camera: glossy points are left out;
                                 errors of exposures and white balances include the difference between fits of two halves
                                 of the points, if both can be fitted; exposures alone are the result if colours of points
                                 agree as well with them, and all images are then of setting 0 and camera 0 of the fit;
                                 and `equalizes` states whether colours agree. No effect if `free` is 0. Takes up to ten
                                 fits. NULL = none. Read during the call */
    const double *view_distances; /* with points, per pair: how far its two views are apart, e.g. the angle between
                                     them; only ratios count. Two visits in different light are refused, which takes
                                     views as close as others to tell. NULL = all alike. Read during the call */
} lensprof_fit_options;

/* 3 channels, reference 0, everything free, modes AUTO, loss ROBUST, Huber 5 levels, prior weight 1,
 * 200 iterations, vignettings and gamma AUTO, any camera, threads on all cores. */
LENSPROF_API void lensprof_fit_options_init_sized(lensprof_fit_options *options, size_t size);
static inline void lensprof_fit_options_init(lensprof_fit_options *options) {
    lensprof_fit_options_init_sized(options, sizeof *options);
}

/* A fit: what the calls below found, asked by image, lens setting and camera. Calls on one fit may run in several
 * threads. */
typedef struct lensprof_fit lensprof_fit;

/* How well one image is determined. */
typedef struct lensprof_fit_image_quality {
    uint32_t struct_size;
    uint32_t joined; /* 1: consistent pairs connect it to the reference of the result; 0: it was left out */
    double ev_sigma; /* standard error of ev, EV; 0 if fixed or not determined */
    double white_balance_sigma[3]; /* standard errors of the factors */
    double median_residual;        /* median absolute transfer residual of its pairs, levels of 255; 0 without pairs */
    double known_ev_residual;      /* ev minus known_ev minus the common offset, EV; 0 if unknown */
    double radius;                 /* largest r of a pair, half diagonals */
    double grey_low, grey_high;    /* 5 % and 95 % quantile of its grey values, 0..1 */
    uint32_t pairs;
    uint32_t inliers;           /* pairs within 3 sigma of the noise */
    uint32_t component;         /* smallest index of an image connected to it through pairs, or of its visit */
    uint32_t known_ev_left_out; /* 1: known_ev contradicts the pictures and the known_ev of others, and was not used */
} lensprof_fit_image_quality;

/* No pairs, left out. */
static inline void lensprof_fit_image_quality_init(lensprof_fit_image_quality *quality) {
    lensprof_init_sized(quality, sizeof *quality);
}

#define LENSPROF_COVERAGE_BINS 10

/* The result for one lens setting: of the setting itself, of its camera's fit, and of the whole fit. */
typedef struct lensprof_fit_result {
    uint32_t struct_size;

    /* The lens setting. */
    uint32_t images;        /* of this setting in the fit; if 0, the other members have no meaning */
    uint32_t setting_pairs; /* pairs with an end in these images */
    uint32_t usable;        /* 1: response and vignetting are a profile to store; 0: not, as the findings state */
    uint32_t findings;      /* number of lensprof_fit_finding_at: refusals, then warnings, then notes; */
    uint32_t passed;        /* after them, the rules that hold */
    uint32_t reserved;      /* 0 */
    lensprof_vignetting vignetting[3]; /* per channel; all equal if `vignettings` is 1; they share one centre */
    uint32_t radius_ends[LENSPROF_COVERAGE_BINS]; /* pair ends in rings of r, each 1/10 half diagonal wide */
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX]; /* includes the uncertainty of the data, of
                                                                             gamma and of a prior profile */
    double gamma_direction[LENSPROF_COVARIANCE_MAX]; /* change of each parameter per unit of ln gamma */

    /* Its camera. */
    uint32_t camera;
    uint32_t covariance_size; /* order as in profile.h; fixed parameters have zero rows; 0 = not determined */
    lensprof_response response;
    uint32_t vignettings;   /* falloff curves: 1 or 3 */
    uint32_t pairs;         /* pairs used by the camera's fit */
    uint32_t equalizes;     /* 1: the result equalises these pictures, whether or not it is a profile to store: held-out
                           pairs differ far less than before, and no two images differ more */
    uint32_t response_from; /* lensprof_fit_response */
    uint32_t profile_prior; /* lensprof_profile_prior */
    uint32_t gamma_from;    /* main source of gamma: PRIOR, EXPOSURES, KNOWN, NONE, PROFILE, FALLOFF or CAMERAS */
    double gamma_sigma;     /* standard error of ln gamma; 0 for KNOWN, LENSPROF_UNKNOWN for NONE */
    double before_rms;      /* |B1 - B2| of the held-out pairs, levels of 255 */
    double heldout_rms;     /* transfer residual of held-out pairs, levels of 255 */
    double heldout_median;  /* median absolute transfer residual of held-out pairs, levels of 255 */
    double noise_levels;    /* estimated noise of a sample, levels of 255 */
    double inlier_share;    /* share of pairs within 3 sigma of the noise */
    double frame_share; /* share of the inliers' residual variance explained by one map over the frame: the falloff is
                           not radial. 0 for pure noise */
    double image_share; /* further share explained by a separate map per image, which no camera model explains (local
                           tone mapping, changing light). 0 for pure noise */
    double irradiance_spread_ev; /* root mean square difference of the light at the two ends of a pair, EV; the response
                               is estimated from these differences */
    uint32_t grey_ends[LENSPROF_COVERAGE_BINS]; /* pair ends in tenths of the grey range, all channels */
    uint32_t converged;
    uint32_t iterations;
    uint32_t model;           /* lensprof_fit_model */
    uint32_t equal_exposures; /* 1: no exposure of the camera was known and its pictures show no difference, so that
                                 they are taken as equal */
    /* How far the pictures alone are from what is known of lenses, in combined standard errors: their falloff, and the
     * centre of it. That knowledge loses weight where pictures clearly contradict it. The farthest of all settings; 0
     * if not estimated, or without a prior */
    double falloff_prior_distance, center_prior_distance;
    double error_inflation; /* variance of the falloff over that of independent pairs, at least 1: pairs that lie
                               together have errors in common. Standard errors include it */

    /* The whole fit. */
    uint32_t reference;  /* image that fixes the gauge: that of the options; if that one was left out, the first of the
                            group; if its camera's pictures are not equalised, one of the camera with the most images
                            that are */
    uint32_t left_out;   /* images not in the largest consistent group, which the fit excludes */
    uint32_t components; /* connected groups of images; 1 if all are connected */
    uint32_t setting_count; /* lens settings: 1 + the largest number given */
    uint32_t camera_count;  /* cameras: 1 + the largest number given */
    uint32_t reserved2;     /* 0 */
    double seconds;         /* time taken by the solver */
    /* With points: variance of a point's colour over the images that see it, levels of 255 squared: mean over channels
     * and over the 90 % of the pairs that differ least, of half the squared difference. Of the images as they are,
     * corrected by exposures and white balances alone (LENSPROF_UNKNOWN if these are fixed), and by the result. Without
     * points 0 */
    double colour_variance_before, colour_variance_exposures_only, colour_variance;
} lensprof_fit_result;

/* No images. */
static inline void lensprof_fit_result_init(lensprof_fit_result *result) {
    lensprof_init_sized(result, sizeof *result);
}

/* How one of several cameras joins the others. Each has a fit of its own, on the pairs between its own images. Pairs
 * with other cameras then connect it to the camera of the reference: together with what each fit knows, they determine
 * the exponent gamma with which both cameras see the same light, and the offset of its exposures per channel. */
typedef struct lensprof_fit_camera {
    uint32_t struct_size;
    uint32_t images; /* images of this camera in its fit; if 0, no pairs connect two of its images */
    uint32_t joined; /* 1: its exposures are relative to the reference; 0: too few pairs with other cameras, or most of
                        these contradict it; the ev of its images is NaN */
    uint32_t shared_pairs;           /* pairs between it and another camera that joined */
    double agreeing_share;           /* share of the shared pairs within 3 sigma of the residual */
    double irradiance_difference_ev; /* median absolute difference of the light at their ends, EV */
    double log_gamma;                /* shift of its own fit along its family, to agree with the others */
    double offset_sigma_ev; /* standard error of the offset of its exposures, mostly due to the light at white, which no
                               pair shows; 0 for the camera of the reference */
    uint32_t reference;     /* image whose exposure was fixed in its own fit */
    uint32_t setting;       /* setting of that image: lensprof_fit_setting_at has the result of the camera's own fit */
    uint32_t attached;      /* additional images without consistent pairs in its own fit, whose exposures follow from
                               pairs with other cameras */
    uint32_t reserved;      /* 0 */
} lensprof_fit_camera;

/* No images. */
static inline void lensprof_fit_camera_init(lensprof_fit_camera *camera) {
    lensprof_init_sized(camera, sizeof *camera);
}

/* Bytes of memory that a fit of these images takes; 0 for NULL or a setting or camera out of range. */
LENSPROF_API size_t lensprof_fit_bytes(const lensprof_fit_image *images, uint32_t image_count);

/* Fits `pair_count` pairs over `image_count` images. exposures[image_count] receives exposure and white balance of
 * every image, relative to the reference. *fit receives the rest: in memory[size], 8-byte aligned, of at least
 * lensprof_fit_bytes, which must outlive it; or, if memory is NULL, in memory of its own. Release it with
 * lensprof_fit_destroy. A fit that ran returns OK even if the result is poor: see `usable` and `equalizes`. If not all
 * images are consistent, the fit uses the largest group that is; the ev of an image left out is NaN. Pictures of a
 * stationary camera are used all together or not at all. Method RADIANCE joins pairs that share an end (image, position
 * and values) into a track.
 * Errors: ARGUMENT for indices, values outside 0..1 and unusable options; CAPACITY for too little or unaligned memory;
 * NOT_FINITE for NaN; NO_SAMPLES without pairs, and with several cameras if none has pairs between two of its own
 * images; NO_UNKNOWNS if nothing is free; UNSUPPORTED for a method missing in this version, and for several settings of
 * one camera with TRANSFER_FUNCTION; CANCELLED; MEMORY. exposures and *fit are then unchanged. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_overlap(const lensprof_fit_options *options,
                                                                    const lensprof_fit_image *images,
                                                                    uint32_t image_count, const lensprof_pair *pairs,
                                                                    uint32_t pair_count, void *memory, size_t size,
                                                                    lensprof_exposure *exposures, lensprof_fit **fit,
                                                                    lensprof_error *error);

/* Fits the tracks of `observation_count` observations, given in any order, with the method `radiance`. The other
 * arguments are those of lensprof_fit_overlap. Pairs in the result are adjacent unsaturated observations of a track.
 * Errors: as there; also ARGUMENT for a point with one observation, or with two in one image; NO_SAMPLES if no point
 * has two observations that are neither black nor saturated; UNSUPPORTED for another method. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status
lensprof_fit_radiance(const lensprof_fit_options *options, const lensprof_fit_image *images, uint32_t image_count,
                      const lensprof_observation *observations, uint32_t observation_count, void *memory, size_t size,
                      lensprof_exposure *exposures, lensprof_fit **fit, lensprof_error *error);

/* Releases a fit, whose memory is the caller's again; NULL is allowed. */
LENSPROF_API void lensprof_fit_destroy(lensprof_fit *fit);

/* The setting of the image that fixes the gauge. */
#define LENSPROF_FIT_REFERENCE 0xFFFFFFFFu

/* What was found for image `index`, lens setting `setting` (or LENSPROF_FIT_REFERENCE) and camera `camera`. The structs
 * must be initialised. A setting or camera that no image has is empty. Errors: ARGUMENT for NULL,
 * numbers out of range, and a fit released in the caller's memory (one in memory of its own must not be used again);
 * STRUCT_SIZE. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_image_at(const lensprof_fit *fit, uint32_t index,
                                                                     lensprof_fit_image_quality *quality,
                                                                     lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_setting_at(const lensprof_fit *fit, uint32_t setting,
                                                                       lensprof_fit_result *result,
                                                                       lensprof_error *error);
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_camera_at(const lensprof_fit *fit, uint32_t camera,
                                                                      lensprof_fit_camera *result,
                                                                      lensprof_error *error);

/* Finding `index` of a lens setting (or LENSPROF_FIT_REFERENCE): of `findings`, then of `passed`. Errors: as there. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_finding_at(const lensprof_fit *fit, uint32_t setting,
                                                                       uint32_t index, lensprof_finding *finding,
                                                                       lensprof_error *error);

/* Makes the profile of a lens setting (or LENSPROF_FIT_REFERENCE), to be stored or applied: response, vignettings,
 * covariance, no gain grid, in an initialised *profile. Sets in the provenance: method, software, pictures and pairs
 * (including those of a prior profile that the result contains), heldout_rms, inlier_share, not_usable and doubt
 * (empty, or that the pictures do not show the response). Leaves the rest to the caller: key, source, time, prior_id
 * and forced. Errors: as lensprof_fit_setting_at, ARGUMENT also for a setting without images; MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_profile(const lensprof_fit *fit, uint32_t setting,
                                                                    lensprof_profile *profile, lensprof_error *error);

/* Root mean square of the symmetric transfer residual of pairs under a fit (levels of 255) and, if not NULL, its median
 * absolute value: the figure in lensprof_fit_result.heldout_rms. Errors: those of lensprof_fit_overlap; ARGUMENT also
 * for a released fit and an image that was left out. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_transfer_rms(const lensprof_fit *fit,
                                                                         const lensprof_pair *pairs,
                                                                         uint32_t pair_count, double *rms,
                                                                         double *median, lensprof_error *error);

/* Half the squared difference of the colours at the two ends of each pair, levels of 255 squared, mean over the
 * channels, corrected by a fit to the mean exposure: of colour_variance. NaN for pairs of images left out. Errors:
 * those of lensprof_fit_transfer_rms, except for images left out. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_fit_colour_differences(const lensprof_fit *fit,
                                                                               const lensprof_pair *pairs,
                                                                               uint32_t pair_count, double *differences,
                                                                               lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
