/* Allocations of C++ that fail on request. */
#ifndef LENSPROF_TESTS_FAILING_NEW_HPP
#define LENSPROF_TESTS_FAILING_NEW_HPP

#ifdef __cplusplus
extern "C" {
#endif

/* The allocation after `good` more ones fails, and all that follow until the next call; negative = none fails. */
void lp_fail_allocation_after(long good);

#ifdef __cplusplus
}
#endif
#endif
