/* Shared by the files of the store. Only they see SQLite. */
#ifndef LENSPROF_STORE_PRIVATE_H
#define LENSPROF_STORE_PRIVATE_H

#include <lensprof/store.h>
#include <sqlite3.h>
#include <stdbool.h>

#include "core/profile.h"

#define LP_STORE_APPLICATION_ID 0x4C505246 /* as in 0001_profiles.sql */
#define LP_STORE_LAYOUT 7                  /* that of the newest schema */
#define LP_STORE_BUSY_MS 5000

#define LP_STORE_STATEMENTS 48 /* more than there are in the sources; what is beyond is prepared each time */

struct lensprof_store {
    sqlite3 *db;
    uint32_t mode;
    int busy_ms;        /* how long it waits for other processes */
    bool journal_ready; /* the journal mode is what it is to be */
    bool immutable;     /* read without locks, from where nobody can write a log */
    int layout;         /* of the file, as the transaction found or made it */
    bool batch;         /* the caller's transaction is open: calls are savepoints in it */
    uint32_t prepared;  /* statements that are kept for the next call */
    struct {
        const char *sql; /* a literal, known by its address */
        sqlite3_stmt *statement;
    } kept[LP_STORE_STATEMENTS];
    char damage[64];          /* last text of lp_store_fail_profile */
    lensprof_profile scratch; /* 50 kB: a profile is read here first, so that on error outputs are untouched */
    char path[];              /* as the caller wrote it, for error texts */
};

/* profiles/schema: number n makes layout n of layout n - 1. */
extern const char lp_schema_0001[], lp_schema_0002[], lp_schema_0003[], lp_schema_0004[], lp_schema_0005[],
    lp_schema_0006[], lp_schema_0007[];

/* place.c: what lies around the file with the full path `full`. */
bool lp_store_has_log(const char *full); /* a log that is not empty exists next to the file */
bool lp_store_is_folder_writable(const char *full, bool *exists);

/* error.c: each sets `error` (may be NULL) to "path: what; next" and returns the status. */
lensprof_status lp_store_fail(const char *path, lensprof_status status, const char *problem, const char *next,
                              lensprof_error *error);
/* For a result code of SQLite on this store; `db` (may be NULL) adds its message. Never LENSPROF_OK. */
lensprof_status lp_store_fail_sql(const char *path, sqlite3 *db, int rc, lensprof_error *error);
/* For a wrong argument; the text names it and not the file. */
lensprof_status lp_store_fail_argument(const char *problem, lensprof_error *error);
lensprof_status lp_store_fail_capacity(uint32_t rows, uint32_t capacity, lensprof_error *error);
/* STRUCT_SIZE for a struct; `wrong` is the result of lp_sized_wrong. */
lensprof_status lp_store_fail_size(const char *name, const char *wrong, lensprof_error *error);
/* Whether a profile's struct_size is one that this library knows; also of outputs. */
lensprof_status lp_store_check_size(const lensprof_profile *profile, lensprof_error *error);
/* CORRUPT and NOT_FOUND for the profile with an id. */
lensprof_status lp_store_fail_profile(lensprof_store *store, int64_t id, const char *problem, lensprof_error *error);
lensprof_status lp_store_fail_missing(const lensprof_store *store, int64_t id, lensprof_error *error);
void lp_store_clear(lensprof_error *error);

/* header.c: the content of the first 100 bytes, read without lock, journal or trace. */
typedef enum lp_store_file {
    LP_STORE_FILE_MISSING,
    LP_STORE_FILE_EMPTY,
    LP_STORE_FILE_OURS,
    LP_STORE_FILE_LOGGED, /* ours, in write-ahead mode */
    LP_STORE_FILE_FOREIGN
} lp_store_file;
/* `full` receives the full path, sqlite3_free it. Errors: NOT_FOUND, STORE, MEMORY ... with text. */
lensprof_status lp_store_probe(const char *path, lp_store_file *file, char **full, lensprof_error *error);

/* log.c: the write-ahead log. */
int lp_store_settle_journal(lensprof_store *store); /* after a commit, which its result code does not change */
void lp_store_clear_log(const char *full);          /* files of a log that could not be begun; never one in use */

