/* Paths are UTF-8 on every system: also on Windows, whose programs have another code page. */
#include <lensprof/store.h>

#include "support.h"

static const char name[] = "\xc3\x9cn\xc3\xaf code-\xe5\x86\x99\xe7\x9c\x9f.db";

static void test_database_with_a_name_in_utf8(void **state) {
    (void)state;
    lensprof_error error = {0};
    lensprof_store *store = NULL;
    assert_ok(lensprof_store_open(name, LENSPROF_STORE_CREATE, &store, &error));
    lensprof_store_close(store);
    assert_ok(lensprof_store_open(name, LENSPROF_STORE_READ, &store, &error));
    lensprof_store_close(store);
    assert_int_equal(lensprof_store_open("\xc3\x9c.db", LENSPROF_STORE_READ, &store, &error), LENSPROF_ERROR_NOT_FOUND);
    assert_non_null(strstr(error.text, "\xc3\x9c.db"));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_database_with_a_name_in_utf8)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
