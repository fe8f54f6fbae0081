#include "fit/base/fail.hpp"

#include <cstdarg>
#include <cstdio>

namespace lensprof {

lensprof_status fail(lensprof_status status, lensprof_error *error, const char *format, ...) {
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        error->item = lensprof_item{};
        std::vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
    }
    return status;
}

lensprof_status fail_at(lensprof_item_kind kind, uint32_t index, lensprof_status status, lensprof_error *error,
                        const char *format, ...) {
    if (!error) return status;
    const int bytes = std::snprintf(error->text, sizeof error->text, "%s %u", item_word(kind), index);
    const auto named = static_cast<uint32_t>(bytes);
    error->item = {static_cast<uint32_t>(kind), index, 0, named};
    std::snprintf(error->text + named, sizeof error->text - named, ": ");
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(error->text + named + 2, sizeof error->text - named - 2, format, arguments);
    va_end(arguments);
    return status;
}

const char *item_word(uint32_t kind) {
    static const char *const words[] = {"",     "image",   "pair",  "observation", "point",
                                        "shot", "profile", "frame", "match"};
    return kind < sizeof words / sizeof *words ? words[kind] : "";
}

}  // namespace lensprof
