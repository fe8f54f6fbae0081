/* make_data - writes data.c: what the demonstrations find in flash. Runs on a PC.
 *
 * The picture is an evening over hills, rendered as light and recorded by the library's own simulation. */
#include <math.h>
#include <stdio.h>

#include <lensprof/profile.h>

#include "sensor.h"

static uint8_t blob[5000];
static size_t blob_bytes;
static lensprof_profile profile;
static lensprof_response gamma_made;

const lensprof_vignetting camera_falloff[3] = {{{-0.375, -0.0625, -0.03125}, {0.015625, -0.03125}},
                                               {{-0.40625, -0.0625, -0.03125}, {0.015625, -0.03125}},
                                               {{-0.4375, -0.0625, -0.03125}, {0.015625, -0.03125}}};

/* Light at a pixel: sky, sun, clouds, a ridge with trees. */
static double light_at(double x, double y, int channel) {
    static const double sky[3] = {0.30, 0.38, 0.55}, hill[3] = {0.05, 0.08, 0.03}, sun[3] = {1.0, 0.8, 0.5};
    const double ridge = 10.0 + 2.0 * sin(0.11 * x) + 1.5 * sin(0.37 * x + 1.0) + sin(1.7 * x);
    const double away2 = (x - 96.0) * (x - 96.0) + 6.0 * (y - 4.0) * (y - 4.0);
    const double cloud = 0.12 * sin(0.09 * x + 0.4 * y) * sin(0.05 * x - 0.3 * y);
    const double grain = 0.01 * sin(12.9898 * x + 78.233 * y);
    if (y > ridge) return hill[channel] * (1.0 + 0.4 * sin(2.3 * x) * sin(1.9 * y)) + grain * 0.5;
    return sky[channel] + cloud + grain + 1.2 * sun[channel] * exp(-away2 / 300.0);
}

static int render(uint8_t rows[STRIP_ROWS][STRIP_WIDTH][3]) {
    static float light[STRIP_ROWS][STRIP_WIDTH][3];
    static uint64_t memory[1 << 12];
    lensprof_image from = {light, sizeof light[0], STRIP_WIDTH, STRIP_ROWS, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB};
    lensprof_target to = {rows, sizeof rows[0], STRIP_WIDTH, STRIP_ROWS, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
    lensprof_apply_options options;
    const lensprof_plan *plan;

    for (int y = 0; y < STRIP_ROWS; y++)
        for (int x = 0; x < STRIP_WIDTH; x++)
            for (int c = 0; c < 3; c++) light[y][x][c] = (float)light_at(x, y, c);
    set_options(&options);
    options.blob = blob;
    options.blob_bytes = blob_bytes;
    options.direction = LENSPROF_DIRECTION_SIMULATE;
    options.input = LENSPROF_ENCODING_LINEAR;
    options.source_sample = LENSPROF_SAMPLE_F32;
    return lensprof_plan_init(memory, sizeof memory, &options, &plan, NULL) == LENSPROF_OK
           && lensprof_apply(plan, &from, &to, 0, 0) == LENSPROF_OK;
}

/* 10 bit codes of a mosaic GRBG with a pedestal of 64; the sun saturates. `is_card`: an even light behind a lens. */
static int render_raw(uint8_t *packed, uint32_t rows, int is_card) {
    for (uint32_t y = 0; y < rows; y++) {
        uint16_t row[STRIP_WIDTH];
        for (uint32_t x = 0; x < STRIP_WIDTH; x++) {
            const int channel = y % 2 ? (x % 2 ? 1 : 2) : (x % 2 ? 0 : 1);
            const double dx = (x - 79.5) / 90.0, dy = (y - 31.5) / 90.0, r2 = dx * dx + dy * dy;
            const double light = is_card ? (0.8 - 0.3 * r2) * (1.0 - 0.1 * channel) : light_at(x, y, channel);
            row[x] = (uint16_t)(light < 1.0 ? 64.5 + 959.0 * light : 1023.0);
        }
        if (lensprof_pack_row(LENSPROF_PACKING_RAW10, row, STRIP_WIDTH, packed + y * RAW_ROW_BYTES) != LENSPROF_OK)
            return 0;
    }
    return 1;
}

/* Hexadecimal floating point: exact. */
static void print_response(const char *name, const lensprof_response *r) {
    printf("\nconst lensprof_response %s = {%u, 0, %a, {0.0}, {", name, r->kind, r->gamma);
    for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) printf("%s%a,", j % 6 ? " " : "\n    ", r->table[j]);
    printf("}};\n");
}

