/* correct_fixed - a camera without a floating-point unit does it in integers; with the plan that a PC prepared, which
 * stays in flash, or with one that it prepares itself (-DPREPARE_HERE). */
#include "demo.h"

#ifdef PREPARE_HERE
static uint32_t memory[1 << 10]; /* 4 KiB; see lensprof_fixed_plan_bytes */

static lensprof_status get_plan(const lensprof_fixed_plan **plan) {
    lensprof_apply_options options;
    set_options(&options);
    options.blob = camera_blob;
    options.blob_bytes = camera_blob_bytes;
    put_number("plan: bytes ", (uint32_t)lensprof_fixed_plan_bytes(&options));
    return lensprof_fixed_plan_init(memory, sizeof memory, &options, plan, NULL);
}
#else
static lensprof_status get_plan(const lensprof_fixed_plan **plan) {
    return lensprof_fixed_plan_open(fixed_plan, fixed_plan_bytes, plan);
}
#endif

int main(void) {
    static uint8_t row[3 * STRIP_WIDTH];
    const lensprof_fixed_plan *plan;
    lensprof_status status;
    uint32_t ticks = 0;

    paint_stack();
    status = get_plan(&plan);
    put_number("plan: stack ", deepest_stack());
    paint_stack();
    for (uint32_t y = 0; y < STRIP_ROWS && status == LENSPROF_OK; y++) {
        const lensprof_image source = {strip + y * sizeof row, 0, STRIP_WIDTH, 1, LENSPROF_SAMPLE_U8,
                                       LENSPROF_LAYOUT_RGB};
        const lensprof_target target = {row, 0, STRIP_WIDTH, 1, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB};
        const uint32_t before = clock_ticks();
        status = lensprof_fixed_apply(plan, &source, &target, 0, y);
        ticks += (before - clock_ticks()) & 0xFFFFFF;
        if (y == STRIP_ROWS - 1) put_number("apply: stack ", deepest_stack());
        put_row("fixed", row);
    }
    put_number("apply: ticks ", ticks);
    if (status != LENSPROF_OK) put_text("cannot correct\n");
    return status != LENSPROF_OK;
}
