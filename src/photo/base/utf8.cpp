#include "photo/base/utf8.hpp"

#include <algorithm>

#include "photo/base/format.hpp"

namespace lensprof {

size_t utf8_length(const std::string &text, size_t offset) {
    const auto byte = [&](size_t i) {
        return offset + i < text.size() ? static_cast<unsigned char>(text[offset + i]) : 0u;
    };
    const unsigned lead = byte(0);
    const size_t length = lead < 0x80                   ? 1
                          : lead >= 0xc2 && lead < 0xe0 ? 2
                          : lead >= 0xe0 && lead < 0xf0 ? 3
                          : lead >= 0xf0 && lead < 0xf5 ? 4
                                                        : 0;
    for (size_t i = 1; i < length; i++)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool is_overlong = (lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xf0 && byte(1) < 0x90);
    const bool is_invalid = (lead == 0xed && byte(1) >= 0xa0) || (lead == 0xf4 && byte(1) >= 0x90);
    return is_overlong || is_invalid ? 0 : length;
}

bool is_utf8(const std::string &text) {
    for (size_t offset = 0; offset < text.size();) {
        const size_t length = utf8_length(text, offset);
        if (length == 0) return false;
        offset += length;
    }
    return true;
}

size_t utf8_cut(const std::string &text, size_t bytes) {
    size_t length = std::min(text.size(), bytes);
    while (length > 0 && length < text.size() && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) length--;
    return length;
}

std::string one_line(const std::string &text) {
    constexpr size_t max_bytes = 2000, head_bytes = 400, tail_bytes = 800;
    if (text.size() > max_bytes) {
        size_t tail = text.size() - tail_bytes;
        while (tail < text.size() && (static_cast<unsigned char>(text[tail]) & 0xc0) == 0x80) tail++;
        const size_t head = utf8_cut(text, head_bytes);
        return one_line(text.substr(0, head)) + "... (" + std::to_string(tail - head) + " bytes) ..."
               + one_line(text.substr(tail));
    }
    std::string line;
    for (size_t index = 0; index < text.size(); index++) {
        const auto byte = static_cast<unsigned char>(text[index]);
        const unsigned next =
            byte == 0xc2 && index + 1 < text.size() ? static_cast<unsigned char>(text[index + 1]) : 0u;
        if (next >= 0x80 && next < 0xa0)
            line += format("\\x%02x\\x%02x", byte, next), index++;
        else
            line += byte < 0x20 || byte == 0x7f ? format("\\x%02x", byte) : std::string(1, text[index]);
    }
    return line;
}

std::string valid_line(const std::string &text) {
    std::string valid = one_line(text);
    for (size_t i = 0; i < valid.size();) {
        const size_t length = utf8_length(valid, i);
        if (!length) valid[i] = '?';
        i += std::max<size_t>(length, 1);
    }
    return valid;
}

}  // namespace lensprof
