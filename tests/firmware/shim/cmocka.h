/* The part of cmocka that the core's tests use, for processors without a package of it. The first failed assertion ends
 * the program. */
#ifndef LENSPROF_TESTS_SHIM_CMOCKA_H
#define LENSPROF_TESTS_SHIM_CMOCKA_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define print_message printf
#define print_error printf

static inline void shim_fail(const char *what, const char *file, int line) {
    printf("%s:%d: %s\n", file, line, what);
    exit(1);
}

#define _fail(file, line) shim_fail("failed", file, line)
#define fail_msg(...) (printf(__VA_ARGS__), printf("\n"), shim_fail("failed", __FILE__, __LINE__))
#define assert_true(is) ((is) ? (void)0 : shim_fail(#is, __FILE__, __LINE__))
#define assert_false(is) assert_true(!(is))
#define assert_int_equal(a, b) assert_true((long long)(a) == (long long)(b))
#define assert_int_not_equal(a, b) assert_true((long long)(a) != (long long)(b))
#define assert_ptr_equal(a, b) assert_true((const void *)(a) == (const void *)(b))
#define assert_null(p) assert_true(!(p))
#define assert_non_null(p) assert_true(p)
#define assert_memory_equal(a, b, bytes) assert_true(memcmp(a, b, bytes) == 0)
#define assert_in_range(a, low, high) assert_true((a) >= (low) && (a) <= (high))
#define assert_string_equal(a, b) assert_true(strcmp(a, b) == 0)

struct CMUnitTest {
    const char *name;
    void (*run)(void **state);
};
#define cmocka_unit_test(f) \
    { #f, f }

static inline int shim_run(const struct CMUnitTest *tests, size_t count) {
    for (size_t i = 0; i < count; i++) {
        void *state = NULL;
        tests[i].run(&state);
        printf("[       OK ] %s\n", tests[i].name);
    }
    return count == 0;
}
#define cmocka_run_group_tests(tests, setup, teardown) shim_run(tests, sizeof(tests) / sizeof *(tests))

#endif
