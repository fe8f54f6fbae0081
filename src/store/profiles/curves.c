/* The rows that hang on a profile: responses with their coefficients, vignettings, and the gain grid. */
#include "store/profiles/profiles.h"

#include <string.h>

const char *const lp_store_kinds[LP_STORE_KINDS] = {"linear", "gamma", "emor", "table"};

lensprof_status lp_store_rebuild(const lensprof_response *from, lensprof_response *response) {
    lensprof_response_set_linear(response);
    switch (from->kind) {
    case LENSPROF_RESPONSE_LINEAR: return LENSPROF_OK;
    case LENSPROF_RESPONSE_GAMMA: return lensprof_response_set_gamma(response, from->gamma);
    case LENSPROF_RESPONSE_EMOR: return lensprof_response_set_emor(response, from->emor, from->modes);
    case LENSPROF_RESPONSE_TABLE: /* copied, not resampled: every bit stays */
        response->kind = LENSPROF_RESPONSE_TABLE;
        memcpy(response->table, from->table, sizeof response->table);
        return lensprof_response_validate(response);
    default: return LENSPROF_ERROR_ARGUMENT;
    }
}

static lensprof_status put_coefficient(lensprof_store *store, int64_t id, uint32_t curve, uint32_t mode,
                                       double coefficient, lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(
        store, "INSERT INTO emor_coefficients (profile_id, curve, mode, coefficient) VALUES (?, ?, ?, ?)",
        &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_integer(&binder, id);
    lp_bind_integer(&binder, curve);
    lp_bind_integer(&binder, mode);
    lp_bind_real(&binder, coefficient);
    return lp_store_run(store, &binder, error);
}

static lensprof_status put_response(lensprof_store *store, int64_t id, uint32_t curve,
                                    const lensprof_response *response, lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(
        store, "INSERT INTO responses (profile_id, curve, kind, gamma, emor_modes, samples) VALUES (?, ?, ?, ?, ?, ?)",
        &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    bool is_emor = response->kind == LENSPROF_RESPONSE_EMOR;
    lp_bind_integer(&binder, id);
    lp_bind_integer(&binder, curve);
    lp_bind_text(&binder, lp_store_kinds[response->kind]);
    if (response->kind == LENSPROF_RESPONSE_GAMMA)
        lp_bind_real(&binder, response->gamma);
    else
        lp_bind_null(&binder);
    if (is_emor)
        lp_bind_integer(&binder, response->modes);
    else
        lp_bind_null(&binder);
    if (response->kind == LENSPROF_RESPONSE_TABLE)
        lp_bind_doubles(&binder, response->table, LENSPROF_RESPONSE_SAMPLES);
    else
        lp_bind_null(&binder);
    status = lp_store_run(store, &binder, error);
    for (uint32_t l = 0; is_emor && l < response->modes && status == LENSPROF_OK; l++)
        status = put_coefficient(store, id, curve, l + 1, response->emor[l], error);
    return status;
}

static lensprof_status put_vignetting(lensprof_store *store, int64_t id, uint32_t curve,
                                      const lensprof_vignetting *vignetting, lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(
        store,
        "INSERT INTO vignettings (profile_id, curve, k1, k2, k3, center_x, center_y) VALUES (?, ?, ?, ?, ?, ?, ?)",
        &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_integer(&binder, id);
    lp_bind_integer(&binder, curve);
    for (int i = 0; i < 3; i++) lp_bind_real(&binder, vignetting->k[i]);
    for (int i = 0; i < 2; i++) lp_bind_real(&binder, vignetting->center[i]);
    return lp_store_run(store, &binder, error);
}

static uint32_t nodes_of(const lensprof_gain_grid *grid) { return grid->channels * grid->rows * grid->columns; }

static lensprof_status put_grid(lensprof_store *store, int64_t id, const lensprof_gain_grid *grid,
                                lensprof_error *error) {
    lp_store_binder binder = {NULL, 0, SQLITE_OK};
    lensprof_status status = lp_store_prepare(
        store,
        "INSERT INTO gain_grids (profile_id, grid_columns, grid_rows, channels, attenuation) VALUES (?, ?, ?, ?, ?)",
        &binder.statement, error);
    if (status != LENSPROF_OK) return status;
    lp_bind_integer(&binder, id);
    lp_bind_integer(&binder, grid->columns);
    lp_bind_integer(&binder, grid->rows);
    lp_bind_integer(&binder, grid->channels);
    lp_bind_floats(&binder, grid->attenuation, nodes_of(grid));
    return lp_store_run(store, &binder, error);
}

lensprof_status lp_store_put_curves(lensprof_store *store, int64_t id, const lensprof_profile *profile,
                                    lensprof_error *error) {
    lensprof_status status = LENSPROF_OK;
    for (uint32_t c = 0; c < profile->responses && status == LENSPROF_OK; c++)
        status = put_response(store, id, c, &profile->response[c], error);
    for (uint32_t c = 0; c < profile->vignettings && status == LENSPROF_OK; c++)
        status = put_vignetting(store, id, c, &profile->vignetting[c], error);
    if (profile->grid.columns && status == LENSPROF_OK) status = put_grid(store, id, &profile->grid, error);
    return status;
}

/* Rows of one profile that must be there, no fewer and no more. */
typedef struct rows {
    const char *sql; /* ?1 is the profile, ?2 (if any) the curve */
    uint32_t curve, count;
    const char *wrong_count; /* its error text */
    void (*read)(lp_store_reader *reader, uint32_t index, void *target);
    void *target;
} rows;

static lensprof_status read_statement(lensprof_store *store, int64_t id, const rows *wanted, sqlite3_stmt *statement,
                                      lensprof_error *error) {
    int rc = sqlite3_bind_int64(statement, 1, id);
    if (rc == SQLITE_OK && sqlite3_bind_parameter_count(statement) > 1)
        rc = sqlite3_bind_int64(statement, 2, wanted->curve);
    if (rc) return lp_store_fail_sql(store->path, store->db, rc, error);
    uint32_t index = 0;
    while ((rc = sqlite3_step(statement)) == SQLITE_ROW && index < wanted->count) {
        lp_store_reader reader = {statement, 0, NULL};
        wanted->read(&reader, index++, wanted->target);
        if (reader.bad) return lp_store_fail_profile(store, id, reader.bad, error);
    }
    if (rc != SQLITE_DONE && rc != SQLITE_ROW) return lp_store_fail_sql(store->path, store->db, rc, error);
    if (rc == SQLITE_ROW || index < wanted->count) return lp_store_fail_profile(store, id, wanted->wrong_count, error);
    return LENSPROF_OK;
}

static lensprof_status read_rows(lensprof_store *store, int64_t id, const rows *wanted, lensprof_error *error) {
    sqlite3_stmt *statement;
    lensprof_status status = lp_store_prepare(store, wanted->sql, &statement, error);
    if (status != LENSPROF_OK) return status;
    status = read_statement(store, id, wanted, statement, error);
    lp_store_release(store, statement);
    return status;
}

static void read_vignetting(lp_store_reader *reader, uint32_t index, void *target) {
    lensprof_vignetting *vignetting = (lensprof_vignetting *)target + index;
    (void)lp_read_integer(reader, index, index);
    for (int i = 0; i < 3; i++) vignetting->k[i] = lp_read_real(reader);
    for (int i = 0; i < 2; i++) vignetting->center[i] = lp_read_real(reader);
}

static void read_grid(lp_store_reader *reader, uint32_t index, void *target) {
    lensprof_gain_grid *grid = (lensprof_gain_grid *)target + index;
    grid->columns = (uint32_t)lp_read_integer(reader, 2, LENSPROF_GRID_SIDE);
    grid->rows = (uint32_t)lp_read_integer(reader, 2, LENSPROF_GRID_SIDE);
    grid->channels = (uint32_t)lp_read_integer(reader, 1, 3); /* lensprof_profile_validate refuses 2 */
    lp_read_floats(reader, grid->attenuation, nodes_of(grid));
}

/* Only what describes the response; the rest follows from it in lp_store_rebuild. */
static void read_response(lp_store_reader *reader, uint32_t index, void *target) {
    lensprof_response *response = (lensprof_response *)target + index;
    (void)lp_read_integer(reader, index, index);
    response->kind = lp_read_name(reader, lp_store_kinds, LP_STORE_KINDS);
    if (response->kind == LENSPROF_RESPONSE_GAMMA)
        response->gamma = lp_read_real(reader);
    else
        lp_read_nothing(reader);
    if (response->kind == LENSPROF_RESPONSE_EMOR)
        response->modes = (uint32_t)lp_read_integer(reader, 0, LENSPROF_EMOR_MODES);
    else
        lp_read_nothing(reader);
    if (response->kind == LENSPROF_RESPONSE_TABLE)
        lp_read_doubles(reader, response->table, LENSPROF_RESPONSE_SAMPLES);
    else
        lp_read_nothing(reader);
}

static void read_coefficient(lp_store_reader *reader, uint32_t index, void *target) {
    (void)lp_read_integer(reader, (int64_t)index + 1, (int64_t)index + 1);
    ((double *)target)[index] = lp_read_real(reader);
}

static lensprof_status read_coefficients(lensprof_store *store, int64_t id, uint32_t curve, lensprof_response *response,
                                         lensprof_error *error) {
    rows wanted = {"SELECT mode, coefficient FROM emor_coefficients WHERE profile_id = ? AND curve = ? ORDER BY mode",
                   curve,
                   response->modes,
                   "count of emor_coefficients",
                   read_coefficient,
                   response->emor};
    return response->kind == LENSPROF_RESPONSE_EMOR ? read_rows(store, id, &wanted, error) : LENSPROF_OK;
}

static lensprof_status read_responses(lensprof_store *store, int64_t id, lensprof_error *error) {
    lensprof_profile *profile = &store->scratch;
    const rows responses = {
        "SELECT curve, kind, gamma, emor_modes, samples FROM responses WHERE profile_id = ?"
        " ORDER BY curve",
        0,
        profile->responses,
        "count of responses",
        read_response,
        profile->response};
    lensprof_status status = read_rows(store, id, &responses, error);
    for (uint32_t c = 0; c < profile->responses && status == LENSPROF_OK; c++) {
        lensprof_response rebuilt;
        status = read_coefficients(store, id, c, &profile->response[c], error);
        if (status != LENSPROF_OK) break;
        if (lp_store_rebuild(&profile->response[c], &rebuilt) != LENSPROF_OK)
            return lp_store_fail_profile(store, id, "invalid response", error);
        profile->response[c] = rebuilt;
    }
    return status;
}

lensprof_status lp_store_read_curves(lensprof_store *store, int64_t id, bool with_response, uint32_t grids,
                                     lensprof_error *error) {
    lensprof_profile *profile = &store->scratch;
    rows vignettings = {
        "SELECT curve, k1, k2, k3, center_x, center_y FROM vignettings WHERE profile_id = ?"
        " ORDER BY curve",
        0,
        profile->vignettings,
        "count of vignettings",
        read_vignetting,
        profile->vignetting};
    rows gain_grids = {"SELECT grid_columns, grid_rows, channels, attenuation FROM gain_grids WHERE profile_id = ?",
                       0,
                       grids,
                       "count of gain_grids",
                       read_grid,
                       &profile->grid};
    lensprof_status status = with_response ? read_responses(store, id, error) : LENSPROF_OK;
    if (status == LENSPROF_OK) status = read_rows(store, id, &vignettings, error);
    if (status == LENSPROF_OK && store->layout >= 2) status = read_rows(store, id, &gain_grids, error);
    return status;
}
