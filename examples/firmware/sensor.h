/* The sensor of the demonstrations: packed rows that a simulated DMA brings into one of two buffers. */
#ifndef SENSOR_H
#define SENSOR_H

#include <string.h>

#include <lensprof/sensor.h>

#include "demo.h"

/* On your board: start the camera's DMA, and wait for its interrupt. */
static struct {
    uint8_t *buffer;
    const uint8_t *row;
} dma;

static inline void dma_start(uint8_t *buffer, const uint8_t *row) { dma.buffer = buffer, dma.row = row; }
static inline void dma_wait(void) { memcpy(dma.buffer, dma.row, RAW_ROW_BYTES); }

static const lensprof_sensor_levels raw_levels = {{64, 64, 64, 64}, 1023};

/* The upper left of the frame, as it is read. */
static inline lensprof_status set_readout(lensprof_readout *readout) {
    lensprof_readout_init(readout);
    readout->width = STRIP_WIDTH;
    readout->height = STRIP_ROWS;
    readout->levels = &raw_levels;
    return lensprof_readout_set_mosaic(readout, "GRBG");
}

#endif
