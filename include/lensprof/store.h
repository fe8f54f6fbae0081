/* lensprof/store.h - the profile database (SQLite).
 *
 * Every call is one transaction: it happens whole or not at all, also when the process is killed. A file of an older
 * layout is read as it is; the first call that writes brings it up to date, which older versions then refuse.
 * Threads: a handle belongs to one thread at a time; several processes may open the same file. */
#ifndef LENSPROF_STORE_H
#define LENSPROF_STORE_H

#include "profile.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lensprof_store lensprof_store;

typedef enum lensprof_store_mode {
    LENSPROF_STORE_READ =
        0, /* the file must exist; nothing is written (but what a killed writer left half done is undone) */
    LENSPROF_STORE_WRITE = 1, /* the file must exist */
    LENSPROF_STORE_CREATE = 2 /* write, and make the file when there is none */
} lensprof_store_mode;

/* Opens a database. *store is created and must be closed.
 * Errors (the text names the file): NOT_FOUND (also a missing folder), READ_ONLY, CORRUPT (not a lensprof database;
 * also an empty file unless it may be made), LAYOUT (made by a newer version), BUSY, FULL, STORE, MEMORY. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_open(const char *path, uint32_t mode,
                                                                   lensprof_store **store, lensprof_error *error);
LENSPROF_API void lensprof_store_close(lensprof_store *store); /* NULL is allowed */

/* Adds a profile and sets *id (may be NULL). A profile with the same key stays: `find` returns the newest. Errors: what
 * lensprof_profile_validate says, RESPONSE for a table that is not the curve of its kind and numbers, and the
 * store's. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_put(lensprof_store *store,
                                                                  const lensprof_profile *profile, int64_t *id,
                                                                  lensprof_error *error);

/* The newest profile whose key is equal, and its *id (may be NULL) (texts ignoring ASCII case and outer blanks; focal
 * length, aperture and distance to 1e-6 relative; unknown equals unknown only; the same processing). NOT_FOUND when
 * there is none. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_find(lensprof_store *store,
                                                                   const lensprof_profile_key *key,
                                                                   lensprof_profile *profile, int64_t *id,
                                                                   lensprof_error *error);

/* The profile with an id. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_get(lensprof_store *store, int64_t id,
                                                                  lensprof_profile *profile, lensprof_error *error);

/* A row of a listing. Frozen value struct. */
typedef struct lensprof_store_row {
    int64_t id;
    lensprof_profile_key key;
    lensprof_provenance provenance;
} lensprof_store_row;

/* Lists profiles in the order camera maker, model, lens, focal, aperture, distance, id. Where filter (may be NULL) has
 * a text or a known number, only equal ones; its processing does not matter. rows[capacity]; *found receives how many
 * there are, which may be more than capacity (which is no error; capacity 0 = count only). */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_list(lensprof_store *store,
                                                                   const lensprof_profile_key *filter,
                                                                   lensprof_store_row *rows, uint32_t capacity,
                                                                   uint32_t *found, lensprof_error *error);

/* Removes the profile with an id; NOT_FOUND when there is none. */
LENSPROF_API LENSPROF_MUST_USE lensprof_status lensprof_store_remove(lensprof_store *store, int64_t id,
                                                                     lensprof_error *error);

#ifdef __cplusplus
}
#endif
#endif
