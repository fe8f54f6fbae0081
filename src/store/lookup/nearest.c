/* The stored lenses whose names are nearest to one that none has. */
#include <stdlib.h>
#include <string.h>

#include "store/names/names.h"
#include "store/profiles/profiles.h"

#define LEAST_SCORE 0.2 /* of a name that is near at all */

/* Keeps names[count] in the order of their scores; returns how many there are then. */
static uint32_t keep(lensprof_store_name *names, uint32_t count, uint32_t max_count, const char *lens, double score) {
    uint32_t index = count;
    for (uint32_t i = 0; i < count; i++) {
        if (!strcmp(names[i].lens, lens)) return count;
        if (score > names[i].score && index == count) index = i;
    }
    if (index == max_count) return count;
    const uint32_t last = count < max_count ? count : max_count - 1;
    memmove(&names[index + 1], &names[index], (last - index) * sizeof *names);
    memset(&names[index], 0, sizeof *names);
    strcpy(names[index].lens, lens);
    names[index].score = score;
    return last + 1;
}

static lensprof_status search(lensprof_store *store, const lensprof_profile_key *key, lensprof_store_name *names,
                              uint32_t max_count, uint32_t *count, lensprof_error *error) {
    lp_store_reader reader = {NULL, 0, NULL};
    lensprof_status status =
        lp_store_prepare(store, "SELECT DISTINCT trim(lens) FROM profiles ORDER BY 1", &reader.statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(reader.statement);
    for (; rc == SQLITE_ROW; rc = sqlite3_step(reader.statement)) {
        char lens[sizeof names->lens];
        reader.column = 0, reader.bad = NULL;
        lp_read_text(&reader, lens, sizeof lens);
        if (reader.bad) continue;
        const double score = lp_words_likeness(lens, key->lens, key->camera_maker);
        if (score >= LEAST_SCORE) *count = keep(names, *count, max_count, lens, score);
    }
    if (rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, reader.statement);
    return status;
}

lensprof_status lensprof_store_nearest_lenses(lensprof_store *store, const lensprof_profile_key *key,
                                              lensprof_store_name *names, uint32_t most, uint32_t *count,
                                              lensprof_error *error) {
    uint32_t found = 0;
    lp_store_clear(error);
    if (!store || !key || !count || (most && !names))
        return lp_store_fail_argument("store, key, names or count is NULL", error);
    if (lensprof_profile_key_validate(key) != LENSPROF_OK)
        return lp_store_fail_argument("the key is invalid; see lensprof_profile_key", error);
    lensprof_store_name *nearest = malloc((most ? most : 1) * sizeof *nearest);
    if (!nearest) return lp_store_fail_sql(store->path, NULL, SQLITE_NOMEM, error);
    lensprof_status status = lp_store_begin(store, false, error);
    if (status == LENSPROF_OK) {
        if (most) status = search(store, key, nearest, most, &found, error);
        lp_store_rollback(store);
    }
    if (status == LENSPROF_OK) {
        if (found) memcpy(names, nearest, found * sizeof *nearest);
        *count = found;
    }
    free(nearest);
    return status;
}
