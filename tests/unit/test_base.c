/* Version and status names. */
#include "support.h"

#include <lensprof/base.h>

static void test_version_is_the_header_s(void **state) {
    (void)state;
    char text[32];
    snprintf(text, sizeof text, "%d.%d.%d", LENSPROF_VERSION_MAJOR, LENSPROF_VERSION_MINOR, LENSPROF_VERSION_PATCH);
    assert_string_equal(lensprof_version(), text);
}

static void test_every_status_has_its_name(void **state) {
    (void)state;
    assert_string_equal(lensprof_status_name(LENSPROF_OK), "LENSPROF_OK");
    assert_string_equal(lensprof_status_name(LENSPROF_ERROR_CORRUPT), "LENSPROF_ERROR_CORRUPT");
    assert_string_equal(lensprof_status_name((lensprof_status)77), "unknown status");
    int named = 0;
    for (int s = 0; s < 100; s++) named += strcmp(lensprof_status_name((lensprof_status)s), "unknown status") != 0;
    assert_int_equal(named, 29);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_version_is_the_header_s),
        cmocka_unit_test(test_every_status_has_its_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
