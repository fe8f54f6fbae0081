/* What the examples of the headers run in: the variables that base.h states, which header_examples.py declares, with
 * three overlapping pictures, one of a card, a raw frame with its rendering, and a database. All show the same lens: 65
 * % of the light in the corner.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#define WIDTH 480
#define HEIGHT 320

static uint8_t pixels[4][HEIGHT][WIDTH][3];
static uint16_t raw_pixels[HEIGHT][WIDTH][3];

/* Half of white, or a scene of soft waves in the direction (longitude, latitude). */
static double light_of(const double *to, int c) {
    if (!to) return 0.5;
    return 0.22 + 0.12 * sin(9 * to[0] + c) * cos(7 * to[1]) + 0.06 * sin(41 * to[0] + 53 * to[1])
           + 0.02 * sin(97 * to[0] - 89 * to[1]);
}

/* A picture of the scene by a typical camera, or a linear one of a card. */
static void draw(uint8_t (*rows)[WIDTH][3], const lensprof_camera *camera, double ev) {
    lensprof_response typical;
    status = lensprof_response_set_typical(&typical, LENSPROF_CAMERA_ANY, NULL, NULL);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double dx = x - (WIDTH - 1) / 2.0, dy = y - (HEIGHT - 1) / 2.0;
            const double m = 1.0 - 0.35 * 4.0 * (dx * dx + dy * dy) / (WIDTH * WIDTH + HEIGHT * HEIGHT);
            double to[2];
            if (camera && !lensprof_camera_unproject(camera, x, y, to)) continue;
            for (int c = 0; c < 3; c++) {
                const double light = fmin(light_of(camera ? to : NULL, c) * m * exp2(ev), 1.0);
                const double grey = camera ? lensprof_response_eval(&typical, light, NULL) : light;
                rows[y][x][c] = (uint8_t)(255.0 * grey + 0.5);
            }
        }
}

/* A raw frame that the camera renders as the first picture. */
static void draw_raw(void) {
    lensprof_response typical;
    status = lensprof_response_set_typical(&typical, LENSPROF_CAMERA_ANY, NULL, NULL);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++) {
                const double light = lensprof_response_invert(&typical, pixels[0][y][x][c] / 255.0, NULL);
                raw_pixels[y][x][c] = (uint16_t)(60000.0 * light);
            }
    raw = (lensprof_image){raw_pixels, WIDTH * 6, WIDTH, HEIGHT, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB};
    jpeg = images[0];
}

static void set_views(uint8_t (*rows)[WIDTH][3], lensprof_image *read, lensprof_target *written) {
    *read = (lensprof_image){rows, WIDTH * 3, WIDTH, HEIGHT, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    *written = (lensprof_target){rows, WIDTH * 3, WIDTH, HEIGHT, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
}

static void prepare(void) {
    for (int i = 0; i < 3; i++) {
        cameras[i] = (lensprof_camera){.width = WIDTH, .height = HEIGHT, .hfov_deg = 50.0, .yaw_deg = 20.0 * i};
        draw(pixels[i], &cameras[i], i == 1 ? 0.5 : 0.0);
        set_views(pixels[i], &images[i], &pictures[i]);
    }
    draw_raw();
    draw(pixels[3], NULL, 0.0);
    set_views(pixels[3], &image, &picture);
    lensprof_profile_init(&profile);
    strcpy(profile.key.lens, "Acme 50mm f/1.8");
    profile.key.focal_mm = 50, profile.key.aperture = 2.8, profile.key.crop_factor = 1.5;
    profile.vignetting[0].k[0] = -0.35;
    status = lensprof_store_open("lenses.db", LENSPROF_STORE_CREATE, &store, &error);
    if (status == LENSPROF_OK) status = lensprof_store_put(store, &profile, NULL, &error);
    lensprof_store_close(store);
    store = NULL;
}

static void example(void);

int main(void) {
    prepare();
    if (status == LENSPROF_OK) example();
    const double corner = lensprof_profile_corner_falloff(&profile, 0, NULL);
    if (status == LENSPROF_OK && fabs(corner - 0.65) < 0.02 && !profile.provenance.not_usable) return 0;
    fprintf(stderr, "%s: %s; corner of the profile %.3f, not 0.65\n", lensprof_status_name(status), error.text, corner);
    return 1;
}
