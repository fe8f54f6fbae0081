#include "cli/program/utf8.hpp"

#include <algorithm>

#include "cli/program/format.hpp"

namespace lensprof {

size_t utf8_length(const std::string &text, size_t at) {
    const auto byte = [&](size_t i) { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u; };
    const unsigned lead = byte(0);
    const size_t length = lead < 0x80                   ? 1
                          : lead >= 0xc2 && lead < 0xe0 ? 2
                          : lead >= 0xe0 && lead < 0xf0 ? 3
                          : lead >= 0xf0 && lead < 0xf5 ? 4
                                                        : 0;
    for (size_t i = 1; i < length; i++)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    const bool overlong = (lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xf0 && byte(1) < 0x90);
    const bool no_character = (lead == 0xed && byte(1) >= 0xa0) || (lead == 0xf4 && byte(1) >= 0x90);
    return overlong || no_character ? 0 : length;
}

bool is_utf8(const std::string &text) {
    for (size_t at = 0; at < text.size();) {
        const size_t length = utf8_length(text, at);
        if (length == 0) return false;
        at += length;
    }
    return true;
}

size_t utf8_cut(const std::string &text, size_t bytes) {
    size_t length = std::min(text.size(), bytes);
    while (length > 0 && length < text.size() && (static_cast<unsigned char>(text[length]) & 0xc0) == 0x80) length--;
    return length;
}

std::string one_line(const std::string &text) {
    constexpr size_t most = 2000, start = 400, end = 800;
    if (text.size() > most) {
        size_t tail = text.size() - end;
        while (tail < text.size() && (static_cast<unsigned char>(text[tail]) & 0xc0) == 0x80) tail++;
        const size_t head = utf8_cut(text, start);
        return one_line(text.substr(0, head)) + "... (" + std::to_string(tail - head) + " bytes) ..."
               + one_line(text.substr(tail));
    }
    std::string line;
    for (size_t at = 0; at < text.size(); at++) {
        const auto byte = static_cast<unsigned char>(text[at]);
        const unsigned next = byte == 0xc2 && at + 1 < text.size() ? static_cast<unsigned char>(text[at + 1]) : 0u;
        if (next >= 0x80 && next < 0xa0)
            line += format("\\x%02x\\x%02x", byte, next), at++;
        else
            line += byte < 0x20 || byte == 0x7f ? format("\\x%02x", byte) : std::string(1, text[at]);
    }
    return line;
}

}  // namespace lensprof
