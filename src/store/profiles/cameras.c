/* The table of cameras: sensor sizes, mounts, and the lenses that are built in. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/names/names.h"
#include "store/profiles/profiles.h"

#define FIRST_LAYOUT 5  /* with such a table */
#define SHORTEST_WORD 4 /* of a name that is its camera's alone */
#define SAME_CROP 0.005 /* of it: what the makers' figures are rounded to */

/* clang-format off */
#define COLUMNS "maker, model, other_maker, other_model, variant, mount, lens, crop_factor, fixed_lens, source"
/* clang-format on */

/* As cameras.name and cameras.other_name have it. */
static void name_of(const char *model, char *name) {
    char squeezed[LP_NAME_BYTES];
    lp_squeeze(model, squeezed);
    strcpy(name, lp_without_maker(squeezed));
}

/* Columns id, COLUMNS. NULL, or the name of the column that no camera has. */
static const char *read_camera(sqlite3_stmt *statement, lensprof_camera_model *camera) {
    lp_store_reader reader = {statement, 1, NULL};
    lensprof_camera_model_init(camera);
    lp_read_text(&reader, camera->maker, sizeof camera->maker);
    lp_read_text(&reader, camera->model, sizeof camera->model);
    lp_read_text(&reader, camera->other_maker, sizeof camera->other_maker);
    lp_read_text(&reader, camera->other_model, sizeof camera->other_model);
    lp_read_text(&reader, camera->variant, sizeof camera->variant);
    lp_read_text(&reader, camera->mount, sizeof camera->mount);
    lp_read_text(&reader, camera->lens, sizeof camera->lens);
    camera->crop_factor = lp_read_known(&reader);
    camera->fixed_lens = (uint32_t)lp_read_integer(&reader, 0, 1);
    lp_read_text(&reader, camera->source, sizeof camera->source);
    return !reader.bad && lp_camera_model_validate(camera) != LENSPROF_OK ? "value" : reader.bad;
}

typedef lensprof_status (*camera_visitor)(void *user, int64_t id, const lensprof_camera_model *camera,
                                          const char *wrong, lensprof_error *error);

/* Every row of a bound statement, which is released. */
static lensprof_status visit_rows(lensprof_store *store, lp_store_binder *binder, camera_visitor visit, void *user,
                                  lensprof_error *error) {
    lensprof_status status = LENSPROF_OK;
    int rc = binder->rc == SQLITE_OK ? sqlite3_step(binder->statement) : binder->rc;
    while (rc == SQLITE_ROW && status == LENSPROF_OK) {
        lensprof_camera_model camera;
        const char *wrong = read_camera(binder->statement, &camera);
        if (wrong && sqlite3_errcode(store->db) == SQLITE_NOMEM)
            rc = SQLITE_NOMEM;
        else
            status = visit(user, sqlite3_column_int64(binder->statement, 0), &camera, wrong, error);
        if (rc == SQLITE_ROW && status == LENSPROF_OK) rc = sqlite3_step(binder->statement);
    }
    if (status == LENSPROF_OK && rc != SQLITE_DONE) status = lp_store_fail_sql(store->path, store->db, rc, error);
    lp_store_release(store, binder->statement);
    return status;
}

static lensprof_status visit_all(lensprof_store *store, camera_visitor visit, void *user, lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    if (store->layout < FIRST_LAYOUT) return LENSPROF_OK;
    lensprof_status status = lp_store_prepare(
        store, "SELECT id, " COLUMNS " FROM cameras ORDER BY maker, model, variant, id", &binder.statement, error);
    return status == LENSPROF_OK ? visit_rows(store, &binder, visit, user, error) : status;
}

