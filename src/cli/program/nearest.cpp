#include "cli/program/nearest.hpp"

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

}  // namespace

std::string nearest_of(const std::string &word, const std::vector<std::string> &words) {
    constexpr size_t longest = 100;
    std::string nearest;
    size_t fewest = std::max<size_t>(1, word.size() / 3) + 1;
    for (const std::string &other : words) {
        const size_t changes = word.size() <= longest ? distance(word, other) : fewest;
        if (changes < fewest) fewest = changes, nearest = other;
    }
    return nearest;
}

std::string did_you_mean(const std::string &word, const std::vector<std::string> &words) {
    const std::string nearest = nearest_of(word, words);
    return nearest.empty() ? nearest : "; did you mean " + nearest + "?";
}

}  // namespace lensprof
