/* Statuses with a sentence. */
#ifndef LENSPROF_CORE_FAIL_H
#define LENSPROF_CORE_FAIL_H

#include <lensprof/base.h>

/* Returns `status`, and puts the text, cut to fit, into *error, which may be NULL. */
lensprof_status lp_fail(lensprof_error *error, lensprof_status status, const char *text);

#endif
