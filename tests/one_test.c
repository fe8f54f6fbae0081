/* Linked into every test program: the environment's LENSPROF_TEST, a name with * and ?, selects the tests that run;
 * LENSPROF_SKIP those that do not. */
#include "support.h"

__attribute__((constructor)) static void select_tests(void) {
    const char *name = getenv("LENSPROF_TEST");
    if (name) cmocka_set_test_filter(name);
    const char *skipped = getenv("LENSPROF_SKIP");
    if (skipped) cmocka_set_skip_filter(skipped);
}
