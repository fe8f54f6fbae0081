#include "fit/base/fail.hpp"

#include <cstdarg>
#include <cstdio>

namespace lensprof {

lensprof_status fail(lensprof_status status, lensprof_error *error, const char *format, ...) {
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        std::vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
    }
    return status;
}

}  // namespace lensprof
