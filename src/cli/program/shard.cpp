#include "cli/program/shard.hpp"

#include <stdexcept>

#include "cli/program/numbers.hpp"
#include "photo/base/failure.hpp"

namespace lensprof {

Shard shard_of(const std::string &word) {
    constexpr uint32_t max_shards = 1u << 20;
    if (word.empty()) return {};
    const size_t slash = word.find('/');
    try {
        if (slash == std::string::npos) throw std::invalid_argument("no slash");
        const uint32_t count = count_of(word.substr(slash + 1), 1, max_shards);
        return {count_of(word.substr(0, slash), 1, count), count};
    } catch (const std::invalid_argument &) {
        throw Failure(LENSPROF_ERROR_ARGUMENT, "--shard " + word + ": not a valid part; give INDEX/COUNT with 1 <= INDEX <= "
                                                           "COUNT, such as 2/5");
    }
}

}  // namespace lensprof
