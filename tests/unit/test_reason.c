/* Names and sentences of reasons. */
#include "support.h"

#include <lensprof/reason.h>

#define MOST 1000 /* codes are below */

static int is_known(uint32_t code) { return strcmp(lensprof_reason_name(code), "unknown") != 0; }

static void test_every_reason_has_a_name_and_a_sentence_of_its_own(void **state) {
    (void)state;
    uint32_t known = 0;
    for (uint32_t i = 1; i < MOST; i++) {
        if (!is_known(i)) {
            assert_string_equal(lensprof_reason_text(i), "");
            continue;
        }
        known++;
        if (strlen(lensprof_reason_text(i)) < 15) fail_msg("%u: %s", i, lensprof_reason_text(i));
        for (uint32_t j = 0; j < i; j++) {
            if (!is_known(j)) continue;
            if (strcmp(lensprof_reason_text(i), lensprof_reason_text(j)) == 0)
                fail_msg("%u and %u have the same text", i, j);
            if (strcmp(lensprof_reason_name(i), lensprof_reason_name(j)) == 0)
                fail_msg("%u and %u have the same name", i, j);
        }
    }
    assert_int_equal(known, 98);
}

static void test_names(void **state) {
    (void)state;
    assert_string_equal(lensprof_reason_name(LENSPROF_REASON_NONE), "none");
    assert_string_equal(lensprof_reason_text(LENSPROF_REASON_NONE), "");
    assert_string_equal(lensprof_reason_name(LENSPROF_REASON_IMAGE_GROUPS), "image_groups");
    assert_string_equal(lensprof_reason_name(LENSPROF_REASON_LOOKUP_NO_LENS), "lookup_no_lens");
    assert_string_equal(lensprof_reason_name(99999), "unknown");
    assert_string_equal(lensprof_reason_text(99999), "");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_reason_has_a_name_and_a_sentence_of_its_own),
        cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
