/* Linked into every test program. The environment variable LENSPROF_TEST, a name with * and ?, selects the tests to
 * run; LENSPROF_SKIP selects the tests to leave out. */
#include "support.h"

__attribute__((constructor)) static void select_tests(void) {
    const char *name = getenv("LENSPROF_TEST");
    if (name) cmocka_set_test_filter(name);
    const char *skipped = getenv("LENSPROF_SKIP");
    if (skipped) cmocka_set_skip_filter(skipped);
}
