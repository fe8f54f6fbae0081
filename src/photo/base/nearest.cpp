#include "photo/base/nearest.hpp"

#include <algorithm>

namespace lensprof {
namespace {

size_t distance(const std::string &a, const std::string &b) {
    std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
    for (size_t i = 0; i <= a.size(); i++)
        for (size_t j = 0; j <= b.size(); j++) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

std::string to_lower(std::string word) {
    for (char &c : word)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return word;
}

// The shortest of `words` that starts with `start`, which has at least two letters after its dashes; else empty.
std::string shortest_completion(const std::string &start, const std::vector<std::string> &words) {
    const size_t dashes = std::min(start.find_first_not_of('-'), start.size());
    std::string shortest;
    for (const std::string &word : words) {
        const bool begins = start.size() >= dashes + 2 && to_lower(word).rfind(start, 0) == 0;
        if (begins && (shortest.empty() || word.size() < shortest.size())) shortest = word;
    }
    return shortest;
}

}  // namespace

std::string nearest_of(const std::string &word, const std::vector<std::string> &words) {
    constexpr size_t max_length = 100;
    if (word.size() > max_length) return {};
    const std::string lower_word = to_lower(word), completion = shortest_completion(lower_word, words);
    if (!completion.empty()) return completion;
    std::string nearest;
    size_t min_changes = std::max<size_t>(1, word.size() / 3) + 1;
    for (const std::string &other : words) {
        const size_t changes = distance(lower_word, to_lower(other));
        if (changes < min_changes) min_changes = changes, nearest = other;
    }
    return nearest;
}

size_t letters_changed(const std::string &a, const std::string &b) { return distance(to_lower(a), to_lower(b)); }

std::string did_you_mean(const std::string &word, const std::vector<std::string> &words) {
    const std::string nearest = nearest_of(word, words);
    return nearest.empty() ? nearest : "; did you mean " + nearest + "?";
}

}  // namespace lensprof
