/* correct_float - a camera with a floating-point unit corrects a frame row by row, as its sensor delivers it. */
#include "demo.h"

static uint64_t plan_memory[1 << 10]; /* 8 KiB; see lensprof_plan_bytes */

/* With a response, or with the profile of the blob when it is NULL. */
static lensprof_status correct(const char *name, const lensprof_response *response) {
    static uint8_t row[3 * STRIP_WIDTH];
    const lensprof_plan *plan;
    lensprof_apply_options options;
    lensprof_status status;
    uint32_t ticks = 0;

    set_options(&options);
    if (response) {
        options.response = response;
        options.vignetting = camera_falloff;
        options.vignettings = 3;
    } else {
        options.blob = camera_blob;
        options.blob_bytes = camera_blob_bytes;
    }
    paint_stack();
    status = lensprof_plan_init(plan_memory, sizeof plan_memory, &options, &plan, NULL);
    put_number("plan: bytes ", (uint32_t)lensprof_plan_bytes(&options));
    put_number("plan: stack ", deepest_stack());
    paint_stack();
    for (uint32_t y = 0; y < STRIP_ROWS && status == LENSPROF_OK; y++) {
        const lensprof_image source = {strip + y * sizeof row, 0, STRIP_WIDTH, 1, LENSPROF_SAMPLE_U8,
                                       LENSPROF_LAYOUT_RGB};
        const lensprof_target target = {row, 0, STRIP_WIDTH, 1, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
        const uint32_t before = clock_ticks();
        status = lensprof_apply(plan, &source, &target, 0, y);
        ticks += (before - clock_ticks()) & 0xFFFFFF;
        if (y == STRIP_ROWS - 1) put_number("apply: stack ", deepest_stack());
        put_row(name, row);
    }
    put_number("apply: ticks ", ticks);
    return status;
}

int main(void) {
    if (correct("table", NULL) != LENSPROF_OK || correct("gamma", &camera_gamma) != LENSPROF_OK) {
        put_text("cannot correct\n");
        return 1;
    }
    return 0;
}
