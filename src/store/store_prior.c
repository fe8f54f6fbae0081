/* The profile that is in another one: the number behind the method, as in "transfer+12" and "transfer+12 (forced)". */
#include <lensprof/store.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* "+12" of the method, and how long it is; NULL where there is none. */
static const char *find_prior(const char *method, size_t *length)
{
    const char *plus = strrchr(method, '+');
    if (!plus) return NULL;
    const size_t digits = strspn(plus + 1, "0123456789");
    const char after = plus[1 + digits];
    *length = 1 + digits;
    return digits && (!after || after == ' ') ? plus : NULL;
}

int64_t lensprof_provenance_prior(const lensprof_provenance *provenance)
{
    size_t length;
    const char *prior = provenance ? find_prior(provenance->method, &length) : NULL;
    const long long id = prior ? strtoll(prior + 1, NULL, 10) : 0;
    return id < INT64_MAX ? id : 0; /* what is too large for a number is none */
}

lensprof_status lensprof_provenance_set_prior(lensprof_provenance *provenance, int64_t id)
{
    char method[2 * sizeof provenance->method], number[24] = "";
    if (!provenance || id < 0) return LENSPROF_ERROR_ARGUMENT;
    size_t length = 0;
    const char *old = find_prior(provenance->method, &length);
    const char *forced = old ? NULL : strstr(provenance->method, " (");
    const char *place = old ? old : forced ? forced : provenance->method + strlen(provenance->method);
    if (id) snprintf(number, sizeof number, "+%" PRId64, id);
    const int size = snprintf(method, sizeof method, "%.*s%s%s", (int)(place - provenance->method), provenance->method,
                              number, place + length);
    if (size < 0 || (size_t)size >= sizeof provenance->method) return LENSPROF_ERROR_CAPACITY;
    memset(provenance->method, 0, sizeof provenance->method);
    memcpy(provenance->method, method, (size_t)size);
    return LENSPROF_OK;
}
