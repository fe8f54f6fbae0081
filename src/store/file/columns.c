/* Values to and from SQL. What is read is not trusted: type, range and size are checked here. */
#include "store/file/private.h"

#include <math.h>
#include <string.h>

#define LARGEST_BLOB                                                                                \
    (4 * 3 * LENSPROF_GRID_SIDE * LENSPROF_GRID_SIDE) /* bytes: a gain grid; a covariance has 10368 \
                                                       */

static void bound(lp_store_binder *binder, int rc) {
    if (binder->rc == SQLITE_OK) binder->rc = rc;
}

void lp_bind_integer(lp_store_binder *binder, int64_t value) {
    bound(binder, sqlite3_bind_int64(binder->statement, ++binder->column, value));
}

void lp_bind_real(lp_store_binder *binder, double value) {
    bound(binder, sqlite3_bind_double(binder->statement, ++binder->column, value));
}

void lp_bind_known(lp_store_binder *binder, double value) {
    if (value == LENSPROF_UNKNOWN)
        lp_bind_null(binder);
    else
        lp_bind_real(binder, value);
}

void lp_bind_null(lp_store_binder *binder) { bound(binder, sqlite3_bind_null(binder->statement, ++binder->column)); }

void lp_bind_text(lp_store_binder *binder, const char *text) {
    bound(binder, sqlite3_bind_text(binder->statement, ++binder->column, text, -1, SQLITE_STATIC));
}

static void put_little_endian(uint64_t bits, uint32_t count, unsigned char *bytes) {
    for (uint32_t b = 0; b < count; b++) bytes[b] = (unsigned char)(bits >> (8 * b));
}

static uint64_t get_little_endian(const unsigned char *bytes, uint32_t count) {
    uint64_t bits = 0;
    for (uint32_t b = 0; b < count; b++) bits |= (uint64_t)bytes[b] << (8 * b);
    return bits;
}

void lp_bind_doubles(lp_store_binder *binder, const double *values, uint32_t count) {
    unsigned char bytes[LARGEST_BLOB];
    for (uint32_t i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        put_little_endian(bits, 8, bytes + 8 * i);
    }
    bound(binder, sqlite3_bind_blob(binder->statement, ++binder->column, bytes, (int)(8 * count), SQLITE_TRANSIENT));
}

void lp_bind_floats(lp_store_binder *binder, const float *values, uint32_t count) {
    unsigned char bytes[LARGEST_BLOB];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        put_little_endian(bits, 4, bytes + 4 * i);
    }
    bound(binder, sqlite3_bind_blob(binder->statement, ++binder->column, bytes, (int)(4 * count), SQLITE_TRANSIENT));
}

static void bad(lp_store_reader *reader, int column) {
    const char *name = sqlite3_column_name(reader->statement, column);
    if (!reader->bad) reader->bad = name ? name : "a column";
}

int64_t lp_read_integer(lp_store_reader *reader, int64_t low, int64_t high) {
    int column = reader->column++;
    int64_t value = sqlite3_column_int64(reader->statement, column);
    if (sqlite3_column_type(reader->statement, column) == SQLITE_INTEGER && value >= low && value <= high) return value;
    bad(reader, column);
    return low;
}

double lp_read_real(lp_store_reader *reader) {
    int column = reader->column++;
    double value = sqlite3_column_double(reader->statement, column);
    if (sqlite3_column_type(reader->statement, column) == SQLITE_FLOAT && isfinite(value)) return value;
    bad(reader, column);
    return 0.0;
}

double lp_read_known(lp_store_reader *reader) {
    int column = reader->column++, type = sqlite3_column_type(reader->statement, column);
    if (type == SQLITE_NULL) return LENSPROF_UNKNOWN;
    double value = sqlite3_column_double(reader->statement, column);
    if (type == SQLITE_FLOAT && value >= 0.0) return value;
    bad(reader, column);
    return LENSPROF_UNKNOWN;
}

bool lp_read_null(lp_store_reader *reader) {
    if (sqlite3_column_type(reader->statement, reader->column) != SQLITE_NULL) return false;
    reader->column++;
    return true;
}

void lp_read_nothing(lp_store_reader *reader) {
    if (!lp_read_null(reader)) bad(reader, reader->column++);
}

void lp_read_text(lp_store_reader *reader, char *text, size_t capacity) {
    int column = reader->column++;
    memset(text, 0, capacity);
    if (sqlite3_column_type(reader->statement, column) == SQLITE_TEXT) {
        const char *found = (const char *)sqlite3_column_text(reader->statement, column);
        size_t bytes = (size_t)sqlite3_column_bytes(reader->statement, column);
        if (found && bytes < capacity && !memchr(found, 0, bytes)) {
            memcpy(text, found, bytes);
            return;
        }
    }
    bad(reader, column);
}

/* The blob of the next column when it has exactly this size, else NULL. */
static const unsigned char *read_blob(lp_store_reader *reader, uint64_t size) {
    int column = reader->column++;
    const unsigned char *bytes = NULL;
    if (sqlite3_column_type(reader->statement, column) == SQLITE_BLOB)
        bytes = sqlite3_column_blob(reader->statement, column);
    if (bytes && (uint64_t)sqlite3_column_bytes(reader->statement, column) == size) return bytes;
    bad(reader, column);
    return NULL;
}

void lp_read_doubles(lp_store_reader *reader, double *values, uint32_t count) {
    const unsigned char *bytes = read_blob(reader, 8 * (uint64_t)count);
    for (uint32_t i = 0; bytes && i < count; i++) {
        uint64_t bits = get_little_endian(bytes + 8 * i, 8);
        memcpy(&values[i], &bits, sizeof bits);
    }
}

void lp_read_floats(lp_store_reader *reader, float *values, uint32_t count) {
    const unsigned char *bytes = read_blob(reader, 4 * (uint64_t)count);
    for (uint32_t i = 0; bytes && i < count; i++) {
        uint32_t bits = (uint32_t)get_little_endian(bytes + 4 * i, 4);
        memcpy(&values[i], &bits, sizeof bits);
    }
}

uint32_t lp_read_name(lp_store_reader *reader, const char *const *names, uint32_t count) {
    char text[16];
    int column = reader->column;
    lp_read_text(reader, text, sizeof text);
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(text, names[i]) == 0) return i;
    bad(reader, column);
    return 0;
}
