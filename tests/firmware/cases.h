/* Random cases in flash (make_cases). */
#ifndef LENSPROF_TESTS_CASES_H
#define LENSPROF_TESTS_CASES_H

#include <stdint.h>

typedef struct random_case {
    const uint32_t *plan;
    uint32_t plan_bytes;
    const uint32_t *in, *wanted; /* samples of a row, and their expected values */
    uint32_t sample, layout, width, x0, y0;
} random_case;

extern const random_case cases[];
extern const uint32_t case_count;

#endif
