/* Rows and profiles: what the files of this folder share, and lookups use. */
#ifndef LENSPROF_STORE_PROFILES_H
#define LENSPROF_STORE_PROFILES_H

#include "store/file/private.h"

/* read.c: the profile with an id, within a transaction, into store->scratch. */
lensprof_status lp_store_fetch(lensprof_store *store, int64_t id, lensprof_error *error);

/* read.c: the same, its responses linear whatever they are. */
lensprof_status lp_store_fetch_falloff(lensprof_store *store, int64_t id, lensprof_error *error);

/* read.c: the ten columns of a key but its processing, from the maker on. */
void lp_store_bind_key(lp_store_binder *binder, const lensprof_profile_key *key);

/* write.c: a profile known to be valid, within a transaction; and its columns, in the order of that INSERT. */
lensprof_status lp_store_insert(lensprof_store *store, const lensprof_profile *profile, int64_t *id,
                                lensprof_error *error);
void lp_store_bind_profile(lp_store_binder *binder, const lensprof_profile *profile, const char *lens_name);

/* same.c: the id of the same valid profile, 0 if it is not stored; within a transaction that writes. */
lensprof_status lp_store_find_same(lensprof_store *store, const lensprof_profile *profile, int64_t *id,
                                   lensprof_error *error);

/* cameras.c, within a transaction: the camera of a name, as lensprof_store_find_camera finds it; cameras of another
 * database that are not here by maker, model and variant; and what is wrong with a camera, with its number. */
lensprof_status lp_store_find_camera(lensprof_store *store, const char *maker, const char *model,
                                     lensprof_camera_model *camera, bool *found, lensprof_error *error);
lensprof_status lp_store_merge_cameras(lensprof_store *store, lensprof_store *other, lensprof_error *error);
typedef lensprof_status (*lp_camera_fault)(void *user, int64_t id, const char *wrong);
lensprof_status lp_store_check_cameras(lensprof_store *store, lp_camera_fault report, void *user,
                                       lensprof_error *error);

/* Words of the database for enum values; the position is the value. They are part of the layout. */
#define LP_STORE_PROCESSINGS 3
#define LP_STORE_KINDS 4
extern const char *const lp_store_processings[LP_STORE_PROCESSINGS];
extern const char *const lp_store_kinds[LP_STORE_KINDS];

/* curves.c: rows of responses, emor_coefficients, vignettings and gain_grids. */
/* The response that its kind, gamma, coefficients or table describe, from nothing else. */
lensprof_status lp_store_rebuild(const lensprof_response *from, lensprof_response *response);
lensprof_status lp_store_put_curves(lensprof_store *store, int64_t id, const lensprof_profile *profile,
                                    lensprof_error *error);
/* Into store->scratch, which knows how many curves there are; `grids` is the number of gain grids, 0 or 1. Without
 * with_response the responses stay what they are. */
lensprof_status lp_store_read_curves(lensprof_store *store, int64_t id, bool with_response, uint32_t grids,
                                     lensprof_error *error);

#endif
