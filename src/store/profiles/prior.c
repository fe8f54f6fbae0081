/* The profile that is in another one, at the end of the method: BASE, "+" and its id, and perhaps " (forced)". */
#include <lensprof/store.h>

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define FORCED " (forced)"

/* How long a method's parts are: all of it, what is before " (forced)", and what is before "+" and digits there. */
typedef struct parts {
    size_t all, named, base;
} parts;

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* Length of text[length] without a "+" and digits at its end. */
static size_t without_number(const char *text, size_t length) {
    size_t plus = length;
    while (plus > 0 && is_digit(text[plus - 1])) plus--;
    return plus < length && plus > 0 && text[plus - 1] == '+' ? plus - 1 : length;
}

static parts parts_of(const lensprof_provenance *provenance) {
    const char *method = provenance->method, *end = memchr(method, 0, sizeof provenance->method);
    const size_t forced = strlen(FORCED);
    parts p;
    p.named = p.all = end ? (size_t)(end - method) : sizeof provenance->method;
    if (p.all >= forced && !memcmp(method + p.all - forced, FORCED, forced)) p.named -= forced;
    p.base = without_number(method, p.named);
    return p;
}

int64_t lensprof_provenance_prior(const lensprof_provenance *provenance) {
    int64_t id = 0;
    if (!provenance) return 0;
    const parts p = parts_of(provenance);
    for (size_t i = p.base + 1; i < p.named; i++) {
        const int digit = provenance->method[i] - '0';
        if (id > (INT64_MAX - digit) / 10) return 0; /* no number that an id could be */
        id = 10 * id + digit;
    }
    return id;
}

lensprof_status lensprof_provenance_set_prior(lensprof_provenance *provenance, int64_t id) {
    char method[2 * sizeof provenance->method], number[24] = "";
    if (!provenance || id < 0) return LENSPROF_ERROR_ARGUMENT;
    const parts p = parts_of(provenance);
    size_t base = p.base;
    for (size_t shorter; (shorter = without_number(provenance->method, base)) < base;) base = shorter; /* "+1+2" */
    if (id) snprintf(number, sizeof number, "+%" PRId64, id);
    const int size = snprintf(method, sizeof method, "%.*s%s%.*s", (int)base, provenance->method, number,
                              (int)(p.all - p.named), provenance->method + p.named);
    if (size < 0 || (size_t)size >= sizeof provenance->method) return LENSPROF_ERROR_CAPACITY;
    memset(provenance->method, 0, sizeof provenance->method);
    memcpy(provenance->method, method, (size_t)size);
    return LENSPROF_OK;
}
