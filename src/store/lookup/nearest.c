/* The stored lenses whose names are nearest to one that none has. */
#include "store/lookup/nearest.h"

#include <string.h>

#include "store/names/names.h"
#include "store/profiles/profiles.h"

#define LEAST_SCORE 0.2 /* of a name that is near at all */

/* Keeps the names in the order of their scores. */
static void keep(lp_nearest *nearest, const char *lens, double score) {
    uint32_t index = nearest->count;
    for (uint32_t i = 0; i < nearest->count; i++) {
        if (!strcmp(nearest->lens[i], lens)) return;
        if (score > nearest->score[i] && index == nearest->count) index = i;
    }
    if (index == LENSPROF_LOOKUP_NEAREST) return;
    if (nearest->count < LENSPROF_LOOKUP_NEAREST) nearest->count++;
    for (uint32_t i = nearest->count - 1; i > index; i--) {
        memcpy(nearest->lens[i], nearest->lens[i - 1], sizeof nearest->lens[i]);
        nearest->score[i] = nearest->score[i - 1];
    }
    memset(nearest->lens[index], 0, sizeof nearest->lens[index]);
    strcpy(nearest->lens[index], lens);
    nearest->score[index] = score;
}

lensprof_status lp_add_nearest(lensprof_store *store, const lensprof_profile_key *key, lp_nearest *nearest,
                               lensprof_error *error) {
    lp_store_reader reader = {NULL, 0, NULL};
    lensprof_status status =
        lp_store_prepare(store, "SELECT DISTINCT trim(lens) FROM profiles ORDER BY 1", &reader.statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(reader.statement);
    for (; rc == SQLITE_ROW; rc = sqlite3_step(reader.statement)) {
        char lens[sizeof nearest->lens[0]];
        reader.column = 0, reader.bad = NULL;
        lp_read_text(&reader, lens, sizeof lens);
        if (reader.bad) continue;
        const double score = lp_words_likeness(lens, key->lens, key->camera_maker);
        if (score >= LEAST_SCORE) keep(nearest, lens, score);
    }
    if (rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, reader.statement);
    return status;
}
