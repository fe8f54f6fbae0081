/* make_counts - writes the plans of which the instructions are counted, as C. */
#include <stdio.h>
#include <string.h>

#include <lensprof/sensor.h>

#include "counts.h"

static uint32_t memory[1 << 10];

static void print_words(const char *name, size_t bytes) {
    printf("\nconst uint32_t count_%s_plan_bytes = %u;\nconst uint32_t count_%s_plan[] = {", name, (unsigned)bytes,
           name);
    for (size_t i = 0; i < bytes / 4; i++) printf("%s0x%08x,", i % 8 ? " " : "\n    ", memory[i]);
    printf("};\n");
}

static void print_gains(const lensprof_profile *profile) {
    printf("\nconst float count_gains[3 * COUNT_ROWS * COUNT_COLUMNS] = {");
    for (uint32_t c = 0; c < 3; c++)
        for (uint32_t j = 0; j < COUNT_ROWS; j++)
            for (uint32_t i = 0; i < COUNT_COLUMNS; i++) {
                const double x = (COUNT_WIDTH - 1.0) * i / (COUNT_COLUMNS - 1);
                const double y = (COUNT_HEIGHT - 1.0) * j / (COUNT_ROWS - 1);
                const double m = lensprof_profile_falloff(profile, c, COUNT_WIDTH, COUNT_HEIGHT, x, y, NULL);
                printf("%s%.9ef,", i ? " " : j ? "\n    " : "\n   ", 1.0 / m);
            }
    printf("};\n");
}

int main(void) {
    static lensprof_profile profile;
    const lensprof_levels levels = {{256 / 65535.0, 256 / 65535.0, 256 / 65535.0}, 4095 / 65535.0};
    lensprof_apply_options options;
    lensprof_readout readout;
    const lensprof_sensor_plan *plan;
    const lensprof_fixed_plan *fixed;
    lensprof_profile_init(&profile);
    profile.vignettings = 3;
    profile.levels = levels;
    for (int c = 0; c < 3; c++)
        profile.vignetting[c] = (lensprof_vignetting){{-0.35 - 0.02 * c, -0.1, 0.03}, {0.0, 0.0}};
    lensprof_apply_options_init(&options);
    if (lensprof_apply_options_set_profile(&options, &profile) != LENSPROF_OK) return 1;
    options.frame_width = COUNT_WIDTH, options.frame_height = COUNT_HEIGHT;
    options.source_sample = options.target_sample = LENSPROF_SAMPLE_U16, options.source_layout = LENSPROF_LAYOUT_RGGB;
    lensprof_readout_init(&readout);
    readout.columns = COUNT_COLUMNS, readout.rows = COUNT_ROWS;
    if (lensprof_readout_set_mosaic(&readout, "RGGB") != LENSPROF_OK) return 1;
    printf("/* Written by make_counts. */\n#include \"counts.h\"\n");
    if (lensprof_sensor_plan_init(memory, sizeof memory, &options, &readout, &plan, NULL) != LENSPROF_OK) return 1;
    print_words("sensor", lensprof_sensor_plan_bytes(&readout));
    memset(memory, 0, sizeof memory);
    if (lensprof_fixed_plan_init(memory, sizeof memory, &options, &fixed, NULL) != LENSPROF_OK) return 1;
    print_words("fixed", lensprof_fixed_plan_bytes(&options));
    print_gains(&profile);
    return 0;
}
