/* correct_pixels - apply a profile to pixels in memory: no heap, no file. Links with liblensprof-core.a alone. */
#include <stdio.h>

#include <lensprof/apply.h>
#include <lensprof/profile.h>

#define WIDTH 8
#define HEIGHT 6

static lensprof_profile profile;      /* 50 kB: not for a small stack */
static uint64_t plan_memory[1 << 14]; /* see lensprof_plan_bytes; 64-bit elements are aligned as it needs */

/* A white wall as this camera records it: sRGB-like gamma, a fifth of the light lost in the corners. */
static int make_profile(void) {
    lensprof_profile_init(&profile);
    profile.vignetting[0].k[0] = -0.2;
    return lensprof_response_set_gamma(&profile.response[0], 2.2) == LENSPROF_OK;
}

static int correct(uint8_t pixels[HEIGHT][WIDTH][3]) {
    const lensprof_plan *plan;
    lensprof_apply_options options;
    lensprof_target picture = {pixels, WIDTH * 3, WIDTH, HEIGHT, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    lensprof_error error;
    lensprof_status status;

    error.text[0] = 0;
    lensprof_apply_options_init(&options);
    options.frame_width = WIDTH;
    options.frame_height = HEIGHT;
    status = lensprof_apply_options_set_profile(&options, &profile);
    if (status == LENSPROF_OK) status = lensprof_plan_init(plan_memory, sizeof plan_memory, &options, &plan, &error);
    if (status == LENSPROF_OK) status = lensprof_apply(plan, NULL, &picture, 0, 0);
    if (status != LENSPROF_OK) printf("cannot correct: %s: %s\n", lensprof_status_name(status), error.text);
    return status == LENSPROF_OK;
}

int main(void) {
    static uint8_t pixels[HEIGHT][WIDTH][3];
    int x, y, c;

    if (!make_profile()) return 1;
    for (y = 0; y < HEIGHT; y++)
        for (x = 0; x < WIDTH; x++) {
            double r2 = lensprof_vignetting_r2(&profile.vignetting[0], WIDTH, HEIGHT, x, y, NULL);
            double light = 0.3 * lensprof_vignetting_eval(&profile.vignetting[0], r2, NULL);
            for (c = 0; c < 3; c++)
                pixels[y][x][c] = (uint8_t)(255.0 * lensprof_response_eval(&profile.response[0], light, NULL) + 0.5);
        }
    printf("as recorded: corner %d, middle %d\n", pixels[0][0][1], pixels[HEIGHT / 2][WIDTH / 2][1]);
    if (!correct(pixels)) return 1;
    printf("corrected:   corner %d, middle %d\n", pixels[0][0][1], pixels[HEIGHT / 2][WIDTH / 2][1]);
    return 0;
}
