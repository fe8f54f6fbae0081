#include "photo/base/shell_word.hpp"

#include "photo/base/format.hpp"

namespace lensprof {

std::string shell_word(const std::string &word) {
    constexpr const char *plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,:=+@%";
    const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string::npos;
    return is_plain ? word : shell_quoted(word);
}

}  // namespace lensprof
