// What the readers and writers of this layer share: text in the C locale, and the boundary to C.
#pragma once

#include <cstddef>
#include <new>
#include <string>
#include <string_view>

#include <lensprof/base.h>

#include "falloff/failure.hpp"
#include "formats/text/numbers.hpp"

namespace lensprof {

// The exception of this layer, which what fits falloffs throws as well. The text is complete: "line 12: what is wrong;
// next step".
using FormatFailure = FalloffFailure;

[[noreturn]] void fail_at_line(size_t line, const std::string &text, lensprof_status status = LENSPROF_ERROR_SYNTAX);

// Word of a file for an error text: in quotes, shortened, control characters as '?'.
std::string in_quotes(std::string_view word);

// The failure "profile 3: text" (or of another item), which is complete.
FormatFailure failure_at(lensprof_item_kind kind, uint32_t index, const std::string &text, lensprof_status status);

// error may be NULL; the text is cut to fit. `item` is what it begins with.
void set_error(lensprof_error *error, const char *text, const lensprof_item &item = {}) noexcept;

// Runs `body` and turns what it throws into a status and an error text.
template <typename Body>
lensprof_status at_boundary(lensprof_error *error, Body body) noexcept {
    set_error(error, "");
    try {
        body();
        return LENSPROF_OK;
    } catch (const FormatFailure &failure) {
        set_error(error, failure.text.c_str(), failure.item);
        return failure.status;
    } catch (const std::bad_alloc &) {
        set_error(error, "out of memory; close other programs or use fewer images");
        return LENSPROF_ERROR_MEMORY;
    } catch (...) {
        set_error(error, "internal error of lensprof: unexpected exception; please report it");
        return LENSPROF_ERROR_INTERNAL;
    }
}

// Walks over the lines of a text. Line ends are LF or CRLF; they are not part of `line`.
class LineReader {
public:
    explicit LineReader(std::string_view text) : text_(text) {}

    bool next();

    std::string_view line;
    size_t number = 0;  // from 1
    size_t begin = 0;   // of the line in the text

private:
    std::string_view text_;
    size_t end_ = 0;
};

inline bool is_blank(char c) { return c == ' ' || c == '\t'; }

// Next word between blanks; moves `line` past it. Empty at the end of the line.
std::string_view next_word(std::string_view &line);

// Offset of the first byte that is not part of well-formed UTF-8; the size if all of it is.
size_t find_not_utf8(std::string_view text);

// Copies to a text field of a value struct; what does not fit is cut between characters.
void put_text(char *field, size_t capacity, std::string_view text);

// The same for a name given by the caller, e.g. of a file: control characters as '?', empty if it is not UTF-8.
void put_name(char *field, size_t capacity, const char *name);

// The caller's bytes, which may be NULL if the size is 0.
inline std::string_view view_of(const void *data, size_t size) {
    return {size ? static_cast<const char *>(data) : "", size};
}

// Copies to a caller's buffer by the rule of base.h: capacity 0 asks for *count; CAPACITY when the buffer is too small.
// A terminator is added where there is room for one.
lensprof_status copy_bytes(std::string_view source, void *data, size_t capacity, size_t *count,
                           lensprof_error *error) noexcept;

// Runs `make`, which returns a whole file, and copies it to the caller's buffer as copy_bytes does.
template <typename Make>
lensprof_status write_at_boundary(void *data, size_t capacity, size_t *count, lensprof_error *error,
                                  Make make) noexcept {
    std::string all;
    const lensprof_status status = at_boundary(error, [&] { all = make(); });
    return status == LENSPROF_OK ? copy_bytes(all, data, capacity, count, error) : status;
}

}  // namespace lensprof
