/* What is in flash beside the program; data.c is written by make_data.c, on a PC. */
#ifndef DATA_H
#define DATA_H

#include <lensprof/sensor.h>

/* The upper left of a frame, as the camera recorded it. */
enum {
    FRAME_WIDTH = 640,
    FRAME_HEIGHT = 480,
    STRIP_WIDTH = 160,
    STRIP_ROWS = 16,
    RAW_ROW_BYTES = STRIP_WIDTH * 5 / 4, /* RAW10 */
    CARD_ROWS = 64
};
extern const uint8_t strip[STRIP_ROWS * STRIP_WIDTH * 3];
extern const uint8_t raw_strip[STRIP_ROWS * RAW_ROW_BYTES]; /* the same from a raw sensor, mosaic GRBG */
extern const uint8_t raw_card[CARD_ROWS * RAW_ROW_BYTES];   /* a white card, in a frame of its own */

/* The camera's profile as a blob; and nearly the same response as a power, which needs pow(). */
extern const uint8_t camera_blob[];
extern const uint32_t camera_blob_bytes;
extern const lensprof_response camera_gamma;
extern const lensprof_vignetting camera_falloff[3];

extern const uint32_t fixed_plan[]; /* what set_options (demo.h) says with camera_blob, prepared on the PC */
extern const uint32_t fixed_plan_bytes;
extern const uint32_t sensor_plan[]; /* the same for the raw sensor (sensor.h) */
extern const uint32_t sensor_plan_bytes;

#endif
