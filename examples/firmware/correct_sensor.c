/* correct_sensor - packed rows of a raw sensor, corrected in place in integers while the next row arrives; with the
 * plan that a PC prepared, which stays in flash, or with one made from the profile's blob (-DPREPARE_HERE). */
#include "sensor.h"

#ifdef PREPARE_HERE
static uint32_t memory[1 << 10]; /* 4 KiB; see lensprof_sensor_plan_bytes */

static lensprof_status get_plan(const lensprof_sensor_plan **plan) {
    lensprof_apply_options options;
    lensprof_readout readout;
    set_options(&options);
    options.input = options.output = LENSPROF_ENCODING_LINEAR;
    options.blob = camera_blob;
    options.blob_bytes = camera_blob_bytes;
    const lensprof_status status = set_readout(&readout);
    if (status != LENSPROF_OK) return status;
    put_number("plan: bytes ", (uint32_t)lensprof_sensor_plan_bytes(&readout));
    return lensprof_sensor_plan_init(memory, sizeof memory, &options, &readout, plan, NULL);
}
#else
static lensprof_status get_plan(const lensprof_sensor_plan **plan) {
    return lensprof_sensor_plan_open(sensor_plan, sensor_plan_bytes, plan);
}
#endif

int main(void) {
    static uint8_t buffer[2][RAW_ROW_BYTES];
    const lensprof_sensor_plan *plan;
    lensprof_status status;
    uint32_t ticks = 0;

    paint_stack();
    status = get_plan(&plan);
    put_number("plan: stack ", deepest_stack());
    paint_stack();
    dma_start(buffer[0], raw_strip);
    for (uint32_t y = 0; y < STRIP_ROWS && status == LENSPROF_OK; y++) {
        const lensprof_packed_target row = {buffer[y & 1], RAW_ROW_BYTES, STRIP_WIDTH, 1};
        dma_wait();
        if (y + 1 < STRIP_ROWS) dma_start(buffer[(y + 1) & 1], raw_strip + (y + 1) * RAW_ROW_BYTES);
        const uint32_t before = clock_ticks();
        status = lensprof_sensor_apply_packed(plan, LENSPROF_PACKING_RAW10, NULL, &row, 0, y);
        ticks += (before - clock_ticks()) & 0xFFFFFF;
        if (y == STRIP_ROWS - 1) put_number("apply: stack ", deepest_stack());
        put_bytes("sensor", buffer[y & 1], RAW_ROW_BYTES);
    }
    put_number("apply: ticks ", ticks);
    if (status != LENSPROF_OK) put_text("cannot correct\n");
    return status != LENSPROF_OK;
}
