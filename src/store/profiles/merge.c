/* Profiles of another database, as they are. */
#include "store/profiles/profiles.h"

#include <stdlib.h>
#include <string.h>

/* A profile of the other database, and what it is here. */
typedef struct arrival {
    int64_t from, to;
} arrival;

typedef struct merging {
    lensprof_store *store, *other;
    arrival *all; /* by rising `from` */
    size_t count, allocated;
    uint32_t added, known;
} merging;

/* False without memory. */
static bool remember(merging *m, int64_t from, int64_t to) {
    if (m->count == m->allocated) {
        const size_t allocated = m->allocated ? 2 * m->allocated : 256;
        arrival *all = realloc(m->all, allocated * sizeof *all);
        if (!all) return false;
        m->all = all, m->allocated = allocated;
    }
    m->all[m->count++] = (arrival){from, to};
    return true;
}

/* The profile here; 0 for one that the other database has no more. */
static int64_t arrived(const merging *m, int64_t from) {
    size_t low = 0, high = m->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (m->all[middle].from < from)
            low = middle + 1;
        else
            high = middle;
    }
    return low < m->count && m->all[low].from == from ? m->all[low].to : 0;
}

/* The prior has another id here, and is older: it has arrived. 0 where it is not there. */
static int64_t prior_here(const merging *m, const lensprof_provenance *provenance) {
    return provenance->prior_id ? arrived(m, provenance->prior_id) : 0;
}

/* A new profile. */
static lensprof_status add(merging *m, lensprof_profile *profile, int64_t *target_id, lensprof_error *error) {
    m->added++;
    profile->provenance.prior_id = prior_here(m, &profile->provenance);
    return lp_store_insert(m->store, profile, target_id, error);
}

/* A known profile, now in the store's scratch, gets its prior where only the other database has it. */
static lensprof_status complete(merging *m, const lensprof_profile *profile, int64_t target_id, lensprof_error *error) {
    const int64_t prior = prior_here(m, &profile->provenance);
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    m->known++;
    if (!prior || m->store->scratch.provenance.prior_id) return LENSPROF_OK;
    lensprof_status status =
        lp_store_prepare(m->store, "UPDATE profiles SET prior_id = ?1 WHERE id = ?2", &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_integer(&binder, prior);
    lp_bind_integer(&binder, target_id);
    return lp_store_run(m->store, &binder, error);
}

static lensprof_status take(merging *m, int64_t id, lensprof_error *error) {
    int64_t target_id = 0;
    lensprof_profile *profile = &m->other->scratch;
    lensprof_status status = lp_store_fetch(m->other, id, error);
    if (status == LENSPROF_OK) status = lp_store_find_same(m->store, profile, &target_id, error);
    if (status == LENSPROF_OK)
        status = target_id ? complete(m, profile, target_id, error) : add(m, profile, &target_id, error);
    if (status == LENSPROF_OK && !remember(m, id, target_id))
        return lp_store_fail_sql(m->store->path, NULL, SQLITE_NOMEM, error);
    return status;
}

/* The oldest first, so that the newest of a key stays the newest. */
static lensprof_status take_all(merging *m, lensprof_error *error) {
    lensprof_store *other = m->other;
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_prepare(other, "SELECT id FROM profiles ORDER BY id", &statement, error);
    if (status != LENSPROF_OK) return status;
    int rc = sqlite3_step(statement);
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        status = take(m, sqlite3_column_int64(statement, 0), error);
        if (status == LENSPROF_OK) rc = sqlite3_step(statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(other->path, other->db, rc, error);
    lp_store_release(other, statement);
    return status;
}

lensprof_status lensprof_store_merge(lensprof_store *store, lensprof_store *other, uint32_t *added, uint32_t *known,
                                     lensprof_error *error) {
    lp_store_clear(error);
    if (!store || !other) return lp_store_fail_argument("store or other is NULL", error);
    if (store == other || !strcmp(sqlite3_db_filename(store->db, "main"), sqlite3_db_filename(other->db, "main")))
        return lp_store_fail(other->path, LENSPROF_ERROR_ARGUMENT, "is the database itself",
                             "give a different database to merge", error);
    lensprof_status status = lp_store_begin(store, true, error);
    if (status != LENSPROF_OK) return status;
    status = lp_store_begin(other, false, error);
    merging m = {store, other, NULL, 0, 0, 0, 0};
    if (status == LENSPROF_OK) {
        status = take_all(&m, error);
        if (status == LENSPROF_OK) status = lp_store_merge_cameras(store, other, error);
        lp_store_rollback(other);
        free(m.all);
    }
    if (status == LENSPROF_OK)
        status = lp_store_commit(store, error);
    else
        lp_store_rollback(store);
    if (status == LENSPROF_OK && added) *added = m.added;
    if (status == LENSPROF_OK && known) *known = m.known;
    return status;
}
