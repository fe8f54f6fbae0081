/* C++ allocations that fail on request. */
#ifndef LENSPROF_TESTS_FAILING_NEW_HPP
#define LENSPROF_TESTS_FAILING_NEW_HPP

#ifdef __cplusplus
extern "C" {
#endif

/* Lets the allocation after `good` further ones fail, and all that follow until the next call; negative: none fails. */
void lp_fail_allocation_after(long good);

#ifdef __cplusplus
}
#endif
#endif
