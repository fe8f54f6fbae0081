/* lensprof/model.h - the camera model: response, vignetting, exposure.
 *
 * Example: the falloff in a corner, and the grey values of half the light of white there and in the centre.
 *
 *     lensprof_vignetting falloff = {{-0.3, 0.05, -0.1}, {0.0, 0.0}};
 *     lensprof_response response;
 *     double corner = lensprof_vignetting_eval(&falloff, 1.0, NULL); // r^2 = 1
 *     status = lensprof_response_set_gamma(&response, 2.2);
 *     printf("M = %.2f; %.0f instead of %.0f\n", corner, 255.0 * lensprof_response_eval(&response, 0.5 * corner, NULL),
 *            255.0 * lensprof_response_eval(&response, 0.5, NULL));
 *
 *     B = f( L * M(r) * e * w )                                    d'Angelo 2007, equations 1 and 3
 *
 *   B  grey value 0..1            f  response, [0,1] -> [0,1], non-decreasing, f(0) = 0, f(1) = 1
 *   L  scene radiance             M  vignetting (attenuation), M = 1 at the centre
 *   e  exposure factor 2^ev       w  white balance factor of the channel, green = 1
 *
 * A sample of a picture is B itself or, with levels, black + (white - black) B.
 *
 * Only the core implements the equations of the model. No heap, no I/O.
 * Threads: all functions are pure; any thread may call them on any data. */
#ifndef LENSPROF_MODEL_H
#define LENSPROF_MODEL_H

#include "base.h"

