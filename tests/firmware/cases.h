/* Random cases in flash (make_cases). */
#ifndef LENSPROF_TESTS_CASES_H
#define LENSPROF_TESTS_CASES_H

#include <stdint.h>

typedef struct random_case {
    const uint32_t *plan;
    uint32_t plan_bytes;
    const uint32_t *in, *wanted; /* samples of a row, and their expected values */
    uint32_t sample, target, layout, width, x0, y0;
} random_case;

/* The bytes that this sensor plan gives on the machine that wrote the cases. */
typedef struct sensor_row {
    const uint32_t *plan;
    uint32_t plan_bytes;
    const uint32_t *in, *wanted; /* samples of a row */
    uint32_t width, x0, y0;
} sensor_row;

extern const sensor_row sensor_rows[];
extern const uint32_t sensor_row_count;
extern const random_case cases[];
extern const uint32_t case_count;

#endif
