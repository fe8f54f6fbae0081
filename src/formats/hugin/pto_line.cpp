// The items of a project line. Hugin writes a name directly followed by its value: y-12.5 Ra=0 n"a picture.jpg"
#include <algorithm>

#include "formats/hugin/pto.hpp"
#include "formats/text/text.hpp"

namespace lensprof {

const std::array<PtoParameterInfo, kPtoParameters> kPtoParameterInfo = {{
    {"v", 50, 0},
    {"y", 0, 0},
    {"p", 0, 0},
    {"r", 0, 0},
    {"a", 0, 0},
    {"b", 0, 0},
    {"c", 0, 0},
    {"d", 0, 0},
    {"e", 0, 0},
    {"g", 0, 0},
    {"t", 0, 0},
    {"TrX", 0, 0},
    {"TrY", 0, 0},
    {"TrZ", 0, 0},
    {"Tpy", 0, 0},
    {"Tpp", 0, 0},
    {"Ra", 0, LENSPROF_FREE_RESPONSE},
    {"Rb", 0, LENSPROF_FREE_RESPONSE},
    {"Rc", 0, LENSPROF_FREE_RESPONSE},
    {"Rd", 0, LENSPROF_FREE_RESPONSE},
    {"Re", 0, LENSPROF_FREE_RESPONSE},
    {"Eev", 0, LENSPROF_FREE_EV},
    {"Er", 1, LENSPROF_FREE_RED},
    {"Eb", 1, LENSPROF_FREE_BLUE},
    {"Va", 1, 0},
    {"Vb", 0, LENSPROF_FREE_K1},
    {"Vc", 0, LENSPROF_FREE_K2},
    {"Vd", 0, LENSPROF_FREE_K3},
    {"Vx", 0, LENSPROF_FREE_CENTER},
    {"Vy", 0, LENSPROF_FREE_CENTER},
    {"j", 0, 0},
}};

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool ends_with(std::string_view text, std::string_view end) {
    return text.size() > end.size() && text.substr(text.size() - end.size()) == end;
}

// Letters of a word. In "vnan" the number is not part of the name, so that it is refused rather than overlooked.
size_t name_length(std::string_view word) {
    size_t length = 0;
    while (length < word.size() && is_letter(word[length])) length++;
    for (std::string_view number : {"nan", "NaN", "inf", "Inf"})
        if (length == word.size() && ends_with(word, number)) return length - number.size();
    return length;
}

}  // namespace

size_t find_pto_parameter(std::string_view name) {
    auto same = [&](const PtoParameterInfo &info) { return info.name == name; };
    auto found = std::find_if(kPtoParameterInfo.begin(), kPtoParameterInfo.end(), same);
    return static_cast<size_t>(found - kPtoParameterInfo.begin());
}

std::vector<PtoToken> split_pto_line(std::string_view line, size_t number) {
    std::vector<PtoToken> tokens;
    size_t position = 1;
    while (position < line.size()) {
        if (is_blank(line[position])) {
            position++;
            continue;
        }
        size_t end = position;
        bool quote = false;
        for (; end < line.size() && (quote || !is_blank(line[end])); end++) quote ^= line[end] == '"';
        if (quote) fail_at_line(number, "unterminated quote; add the closing \"");
        std::string_view word = line.substr(position, end - position);
        size_t length = name_length(word);
        tokens.push_back({word.substr(0, length), word.substr(length), position + length});
        position = end;
    }
    return tokens;
}

std::string_view find_pto_text(const std::vector<PtoToken> &tokens, std::string_view name) {
    for (const PtoToken &token : tokens)
        if (token.name == name && token.value.size() >= 2 && token.value.front() == '"')
            return token.value.substr(1, token.value.find('"', 1) - 1);
    return {};
}

const PtoToken *find_pto_token(const std::vector<PtoToken> &tokens, std::string_view name) {
    auto found = std::find_if(tokens.begin(), tokens.end(), [&](const PtoToken &t) { return t.name == name; });
    return found == tokens.end() ? nullptr : &*found;
}

}  // namespace lensprof
