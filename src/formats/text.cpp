#include "text.hpp"

#include <charconv>
#include <cmath>
#include <cstring>

namespace lensprof {

void fail_at_line(size_t line, const std::string &text, lensprof_status status) {
    throw FormatFailure{status, "line " + std::to_string(line) + ": " + text};
}

std::string quoted(std::string_view word) {
    std::string text = "\"";
    for (char c : word.substr(0, 40)) text += c >= ' ' && c != 127 ? c : '?';
    return text + (word.size() > 40 ? "...\"" : "\"");
}

void set_error(lensprof_error *error, const char *text) noexcept {
    if (!error) return;
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

bool read_number(std::string_view text, double &value) {
    if (!text.empty() && text[0] == '+') text.remove_prefix(1);
    double number;
    auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failed != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return false;
    value = number;
    return true;
}

bool read_whole(std::string_view text, double low, double high, double &value) {
    double number;
    if (!read_number(text, number) || number != std::floor(number) || number < low || number > high) return false;
    value = number;
    return true;
}

std::string number_text(double value) {
    char buffer[32];
    auto result = std::to_chars(buffer, buffer + sizeof buffer, value == 0 ? 0.0 : value);  // no "-0"
    return std::string(buffer, result.ptr);
}

lensprof_status copy_text(const std::string &source, char *text, size_t capacity, size_t *needed) noexcept {
    if (needed) *needed = source.size();
    if (capacity < source.size()) return LENSPROF_ERROR_CAPACITY;
    if (!source.empty()) std::memcpy(text, source.data(), source.size());
    if (capacity > source.size()) text[source.size()] = '\0';
    return LENSPROF_OK;
}

}  // namespace lensprof
