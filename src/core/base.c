/* Version, names of status codes, and their descriptions. */
#include "core/fail.h"
#include "core/sized.h"

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)

const char *lensprof_version(void) {
    return TEXT(LENSPROF_VERSION_MAJOR) "." TEXT(LENSPROF_VERSION_MINOR) "." TEXT(LENSPROF_VERSION_PATCH);
}

void lensprof_init_sized(void *given, size_t size) { (void)lp_sized_begin(given, size, size); }

lensprof_status lp_fail(lensprof_error *error, lensprof_status status, const char *text) {
    if (!error) return status;
    const lensprof_item none = {LENSPROF_ITEM_NONE, 0, 0, 0};
    size_t length = 0;
    error->item = none;
    for (; text[length] && length + 1 < sizeof error->text; length++) error->text[length] = text[length];
    error->text[length] = 0;
    return status;
}

const char *lensprof_status_name(lensprof_status status) {
    switch (status) {
#define NAME(value) \
    case value: return #value
        NAME(LENSPROF_OK);
        NAME(LENSPROF_ERROR_ARGUMENT);
        NAME(LENSPROF_ERROR_STRUCT_SIZE);
        NAME(LENSPROF_ERROR_SIZE);
        NAME(LENSPROF_ERROR_CAPACITY);
        NAME(LENSPROF_ERROR_NOT_FINITE);
        NAME(LENSPROF_ERROR_MEMORY);
        NAME(LENSPROF_ERROR_CANCELLED);
        NAME(LENSPROF_ERROR_RESPONSE);
        NAME(LENSPROF_ERROR_VIGNETTING);
        NAME(LENSPROF_ERROR_EXPOSURE);
        NAME(LENSPROF_ERROR_GEOMETRY);
        NAME(LENSPROF_ERROR_NO_OVERLAP);
        NAME(LENSPROF_ERROR_NO_SAMPLES);
        NAME(LENSPROF_ERROR_NO_UNKNOWNS);
        NAME(LENSPROF_ERROR_NOT_USABLE);
        NAME(LENSPROF_ERROR_STORE);
        NAME(LENSPROF_ERROR_NOT_FOUND);
        NAME(LENSPROF_ERROR_CORRUPT);
        NAME(LENSPROF_ERROR_LAYOUT);
        NAME(LENSPROF_ERROR_READ_ONLY);
        NAME(LENSPROF_ERROR_FULL);
        NAME(LENSPROF_ERROR_BUSY);
        NAME(LENSPROF_ERROR_SYNTAX);
        NAME(LENSPROF_ERROR_VARIABLE);
        NAME(LENSPROF_ERROR_UNSUPPORTED);
        NAME(LENSPROF_ERROR_READ);
        NAME(LENSPROF_ERROR_WRITE);
        NAME(LENSPROF_ERROR_INTERNAL);
#undef NAME
    }
    return "unknown status";
}
