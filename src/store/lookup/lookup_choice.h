/* Which of the rows of a lens a lookup uses. */
#ifndef LENSPROF_STORE_LOOKUP_CHOICE_H
#define LENSPROF_STORE_LOOKUP_CHOICE_H

#include <lensprof/store.h>

#include "store/lookup/lookup_candidates.h"

/* Adds a caution for the caller; `name` (or NULL) follows the sentence. */
void lp_mind(lensprof_lookup *lookup, lensprof_reason reason, const char *name);

/* Two numbers of settings. */
int lp_is_same(double a, double b);

/* Keeps the candidates that count. Returns NONE, or why there are none. */
lensprof_reason lp_choose_candidates(lp_candidates *found, const lensprof_profile_key *key, lensprof_lookup *lookup);

/* Takes the stored focal length of a fixed lens for one that is another rounding of it. */
void lp_round_focal(const lp_candidates *found, lp_falloff_node *at, lensprof_lookup *lookup);

/* Focal length and aperture, where they are not given and the same everywhere. Returns NONE, or why not. */
lensprof_reason lp_settle(lp_candidates *found, lp_falloff_node *at, lensprof_lookup *lookup);

/* The newest row that is at the setting, or -1. */
int64_t lp_find_exact(const lp_candidates *found, const lp_falloff_node *at, const lensprof_profile_key *key);

#endif
