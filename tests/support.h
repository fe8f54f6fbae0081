/* Common header of the cmocka tests: cmocka with its prerequisites, and additional comparisons. */
#ifndef LENSPROF_TESTS_SUPPORT_H
#define LENSPROF_TESTS_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* Fails unless |a - b| <= tolerance (NaN fails). */
#define assert_close(a, b, tolerance) lp_assert_close((a), (b), (tolerance), #a, __FILE__, __LINE__)

static inline void lp_assert_close(double a, double b, double tolerance, const char *what, const char *file, int line) {
    if (!(fabs(a - b) <= tolerance)) {
        print_error("%s is %.17g, not %.17g within %g\n", what, a, b, tolerance);
        _fail(file, line);
    }
}

/* Checks the first finding of a fit or flat field: its code, and words of its sentence. */
#define assert_reason(result, reason, words)                             \
    do {                                                                 \
        assert_int_equal((result).first.code, LENSPROF_REASON_##reason); \
        assert_non_null(strstr((result).first.text, (words)));           \
    } while (0)

#define assert_ok(call) assert_int_equal((call), LENSPROF_OK)

/* A small generator with a fixed sequence, uniform in [0,1). */
static inline double lp_random(uint64_t *state) {
    *state = *state * 6364136223846793005ull + 1442695040888963407ull;
    uint64_t x = *state ^ (*state >> 29);
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 32;
    return (double)(x >> 11) * (1.0 / 9007199254740992.0);
}

/* A standard normal number from the same generator. */
static inline double lp_normal(uint64_t *state) {
    double u = lp_random(state), v = lp_random(state);
    return sqrt(-2.0 * log(1.0 - u)) * cos(6.283185307179586 * v);
}

#endif
