/* capture_flat - a flat field captured on the device: rows of a white card are added up in integers as they arrive. The
 * device finds the gains in memory of its own; without a floating-point unit it may leave that to a PC, for which the
 * sums are printed (SensorFlat.open in Python). */
#include "sensor.h"

enum {
    GRID_COLUMNS = 7,
    GRID_ROWS = 5
};
static uint64_t memory[160]; /* see lensprof_sensor_flat_bytes */

static uint32_t flat_bytes;

static lensprof_status begin(lensprof_sensor_flat **flat) {
    lensprof_readout readout;
    const lensprof_status status = set_readout(&readout);
    if (status != LENSPROF_OK) return status;
    readout.height = CARD_ROWS;
    readout.columns = GRID_COLUMNS;
    readout.rows = GRID_ROWS;
    flat_bytes = (uint32_t)lensprof_sensor_flat_bytes(&readout);
    put_number("flat: bytes ", flat_bytes);
    return lensprof_sensor_flat_init(memory, sizeof memory, STRIP_WIDTH, CARD_ROWS, &readout, flat, NULL);
}

static lensprof_status add_rows(lensprof_sensor_flat *flat) {
    static uint8_t buffer[2][RAW_ROW_BYTES];
    static uint16_t samples[STRIP_WIDTH];
    const lensprof_image row = {samples, 0, STRIP_WIDTH, 1, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_GREY};
    lensprof_status status = LENSPROF_OK;
    uint32_t ticks = 0;
    dma_start(buffer[0], raw_card);
    for (uint32_t y = 0; y < CARD_ROWS && status == LENSPROF_OK; y++) {
        dma_wait();
        if (y + 1 < CARD_ROWS) dma_start(buffer[(y + 1) & 1], raw_card + (y + 1) * RAW_ROW_BYTES);
        const uint32_t before = clock_ticks();
        status = lensprof_unpack_row(LENSPROF_PACKING_RAW10, buffer[y & 1], STRIP_WIDTH, samples);
        if (status == LENSPROF_OK) status = lensprof_sensor_flat_add(flat, &row, 0, y);
        ticks += (before - clock_ticks()) & 0xFFFFFF;
    }
    put_number("add: ticks ", ticks);
    return status;
}

static lensprof_status put_gains(const lensprof_sensor_flat *flat) {
    static uint64_t work[1 << 10]; /* see lensprof_sensor_flat_work_bytes */
    static float gains[3 * GRID_ROWS * GRID_COLUMNS];
    const lensprof_status status = lensprof_sensor_flat_gains(flat, work, sizeof work, gains, NULL);
    if (status == LENSPROF_OK) put_bytes("gains", (const uint8_t *)gains, sizeof gains);
    return status;
}

int main(void) {
    lensprof_sensor_flat *flat = NULL;
    lensprof_status status = begin(&flat);
    if (status == LENSPROF_OK) status = add_rows(flat);
    if (status == LENSPROF_OK) put_bytes("flat", (const uint8_t *)memory, flat_bytes);
    if (status == LENSPROF_OK) status = put_gains(flat);
    if (status != LENSPROF_OK) put_text("cannot capture\n");
    return status != LENSPROF_OK;
}
