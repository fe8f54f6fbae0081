/* Campaigns: tests of hundreds of runs. `make soak` runs all of them; `make test` runs a fraction
 * (tests/CMakeLists.txt). */
#ifndef LENSPROF_TESTS_CAMPAIGN_H
#define LENSPROF_TESTS_CAMPAIGN_H

#include <stdint.h>
#include <stdlib.h>

/* All runs, or LENSPROF_PERCENT (environment) percent of them, at least one. */
static inline int campaign_runs(int all) {
    const char *percent = getenv("LENSPROF_PERCENT");
    const long share = percent ? strtol(percent, NULL, 10) : 100;
    const int runs = (int)(all * (share > 0 && share < 100 ? share : 100L) / 100);
    return runs > 0 ? runs : 1;
}

/* The same for all combinations of values, numbered with the factors 2 and 3: the step from one to the next. It has
 * neither factor, so that every value is met. */
static inline uint32_t campaign_step(void) {
    uint32_t step = 100u / (uint32_t)campaign_runs(100);
    while (step % 2 == 0 || step % 3 == 0) step--;
    return step;
}

#endif
