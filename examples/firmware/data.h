/* What is in flash beside the program; data.c is written by make_data.c, on a PC. */
#ifndef DATA_H
#define DATA_H

#include <lensprof/fixed.h>

/* The upper left of a frame, as the camera recorded it. */
enum { FRAME_WIDTH = 640, FRAME_HEIGHT = 480, STRIP_WIDTH = 160, STRIP_ROWS = 16 };
extern const uint8_t strip[STRIP_ROWS * STRIP_WIDTH * 3];

extern const lensprof_response camera_table, camera_gamma; /* the same curve nearly; the second one needs pow() */
extern const lensprof_vignetting camera_falloff[3];

extern const uint32_t fixed_plan[]; /* what prepare_fixed (demo.h) says with camera_table, prepared on the PC */
extern const uint32_t fixed_plan_bytes;

#endif
