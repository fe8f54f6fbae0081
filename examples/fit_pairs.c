/* fit_pairs - recover response, falloff and exposures from correspondences: here those of a camera that we know.
 * Pictures leave one exponent open, common to all of them, which prior knowledge of cameras decides to within some per
 * cent. */
#include <math.h>
#include <stdio.h>

#include <lensprof/fit.h>

#define IMAGES 4
#define PAIRS 3000

static const double true_ev[IMAGES] = {0.0, 0.8, -0.6, 0.3}, true_k1 = -0.35, gamma_exponent = 2.0;
static lensprof_pair pairs[PAIRS];
static lensprof_fit_result result; /* holds a covariance: not for a small stack */

static double random_number(void) /* 0..1, the same every time */
{
    static uint32_t state = 1;
    state = state * 1664525u + 1013904223u;
    return (state >> 8) / 16777216.0;
}

/* B = f( L M(r) e ), equation 1 of the header model.h, in a frame of 640 x 480. */
static double grey_value(double radiance, const double xy[2], uint32_t image) {
    double dx = xy[0] - 319.5, dy = xy[1] - 239.5, r2 = (dx * dx + dy * dy) / (400.0 * 400.0);
    return pow(radiance * (1.0 + true_k1 * r2) * pow(2.0, true_ev[image]), 1.0 / gamma_exponent);
}

static void make_pairs(void) {
    int count = 0, side, c;
    while (count < PAIRS) {
        lensprof_pair pair;
        double radiance = 0.02 + 0.9 * random_number();
        pair.image[0] = (uint32_t)(random_number() * IMAGES);
        pair.image[1] = (pair.image[0] + 1) % IMAGES;
        for (side = 0; side < 2; side++) {
            pair.xy[side][0] = random_number() * 639.0;
            pair.xy[side][1] = random_number() * 479.0;
            for (c = 0; c < 3; c++) pair.value[side][c] = grey_value(radiance, pair.xy[side], pair.image[side]);
        }
        if (pair.value[0][0] < 0.98 && pair.value[1][0] < 0.98) pairs[count++] = pair; /* not saturated */
    }
}

int main(void) {
    lensprof_fit_image images[IMAGES];
    lensprof_exposure exposures[IMAGES];
    lensprof_fit_options options;
    lensprof_fit *fit;
    lensprof_finding finding;
    lensprof_error error;
    uint32_t i;

    make_pairs();
    for (i = 0; i < IMAGES; i++) {
        lensprof_fit_image_init(&images[i], i, 640, 480);
        images[i].known_ev = true_ev[i]; /* what EXIF says, give or take a tenth: settles the exponent */
        images[i].known_ev_sigma = 0.1;
    }
    lensprof_fit_options_init(&options);
    options.channels = 1;
    lensprof_fit_result_init(&result);
    if (lensprof_fit_overlap(&options, images, IMAGES, pairs, PAIRS, NULL, 0, exposures, &fit, &error) != LENSPROF_OK
        || lensprof_fit_setting_at(fit, LENSPROF_FIT_REFERENCE, &result, &error) != LENSPROF_OK) {
        printf("%s\n", error.text);
        return 1;
    }
    printf("usable: %s, residual %.2f of 255 levels\n", result.usable ? "yes" : "no", result.heldout_rms);
    for (i = 0; i < result.findings; i++) {
        lensprof_finding_init(&finding);
        if (lensprof_fit_finding_at(fit, LENSPROF_FIT_REFERENCE, i, &finding, &error) == LENSPROF_OK)
            printf("%s\n", finding.text);
    }
    lensprof_fit_destroy(fit);
    for (i = 0; i < IMAGES; i++) printf("image %u: %+.3f EV, true %+.3f\n", i, exposures[i].ev, true_ev[i]);
    printf("light in the corner: %.3f, true %.3f\n", lensprof_vignetting_eval(&result.vignetting[0], 1.0, NULL),
           1.0 + true_k1);
    return 0;
}
