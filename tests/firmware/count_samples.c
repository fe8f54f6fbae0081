/* count_samples - instructions per sample of a row of 12 megapixels, counted by the emulator's clock: the library's
 * ways compared with a plain loop and a copy. Each line: name, instructions per 100 samples. */
#include <string.h>

#include <lensprof/sensor.h>

#include "board.h"
#include "counts.h"

#ifndef NS_PER_TICK
#define NS_PER_TICK 40 /* of clock_ticks; the emulator takes a nanosecond per instruction */
#endif

static uint16_t row[COUNT_WIDTH], out[COUNT_WIDTH];
static uint8_t packed[COUNT_WIDTH / 4 * 5];

static void fill(void) {
    for (uint32_t x = 0; x < COUNT_WIDTH; x++) row[x] = (uint16_t)(256 + x * 7 % 700);
}

/* What one writes first: a gain between four nodes for every sample, in single precision. */
static void plain(uint16_t *samples, uint32_t y) {
    const float v = (float)y * (COUNT_ROWS - 1) / (COUNT_HEIGHT - 1);
    const uint32_t j = (uint32_t)v < COUNT_ROWS - 2 ? (uint32_t)v : COUNT_ROWS - 2;
    for (uint32_t x = 0; x < COUNT_WIDTH; x++) {
        const uint32_t channel = (y & 1) + (x & 1);
        const float u = (float)x * ((COUNT_COLUMNS - 1) / (float)(COUNT_WIDTH - 1));
        const uint32_t i = (uint32_t)u < COUNT_COLUMNS - 2 ? (uint32_t)u : COUNT_COLUMNS - 2;
        const float s = u - (float)i, t = v - (float)j;
        const float *above = count_gains + (channel * COUNT_ROWS + j) * COUNT_COLUMNS + i,
                    *below = above + COUNT_COLUMNS;
        const float gain = (1 - t) * ((1 - s) * above[0] + s * above[1]) + t * ((1 - s) * below[0] + s * below[1]);
        const float code = 256.0f + ((float)samples[x] - 256.0f) * gain + 0.5f;
        samples[x] = (uint16_t)(code < 0.0f ? 0.0f : code > 4095.0f ? 4095.0f : code);
    }
}

static void put_count(const char *name, uint32_t ticks) {
    char text[12], *p = text + sizeof text;
    uint32_t count = ticks * NS_PER_TICK / (COUNT_WIDTH / 100);
    for (*--p = '\0'; count || p == text + sizeof text - 1; count /= 10) *--p = (char)('0' + count % 10);
    put_text(name), put_text(" "), put_text(p), put_text("\n");
}

static lensprof_status count(const char *name, int way, const void *plan) {
    const lensprof_target samples = {row, 0, COUNT_WIDTH, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
    const lensprof_target mosaic = {row, 0, COUNT_WIDTH, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGGB};
    const lensprof_packed_target raw = {packed, sizeof packed, COUNT_WIDTH, 1};
    lensprof_status status = LENSPROF_OK;
    fill();
    if (way == 4) status = lensprof_pack_row(LENSPROF_PACKING_RAW10, row, COUNT_WIDTH, packed);
    const uint32_t before = clock_ticks();
    if (way == 0) memcpy(out, row, sizeof out);
    if (way == 1) plain(row, 1001);
    if (way == 2) status = lensprof_sensor_apply(plan, NULL, &samples, 0, 1001);
    if (way == 3) status = lensprof_fixed_apply(plan, NULL, &mosaic, 0, 1001);
    if (way == 4) status = lensprof_sensor_apply_packed(plan, LENSPROF_PACKING_RAW10, NULL, &raw, 0, 1001);
    put_count(name, (before - clock_ticks()) & 0xFFFFFF);
    return status;
}

int main(void) {
    const lensprof_sensor_plan *sensor;
    const lensprof_fixed_plan *fixed;
    if (lensprof_sensor_plan_open(count_sensor_plan, count_sensor_plan_bytes, &sensor) != LENSPROF_OK
        || lensprof_fixed_plan_open(count_fixed_plan, count_fixed_plan_bytes, &fixed) != LENSPROF_OK)
        return 1;
    lensprof_status status = count("copy", 0, NULL);
    if (status == LENSPROF_OK) status = count("plain", 1, NULL);
    if (status == LENSPROF_OK) status = count("sensor", 2, sensor);
    if (status == LENSPROF_OK) status = count("packed", 4, sensor);
    if (status == LENSPROF_OK) status = count("fixed", 3, fixed);
    return status != LENSPROF_OK;
}