static void print_words(const char *name, const uint32_t *words, size_t bytes) {
    printf("\nconst uint32_t %s_bytes = %u;\nconst uint32_t %s[] = {", name, (unsigned)bytes, name);
    for (size_t i = 0; i < bytes / 4; i++) printf("%s0x%08x,", i % 8 ? " " : "\n    ", words[i]);
    printf("};\n");
}

/* Integer plans for the pixels and for the raw sensor. */
static int print_plans(void) {
    static uint32_t memory[1 << 10];
    lensprof_apply_options options;
    lensprof_readout readout;
    const lensprof_fixed_plan *plan;
    const lensprof_sensor_plan *of_sensor;

    set_options(&options);
    options.blob = blob;
    options.blob_bytes = blob_bytes;
    if (lensprof_fixed_plan_init(memory, sizeof memory, &options, &plan, NULL) != LENSPROF_OK) return 0;
    print_words("fixed_plan", memory, lensprof_fixed_plan_bytes(&options));
    options.input = options.output = LENSPROF_ENCODING_LINEAR;
    if (set_readout(&readout) != LENSPROF_OK
        || lensprof_sensor_plan_init(memory, sizeof memory, &options, &readout, &of_sensor, NULL) != LENSPROF_OK)
        return 0;
    print_words("sensor_plan", memory, lensprof_sensor_plan_bytes(&readout));
    return 1;
}

/* The profile of the blob; 0 when something is wrong with it. */
static int pack(void) {
    double values[129];
    for (int i = 0; i <= 128; i++) values[i] = pow(i / 128.0, 1.0 / 2.2);
    lensprof_profile_init(&profile);
    profile.vignettings = 3;
    for (int c = 0; c < 3; c++) profile.vignetting[c] = camera_falloff[c];
    if (lensprof_response_set_table(&profile.response[0], values, 129) != LENSPROF_OK
        || lensprof_profile_pack(&profile, 0, blob, sizeof blob, &blob_bytes) != LENSPROF_OK)
        return 0;
    return 1;
}

static void print_bytes(const char *name, const uint8_t *bytes, size_t count) {
    printf("\nconst uint8_t %s[] = {", name);
    for (size_t i = 0; i < count; i++) printf("%s%d,", i % 24 ? " " : "\n    ", bytes[i]);
    printf("};\n");
}

int main(void) {
    static uint8_t rows[STRIP_ROWS][STRIP_WIDTH][3], raw[STRIP_ROWS * RAW_ROW_BYTES], card[CARD_ROWS * RAW_ROW_BYTES];
    if (!render_raw(raw, STRIP_ROWS, 0) || !render_raw(card, CARD_ROWS, 1) || !pack()
        || lensprof_response_set_gamma(&gamma_made, 2.2) != LENSPROF_OK || !render(rows))
        return 1;
    printf("/* Written by make_data. */\n#include \"data.h\"\n\nconst lensprof_vignetting camera_falloff[3] = {\n");
    for (int c = 0; c < 3; c++)
        printf("    {{%a, %a, %a}, {%a, %a}},\n", camera_falloff[c].k[0], camera_falloff[c].k[1],
               camera_falloff[c].k[2], camera_falloff[c].center[0], camera_falloff[c].center[1]);
    printf("};\n");
    print_bytes("strip", (const uint8_t *)rows, sizeof rows);
    print_bytes("raw_strip", raw, sizeof raw);
    print_bytes("raw_card", card, sizeof card);
    print_bytes("camera_blob", blob, blob_bytes);
    printf("const uint32_t camera_blob_bytes = %u;\n", (unsigned)blob_bytes);
    print_response("camera_gamma", &gamma_made);
    return print_plans() ? 0 : 1;
}