#ifdef __cplusplus
extern "C" {
#endif

#define LENSPROF_RESPONSE_SAMPLES 1024 /* samples of a response on the uniform irradiance grid 0..1 */
#define LENSPROF_EMOR_MODES 25         /* modes of the empirical model of response (Grossberg & Nayar 2004) */
#define LENSPROF_GRID_SIDE 32          /* maximum number of columns and of rows of a gain grid */

typedef enum lensprof_response_kind {
    LENSPROF_RESPONSE_LINEAR = 0, /* f(x) = x */
    LENSPROF_RESPONSE_GAMMA = 1,  /* f(x) = x^(1/gamma) */
    LENSPROF_RESPONSE_EMOR = 2,   /* f = f0 + sum_l emor[l] h_l, piecewise linear on the grid */
    LENSPROF_RESPONSE_TABLE = 3   /* piecewise linear through table[] */
} lensprof_response_kind;

/* A response curve. Fill it with one of the _set_ functions, which leave it valid. Frozen value struct.
 * For every kind, table[] holds f on the grid x = j/1023, so a reader may ignore the other members. */
typedef struct lensprof_response {
    uint32_t kind;                           /* lensprof_response_kind */
    uint32_t modes;                          /* EMOR: number of modes in use, 0..25; otherwise 0 */
    double gamma;                            /* GAMMA: exponent > 0; otherwise 1 */
    double emor[LENSPROF_EMOR_MODES];        /* EMOR: coefficients, 0 beyond `modes` */
    double table[LENSPROF_RESPONSE_SAMPLES]; /* f(j/1023) */
} lensprof_response;

/* f(x) = x. */
LENSPROF_API void lensprof_response_set_linear(lensprof_response *response);

/* f(x) = x^(1/gamma), gamma in [0.1, 10]. Error: RESPONSE for other values. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_response_set_gamma(lensprof_response *response, double gamma);

/* The transfer function of sRGB (IEC 61966-2-1), as a table: of pictures rendered for screens. */
LENSPROF_API void lensprof_response_set_srgb(lensprof_response *response);

/* f = f0 + sum coefficients[l] h_l for `modes` (0..25) coefficients of the EMoR model (linear domain).
 * Error: RESPONSE if the curve decreases anywhere on its grid. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_response_set_emor(lensprof_response *response,
                                                                          const double *coefficients, uint32_t modes);

/* Piecewise linear curve through `count` >= 2 values on a uniform irradiance grid, resampled to 1024 samples. values[0]
 * must be 0 and values[count-1] must be 1, each within 1e-6; both are stored exactly. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_response_set_table(lensprof_response *response,
                                                                           const double *values, uint32_t count);

/* LENSPROF_OK if kind, modes and parameters are in range and the table is finite, non-decreasing over all 1024 samples,
 * and ends at 0 and 1. Does not check that the table matches the kind and its parameters. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_response_validate(const lensprof_response *response);

/* f(x) and, if slope is not NULL, df/dx. x outside [0,1] is clamped (slope 0 there), as a sensor saturates. */
LENSPROF_API double lensprof_response_eval(const lensprof_response *response, double x, double *slope);

/* g(b) = f^-1(b): the smallest x with f(x) >= b. b outside [0,1] is clamped. If not NULL, *slope receives
 * dg/db = 1/f'(g(b)), taken in the grid interval that contains b (0 outside [0,1] and where f is flat). */
LENSPROF_API double lensprof_response_invert(const lensprof_response *response, double b, double *slope);

/* The two for `count` numbers: values[i] = f(x[i]) and irradiances[i] = g(b[i]), bit for bit those of the functions for
 * one number. The results may be the same array as the input. slopes[count] may be NULL. Nothing can fail. */
LENSPROF_API void lensprof_response_eval_many(const lensprof_response *response, const double *x, size_t count,
                                              double *values, double *slopes);
LENSPROF_API void lensprof_response_invert_many(const lensprof_response *response, const double *b, size_t count,
                                                double *irradiances, double *slopes);

/* Kinds of cameras, by how they render. The measured responses of a kind replace an unknown response. */
typedef enum lensprof_camera_kind {
    LENSPROF_CAMERA_ANY = 0,     /* unknown: a mixture of all kinds below and of gamma curves */
    LENSPROF_CAMERA_FILM = 1,    /* scanned film: 154 curves of the DoRF database */
    LENSPROF_CAMERA_DIGITAL = 2, /* digital and video cameras of the 1990s with a tone curve: 29 curves of DoRF */
    LENSPROF_CAMERA_STILL = 3,   /* JPEG of today's digital cameras: 20 curves of 19 cameras */
    LENSPROF_CAMERA_PHONE = 4,   /* JPEG of phones: 5 curves of 4 phones */
    LENSPROF_CAMERA_LINEAR = 5   /* sensor data and pictures developed linearly from it */
} lensprof_camera_kind;

/* The typical response of a kind: the mean of its measured cameras, as an EMoR response of all modes, with its scatter
 * over the cameras of the kind. covariance[LENSPROF_EMOR_MODES * LENSPROF_EMOR_MODES] (may be NULL) receives the
 * covariance of the coefficients, row major: scatter of the shape and error of gamma together. *log_gamma_sigma (may be
 * NULL) receives the standard error of ln gamma, the exponent by which response, falloff and exposures change together;
 * 68 % of the cameras that are not part of the mean lie within it. LINEAR: the linear response and zeros.
 * Error: ARGUMENT. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_response_set_typical(lensprof_response *response,
                                                                             uint32_t camera_kind, double *covariance,
                                                                             double *log_gamma_sigma);

/* The EMoR tables: mean curve f0 for mode 0, h_l for mode l = 1..25; NULL beyond. 1024 samples, static storage. */
LENSPROF_API const double *lensprof_emor_table(uint32_t mode);

/* Radial falloff M = 1 + k1 r^2 + k2 r^4 + k3 r^6 (d'Angelo eq. 7; correct = divide). Frozen value struct.
 * r = |p - c| / rho; rho = half the diagonal of the full frame, sqrt(width^2 + height^2) / 2; pixel centres are
 * integers; the frame centre is ((width-1)/2, (height-1)/2); c = frame centre + rho * center. A profile is therefore
 * independent of the resolution. */
typedef struct lensprof_vignetting {
    double k[3];      /* k1, k2, k3 */
    double center[2]; /* x (right) and y (down), in half diagonals */
} lensprof_vignetting;

/* rho: half the diagonal of a frame of width x height pixels, in px. Correctly rounded for sides below 2^26. */
LENSPROF_API double lensprof_half_diagonal(uint32_t width, uint32_t height);

/* M as a function of r^2, and its derivative dM/d(r^2) if slope is not NULL. dM/dk_n = r^(2n). */
LENSPROF_API double lensprof_vignetting_eval(const lensprof_vignetting *vignetting, double r2, double *slope);

/* The same for `count` numbers, bit for bit. `values` may be `r2`; slopes[count] may be NULL. Nothing can fail. */
LENSPROF_API void lensprof_vignetting_eval_many(const lensprof_vignetting *vignetting, const double *r2, size_t count,
                                                double *values, double *slopes);

/* r^2 of pixel (x, y) in a frame of width x height pixels. If not NULL, gradient[2] receives
 * d(r^2)/d(center x, center y). */
LENSPROF_API double lensprof_vignetting_r2(const lensprof_vignetting *vignetting, uint32_t width, uint32_t height,
                                           double x, double y, double *gradient);

/* The same for `count` pixels, bit for bit: xy[2 * count] holds x, y of each, r2[count] receives r^2, and
 * gradients[2 * count], unless NULL, the two derivatives of each. Nothing can fail. */
LENSPROF_API void lensprof_vignetting_r2_many(const lensprof_vignetting *vignetting, uint32_t width, uint32_t height,
                                              const double *xy, size_t count, double *r2, double *gradients);

/* LENSPROF_OK if the numbers are finite, |k| <= 1e6, |center| <= 1 in each coordinate, and M >= 0.001 for every r from
 * the centre to the farthest corner (in any frame shape: r <= 1 + |center|). */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_vignetting_validate(const lensprof_vignetting *vignetting);

/* Attenuation on a grid over the frame, multiplied by M. It holds what a radial polynomial cannot describe (a tilted
 * sensor, a hood, the rim of a fisheye). Bilinear between nodes; node (0, 0) lies at the first pixel of the frame, node
 * (columns-1, rows-1) at the last, so a grid is independent of the resolution. Frozen value struct (12 kB). */
typedef struct lensprof_gain_grid {
    uint32_t columns, rows; /* 2..32 each; both 0 = no grid */
    uint32_t channels;      /* 1 for all channels, or 3; 0 if there is no grid */
    uint32_t reserved;      /* 0 */
    /* [channel][row][column], without gaps: node (i, j) of channel c is attenuation[(c * rows + j) * columns + i];
     * 0 beyond the last one */
    float attenuation[3 * LENSPROF_GRID_SIDE * LENSPROF_GRID_SIDE];
} lensprof_gain_grid;

/* No grid: all zero. */
LENSPROF_API void lensprof_gain_grid_init(lensprof_gain_grid *grid);

/* LENSPROF_OK if there is no grid, or its attenuations are finite and within 0.001..1000. Errors: SIZE for invalid
 * sides; ARGUMENT for another number of channels or a nonzero value beyond the last node; NOT_FINITE; VIGNETTING for
 * attenuations out of range. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_gain_grid_validate(const lensprof_gain_grid *grid);

/* Attenuation of a valid grid at pixel (x, y), which may be fractional, of a frame of width x height pixels, in channel
 * 0, 1 or 2. Positions beyond the centres of the outermost pixels use the nearest of them. 1 if there is no grid. */
LENSPROF_API double lensprof_gain_grid_eval(const lensprof_gain_grid *grid, uint32_t width, uint32_t height, double x,
                                            double y, uint32_t channel);

/* The same for `count` pixels, bit for bit: xy[2 * count] holds x, y of each. Nothing can fail. */
LENSPROF_API void lensprof_gain_grid_eval_many(const lensprof_gain_grid *grid, uint32_t width, uint32_t height,
                                               const double *xy, size_t count, uint32_t channel, double *attenuations);

/* Samples without light and at saturation, as shares of full scale (255, 65535 or 1.0): B = (sample - black) / (white -
 * black). 12 bit sensor data with a pedestal of 256 in 16 bit samples have 256/65535 and 4095/65535. All 0 = none: B is
 * the sample. Frozen value struct. */
typedef struct lensprof_levels {
    double black[3]; /* red, green, blue; grey uses green. -0.5..1; below 0 if too much was subtracted already */
    double white;    /* more than each black by at least 0.001, and at most 1; 0 = 1 */
} lensprof_levels;

/* LENSPROF_OK if the numbers are within these ranges. Error: ARGUMENT. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_levels_validate(const lensprof_levels *levels);

/* B of a sample (0..1) in channel 0, 1 or 2, and back: neither is clipped. */
LENSPROF_API double lensprof_levels_to_value(const lensprof_levels *levels, uint32_t channel, double sample);
LENSPROF_API double lensprof_levels_to_sample(const lensprof_levels *levels, uint32_t channel, double value);

/* The circle that the lens lights up, where it does not cover the frame: that of a fisheye, or of a lens for smaller
 * sensors. What lies outside is dark: no falloff describes it, and corrections leave it alone (M = 1). Frozen value
 * struct. */
typedef struct lensprof_image_circle {
    double center[2]; /* half diagonals to the right of and below the middle of the frame, -1..1 */
    double radius;    /* half diagonals, up to 4; all 0 = the lens covers the frame, or it is not known */
} lensprof_image_circle;

/* LENSPROF_OK if the numbers are within these ranges. Error: ARGUMENT. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_image_circle_validate(const lensprof_image_circle *circle);

/* 1 if pixel (x, y), which may be fractional, of a frame of width x height pixels lies in a valid circle, or its radius
 * is 0; else 0. */
LENSPROF_API int lensprof_image_circle_contains(const lensprof_image_circle *circle, uint32_t width, uint32_t height,
                                                double x, double y);

/* Exposure and white balance of one picture. Frozen value struct. */
typedef struct lensprof_exposure {
    double ev;               /* log2 of the exposure factor; larger = more light recorded */
    double white_balance[3]; /* factors of red, green, blue; green = 1; all 1 for grey pictures */
} lensprof_exposure;

/* ev = 0, white balance 1, 1, 1. */
LENSPROF_API void lensprof_exposure_init(lensprof_exposure *exposure);

/* LENSPROF_OK if |ev| <= 64 and the factors are in [1e-6, 1e6]. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_exposure_validate(const lensprof_exposure *exposure);

/* Geometric mean of exposures and white balances (Goldman & Chen 2005, equation 15), without those whose ev is NaN. All
 * members are NaN if no others are left. */
LENSPROF_API void lensprof_exposure_mean(const lensprof_exposure *exposures, size_t count, lensprof_exposure *mean);

#ifdef __cplusplus
}
#endif
#endif
