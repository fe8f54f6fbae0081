/* Lenses with names similar to one that no stored lens has. */
#ifndef LENSPROF_STORE_LOOKUP_NEAREST_H
#define LENSPROF_STORE_LOOKUP_NEAREST_H

#include <lensprof/store.h>

typedef struct lp_nearest {
    uint32_t count;
    double score[LENSPROF_LOOKUP_NEAREST]; /* 0..1: share of words common to both names, with focal lengths and
                                              f-numbers weighted most; falling */
    char lens[LENSPROF_LOOKUP_NEAREST][sizeof((lensprof_profile_key *)0)->lens];
} lp_nearest;

/* Adds the lenses of a store, within a transaction. If key->lens names no maker, key->camera_maker is used. */
lensprof_status lp_add_nearest(lensprof_store *store, const lensprof_profile_key *key, lp_nearest *nearest,
                               lensprof_error *error);

#endif