/* connection.c: a new connection, configured for the store's mode; result code. */
int lp_store_connect(const lensprof_store *store, const char *full, bool immutable, sqlite3 **db);
/* Connects again if another process has begun to write a log next to an immutable file. */
lensprof_status lp_store_refresh(lensprof_store *store, lensprof_error *error);

/* open.c. */
/* lensprof_store_open waits LP_STORE_BUSY_MS for other processes; tests wait less. */
lensprof_status lp_store_open_waiting(const char *path, uint32_t mode, int busy_ms, lensprof_store **store,
                                      lensprof_error *error);

/* transaction.c */
int lp_store_number(sqlite3 *db, const char *sql, int64_t *value); /* result code; one integer from one row */
int lp_store_migrate(sqlite3 *db, int layout); /* result code; from tables of `layout` to those of LP_STORE_LAYOUT */
/* Starts a transaction and checks that the file is (still) a database. One of an older layout is read as it is, and
 * brought up to date by the first transaction that writes, as a part of it. */
lensprof_status lp_store_begin(lensprof_store *store, bool write, lensprof_error *error);
/* Within a transaction: the statement for the layout of the file, of those for layouts 1 to LP_STORE_LAYOUT. */
const char *lp_store_of_layout(const lensprof_store *store, const char *const *statements);
lensprof_status lp_store_commit(lensprof_store *store, lensprof_error *error); /* rolls back when it fails */
void lp_store_rollback(lensprof_store *store);

/* statements.c: statements are prepared once a handle. `sql` is a literal. The statement is the caller's until he
 * releases it, whatever happened to it. */
lensprof_status lp_store_prepare(lensprof_store *store, const char *sql, sqlite3_stmt **statement,
                                 lensprof_error *error);
void lp_store_release(lensprof_store *store, sqlite3_stmt *statement);
void lp_store_forget_statements(lensprof_store *store);       /* before the connection is closed */
int lp_store_execute(lensprof_store *store, const char *sql); /* result code; without parameters, rows */
int lp_store_integer(lensprof_store *store, const char *sql, int64_t *value); /* as lp_store_number */

/* columns.c (and lp_store_run in statements.c): parameters and columns, each call takes the next one. */
typedef struct lp_store_binder {
    sqlite3_stmt *statement;
    int column;
    int rc; /* the first failure */
} lp_store_binder;
void lp_bind_integer(lp_store_binder *binder, int64_t value);
void lp_bind_real(lp_store_binder *binder, double value);
void lp_bind_known(lp_store_binder *binder, double value); /* LENSPROF_UNKNOWN becomes NULL */
void lp_bind_null(lp_store_binder *binder);
void lp_bind_text(lp_store_binder *binder, const char *text);
void lp_bind_doubles(lp_store_binder *binder, const double *values, uint32_t count); /* little-endian blobs */
void lp_bind_floats(lp_store_binder *binder, const float *values, uint32_t count);

/* Runs a statement that returns no row, and releases it. */
lensprof_status lp_store_run(lensprof_store *store, lp_store_binder *binder, lensprof_error *error);

typedef struct lp_store_reader {
    sqlite3_stmt *statement;
    int column;
    const char *bad; /* name of the first column with an impossible value; NULL = none */
} lp_store_reader;
int64_t lp_read_integer(lp_store_reader *reader, int64_t low, int64_t high);
double lp_read_real(lp_store_reader *reader);  /* finite */
double lp_read_known(lp_store_reader *reader); /* >= 0, infinity too, or LENSPROF_UNKNOWN for NULL */
bool lp_read_null(lp_store_reader *reader);    /* true and past it when the next column is NULL */
void lp_read_nothing(lp_store_reader *reader); /* NULL */
void lp_read_text(lp_store_reader *reader, char *text, size_t capacity); /* zero-filled to capacity */
void lp_read_doubles(lp_store_reader *reader, double *values, uint32_t count);
void lp_read_floats(lp_store_reader *reader, float *values, uint32_t count);
uint32_t lp_read_name(lp_store_reader *reader, const char *const *names, uint32_t count); /* index of the text */

#endif
