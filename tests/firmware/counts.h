/* What the count of instructions finds in flash (make_counts). */
#ifndef LENSPROF_TESTS_COUNTS_H
#define LENSPROF_TESTS_COUNTS_H

#include <stdint.h>

enum {
    COUNT_WIDTH = 4032, /* a frame of 12 megapixels */
    COUNT_HEIGHT = 3024,
    COUNT_COLUMNS = 17,
    COUNT_ROWS = 13
};

extern const uint32_t count_sensor_plan[], count_sensor_plan_bytes;
extern const uint32_t count_fixed_plan[], count_fixed_plan_bytes;
extern const float count_gains[3 * COUNT_ROWS * COUNT_COLUMNS]; /* [channel][row][column], for the plain loop */

#endif
