/* The falloff of a lens at a setting: what is made of the rows that count. */
#ifndef LENSPROF_STORE_LOOKUP_FALLOFF_H
#define LENSPROF_STORE_LOOKUP_FALLOFF_H

#include "store/lookup/lookup_choice.h"

typedef struct lp_falloff_answer {
    lensprof_profile_key key; /* the one asked for, and what its profiles have in common where it leaves that open */
    double k[3][3];
} lp_falloff_answer;

/* Errors of a lookup, which is then without an answer: NOT_FOUND, and the reason alone. */
lensprof_status lp_refuse(lensprof_store *store, lensprof_lookup *lookup, lensprof_reason reason,
                          lensprof_error *error);

/* The falloff that a store has for the key, to *answer, and how it was found, to *lookup: where lookup->exact is 1, a
 * stored profile with its own response, and *answer has the key alone. *knows_lens (also of a refusal): whether there
 * are profiles of the lens at all. Within a transaction. */
lensprof_status lp_find_falloff(lensprof_store *store, const lensprof_profile_key *key,
                                const lensprof_lookup_options *o, lp_falloff_answer *answer, lensprof_lookup *lookup,
                                bool *knows_lens, lensprof_error *error);

#endif