static lensprof_status put(lensprof_store *store, const char *sql, const lensprof_camera_model *camera,
                           lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    char name[LP_NAME_BYTES], other_name[LP_NAME_BYTES];
    lensprof_status status = lp_store_prepare(store, sql, &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    name_of(camera->model, name);
    name_of(camera->other_model, other_name);
    lp_bind_text(&binder, camera->maker);
    lp_bind_text(&binder, camera->model);
    lp_bind_text(&binder, camera->other_maker);
    lp_bind_text(&binder, camera->other_model);
    lp_bind_text(&binder, camera->variant);
    lp_bind_text(&binder, camera->mount);
    lp_bind_text(&binder, camera->lens);
    lp_bind_known(&binder, camera->crop_factor);
    lp_bind_integer(&binder, camera->fixed_lens);
    lp_bind_text(&binder, camera->source);
    lp_bind_text(&binder, name);
    lp_bind_text(&binder, other_name);
    return lp_store_run(store, &binder, error);
}

/* clang-format off */
#define INTO "INTO cameras (" COLUMNS ", name, other_name) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
/* clang-format on */

lensprof_status lensprof_store_put_camera(lensprof_store *store, const lensprof_camera_model *camera,
                                          lensprof_error *error) {
    lp_store_clear(error);
    if (!store || !camera) return lp_store_fail_argument("store or camera is NULL", error);
    if (lp_camera_model_validate(camera) != LENSPROF_OK)
        return lp_store_fail_argument("the camera is invalid; see lensprof_camera_model", error);
    lensprof_status status = lp_store_begin(store, true, error);
    if (status != LENSPROF_OK) return status;
    status = put(store, "INSERT OR REPLACE " INTO, camera, error);
    if (status == LENSPROF_OK) return lp_store_commit(store, error);
    lp_store_rollback(store);
    return status;
}

/* Refuses what no camera has: the text names the row. */
static lensprof_status refuse(const lensprof_store *store, int64_t id, const char *wrong, lensprof_error *error) {
    char problem[120];
    snprintf(problem, sizeof problem, "camera %lld is damaged (%s)", (long long)id, wrong);
    return lp_store_fail(store->path, LENSPROF_ERROR_CORRUPT, problem,
                         "import the cameras again, or restore the file from a copy", error);
}

/* What is asked for, and what all rows that have the name agree on. */
typedef struct search {
    const lensprof_store *store;
    const char *maker, *names[LP_CAMERA_NAMES];
    uint32_t count;
    bool by_last_word;
    int rank; /* of the name that was found: 2 EXIF's, 1 another; 0 = none */
    lensprof_camera_model found;
} search;

static int has_name(const search *s, const char *model) {
    char name[LP_NAME_BYTES];
    name_of(model, name);
    for (uint32_t i = 0; i < s->count; i++)
        if (!strcmp(name, s->names[i])) return 1;
    return 0;
}

/* "Mavic Pro FC220" is the FC220. */
static bool has_last_word(const search *s, const char *model) {
    const char *blank = strrchr(model, ' ');
    return blank && has_name(s, blank + 1);
}

static void keep_agreement(lensprof_camera_model *found, const lensprof_camera_model *other) {
    if (strcmp(found->lens, other->lens)) memset(found->lens, 0, sizeof found->lens);
    if (strcmp(found->mount, other->mount)) memset(found->mount, 0, sizeof found->mount);
    if (strcmp(found->variant, other->variant)) memset(found->variant, 0, sizeof found->variant);
    found->fixed_lens &= other->fixed_lens;
    if (!(fabs(found->crop_factor / other->crop_factor - 1.0) <= SAME_CROP)) found->crop_factor = LENSPROF_UNKNOWN;
}

static lensprof_status compare(void *user, int64_t id, const lensprof_camera_model *camera, const char *wrong,
                               lensprof_error *error) {
    search *s = user;
    if (wrong) return refuse(s->store, id, wrong, error);
    if (!lp_is_same_maker(camera->maker, s->maker)
        && !(*camera->other_maker && lp_is_same_maker(camera->other_maker, s->maker)))
        return LENSPROF_OK;
    if (s->by_last_word && !has_last_word(s, camera->model)) return LENSPROF_OK;
    const int rank = has_name(s, camera->model) ? 2 : 1;
    if (rank > s->rank)
        s->found = *camera;
    else if (rank == s->rank)
        keep_agreement(&s->found, camera);
    if (rank > s->rank) s->rank = rank;
    return LENSPROF_OK;
}

static const char by_name[] = "SELECT id, " COLUMNS " FROM cameras WHERE name = ?1 OR other_name = ?1";
static const char by_end[] = "SELECT id, " COLUMNS " FROM cameras WHERE substr(name, -length(?1)) = ?1";

static lensprof_status search_for(lensprof_store *store, const char *sql, const char *name, search *s,
                                  lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    const lensprof_status status = lp_store_prepare(store, sql, &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_text(&binder, name);
    return visit_rows(store, &binder, compare, s, error);
}

/* One word of letters and digits, by a maker. */
static bool may_be_last_word(const search *s, const char *model, const char *name) {
    return *s->maker && !strchr(model, ' ') && strlen(name) >= SHORTEST_WORD && strpbrk(name, "0123456789")
           && strpbrk(name, "abcdefghijklmnopqrstuvwxyz");
}

lensprof_status lp_store_find_camera(lensprof_store *store, const char *maker, const char *model,
                                     lensprof_camera_model *camera, bool *found, lensprof_error *error) {
    search s;
    char name[LP_NAME_BYTES], squeezed[LP_NAME_BYTES];
    memset(&s, 0, sizeof s);
    *found = false;
    if (store->layout < FIRST_LAYOUT) return LENSPROF_OK;
    lp_squeeze(model, squeezed);
    const char *of_model = lp_maker_in_front(squeezed);
    s.maker = *maker || !of_model ? maker : of_model;
    s.store = store;
    name_of(model, name);
    s.count = *name ? lp_camera_names(name, s.names) : 0;
    lensprof_status status = LENSPROF_OK;
    for (uint32_t i = 0; i < s.count && status == LENSPROF_OK; i++)
        status = search_for(store, by_name, s.names[i], &s, error);
    s.by_last_word = status == LENSPROF_OK && !s.rank && may_be_last_word(&s, model, name);
    if (s.by_last_word) status = search_for(store, by_end, name, &s, error);
    *found = status == LENSPROF_OK && s.rank > 0;
    if (*found) *camera = s.found;
    return status;
}

lensprof_status lensprof_store_find_camera(lensprof_store *store, const char *maker, const char *model,
                                           lensprof_camera_model *camera, lensprof_error *error) {
    bool found = false;
    lp_store_clear(error);
    if (!store || !maker || !model || !camera)
        return lp_store_fail_argument("store, maker, model or camera is NULL", error);
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    status = lp_store_find_camera(store, maker, model, camera, &found, error);
    lp_store_rollback(store);
    if (status != LENSPROF_OK || found) return status;
    return lp_store_fail(store->path, LENSPROF_ERROR_NOT_FOUND, "has no camera with this name",
                         "import a table of cameras, e.g. Lensfun's", error);
}

/* Cameras as they come, for the caller's buffer once all are known. */
typedef struct listing {
    const lensprof_store *store;
    lensprof_camera_model *all;
    uint32_t kept, allocated, capacity, found;
} listing;

static lensprof_status list_camera(void *user, int64_t id, const lensprof_camera_model *camera, const char *wrong,
                                   lensprof_error *error) {
    listing *list = user;
    if (wrong) return refuse(list->store, id, wrong, error);
    list->found++;
    if (list->kept == list->capacity) return LENSPROF_OK;
    if (list->kept == list->allocated) {
        const uint32_t allocated = list->allocated ? 2 * list->allocated : 64;
        lensprof_camera_model *all = realloc(list->all, allocated * sizeof *all);
        if (!all) return lp_store_fail_sql(list->store->path, NULL, SQLITE_NOMEM, error);
        list->all = all, list->allocated = allocated;
    }
    list->all[list->kept++] = *camera;
    return LENSPROF_OK;
}

lensprof_status lensprof_store_list_camera_models(lensprof_store *store, lensprof_camera_model *cameras,
                                                  uint32_t capacity, uint32_t *count, lensprof_error *error) {
    listing list = {store, NULL, 0, 0, capacity, 0};
    lp_store_clear(error);
    if (!store || !count || (capacity && !cameras))
        return lp_store_fail_argument("store, cameras or count is NULL", error);
    lensprof_status status = lp_store_begin(store, false, error);
    if (status != LENSPROF_OK) return status;
    status = visit_all(store, list_camera, &list, error);
    lp_store_rollback(store);
    if (status == LENSPROF_OK) {
        *count = list.found;
        if (capacity && list.found > capacity)
            status = lp_store_fail_capacity(list.found, capacity, error);
        else if (list.kept)
            memcpy(cameras, list.all, list.kept * sizeof *cameras);
    }
    free(list.all);
    return status;
}

/* From one database into another. */
typedef struct transfer {
    lensprof_store *to;
    const lensprof_store *from;
} transfer;

static lensprof_status add_camera(void *user, int64_t id, const lensprof_camera_model *camera, const char *wrong,
                                  lensprof_error *error) {
    const transfer *t = user;
    if (wrong) return refuse(t->from, id, wrong, error);
    return put(t->to, "INSERT OR IGNORE " INTO, camera, error);
}

lensprof_status lp_store_merge_cameras(lensprof_store *store, lensprof_store *other, lensprof_error *error) {
    transfer t = {store, other};
    return visit_all(other, add_camera, &t, error);
}

/* Receives what is wrong. */
typedef struct inspection {
    lp_camera_fault report;
    void *user;
} inspection;

static lensprof_status inspect(void *user, int64_t id, const lensprof_camera_model *camera, const char *wrong,
                               lensprof_error *error) {
    const inspection *i = user;
    (void)camera, (void)error;
    return wrong ? i->report(i->user, id, wrong) : LENSPROF_OK;
}

lensprof_status lp_store_check_cameras(lensprof_store *store, lp_camera_fault report, void *user,
                                       lensprof_error *error) {
    inspection i = {report, user};
    return visit_all(store, inspect, &i, error);
}
