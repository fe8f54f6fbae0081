/* Which of the rows of a lens a lookup uses. */
#ifndef LENSPROF_STORE_LOOKUP_CHOICE_H
#define LENSPROF_STORE_LOOKUP_CHOICE_H

#include <lensprof/store.h>
#include <math.h>

#include "store/lookup/lookup_candidates.h"

/* Adds a caution for the caller; `name` (or NULL) follows the sentence. */
void lp_add_lookup_reason(lensprof_lookup *lookup, lensprof_reason reason, const char *name);

/* Two numbers of settings. Inline: lookups compare every row with every other. */
static inline int lp_is_same(double a, double b) { return a == b || fabs(a - b) <= 1e-6 * (a < b ? a : b); }

/* The best of the candidates whose rank is below `below` (INFINITY: of all), to group->all, which has room for all of
 * them; its other members are the caller's. Returns where the next best group begins: `below` of the next call.
 * group->count is 0 where none is left. */
double lp_choose_candidates(const lp_candidates *found, const lensprof_profile_key *key, double below,
                            lp_candidates *group, lensprof_lookup *lookup);

/* Takes the stored focal length of a fixed lens for one that is another rounding of it. */
void lp_round_focal(const lp_candidates *found, lp_falloff_node *target, lensprof_lookup *lookup);

/* Focal length and aperture, where they are not given and the same everywhere. Returns NONE, or why not. */
lensprof_reason lp_resolve_setting(lp_candidates *found, lp_falloff_node *target, lensprof_lookup *lookup);

/* Factor by which the standard error of a prediction is too small at a complete setting outside the rows; otherwise 1.
 */
double lp_widening(const lp_candidates *found, const lp_falloff_node *target);

/* Whether focal length and aperture, both known, are both outside the rows': a corner without information. Then
 * text[bytes] receives both, and the ranges. */
bool lp_is_outside_both(const lp_candidates *found, const lp_falloff_node *target, char *text, size_t bytes);

/* The newest row that is at the setting and has the pictures' response, or -1. */
int64_t lp_find_exact(const lp_candidates *found, const lp_falloff_node *target, const lensprof_profile_key *key);

#endif
