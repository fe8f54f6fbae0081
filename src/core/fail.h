/* Statuses with an error text. */
#ifndef LENSPROF_CORE_FAIL_H
#define LENSPROF_CORE_FAIL_H

#include <lensprof/base.h>

/* Returns `status` and copies the text, truncated to fit, into *error, which may be NULL. */
lensprof_status lp_fail(lensprof_error *error, lensprof_status status, const char *text);

#endif
