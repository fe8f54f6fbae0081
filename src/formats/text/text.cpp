#include "formats/text/text.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lensprof {

void fail_at_line(size_t line, const std::string &text, lensprof_status status) {
    throw FormatFailure{status, "line " + std::to_string(line) + ": " + text};
}

std::string in_quotes(std::string_view word) {
    std::string text = "\"";
    for (char c : word.substr(0, 40)) text += c >= ' ' && c != 127 ? c : '?';
    return text + (word.size() > 40 ? "...\"" : "\"");
}

FormatFailure failure_at(lensprof_item_kind kind, uint32_t index, const std::string &text, lensprof_status status) {
    const std::string named = (kind == LENSPROF_ITEM_PROFILE ? "profile "
                               : kind == LENSPROF_ITEM_IMAGE ? "image "
                                                             : "frame ")
                              + std::to_string(index);
    const lensprof_item item{static_cast<uint32_t>(kind), index, 0, static_cast<uint32_t>(named.size())};
    return {status, named + ": " + text, item};
}

void set_error(lensprof_error *error, const char *text, const lensprof_item &item) noexcept {
    if (!error) return;
    error->item = item;
    size_t length = strnlen(text, sizeof error->text - 1);
    std::memcpy(error->text, text, length);
    error->text[length] = '\0';
}

bool LineReader::next() {
    begin = end_;
    if (begin == text_.size()) return false;
    size_t stop = text_.find('\n', begin);
    end_ = stop == std::string_view::npos ? text_.size() : stop + 1;
    line = text_.substr(begin, (stop == std::string_view::npos ? text_.size() : stop) - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    number++;
    return true;
}

std::string_view next_word(std::string_view &line) {
    size_t begin = 0;
    while (begin < line.size() && is_blank(line[begin])) begin++;
    size_t end = begin;
    while (end < line.size() && !is_blank(line[end])) end++;
    std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

size_t find_not_utf8(std::string_view text) {
    size_t position = 0;
    const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    while (position < text.size()) {
        const unsigned lead = byte(position);
        const size_t more = lead < 0x80 ? 0 : lead < 0xC2 ? 4 : lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : lead < 0xF5 ? 3 : 4;
        if (more == 4) return position;
        for (size_t i = 1; i <= more; i++)
            if ((byte(position + i) & 0xC0) != 0x80) return position;
        const unsigned next = byte(position + 1);  // overlong forms, surrogates, beyond U+10FFFF
        if ((lead == 0xE0 && next < 0xA0) || (lead == 0xED && next > 0x9F) || (lead == 0xF0 && next < 0x90)
            || (lead == 0xF4 && next > 0x8F))
            return position;
        position += 1 + more;
    }
    return position;
}

void put_text(char *field, size_t capacity, std::string_view text) {
    size_t length = std::min(text.size(), capacity - 1);
    while (length < text.size() && length && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) length--;
    std::memset(field, 0, capacity);
    std::memcpy(field, text.data(), length);
}

void put_name(char *field, size_t capacity, const char *name) {
    put_text(field, capacity, name ? name : "");
    for (char *c = field; *c; c++)
        if ((*c > 0 && *c < ' ') || *c == 127) *c = '?';
    if (find_not_utf8(field) < std::string_view(field).size()) std::memset(field, 0, capacity);
}

lensprof_status copy_bytes(std::string_view source, void *data, size_t capacity, size_t *count,
                           lensprof_error *error) noexcept {
    if (count) *count = source.size();
    if (!capacity) return LENSPROF_OK;
    if (capacity < source.size()) {
        set_error(error, "the buffer is too small; call with capacity 0 to get the size, then call again");
        return LENSPROF_ERROR_CAPACITY;
    }
    if (!source.empty()) std::memcpy(data, source.data(), source.size());
    if (capacity > source.size()) static_cast<char *>(data)[source.size()] = '\0';
    return LENSPROF_OK;
}

}  // namespace lensprof
