// Error texts of the layer's C functions.
#pragma once

#include <lensprof/base.h>

namespace lensprof {

// Puts a formatted sentence into `error` (may be NULL) and returns `status`.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
lensprof_status
fail(lensprof_status status, lensprof_error *error, const char *format, ...);

}  // namespace lensprof
