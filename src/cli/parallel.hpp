/* parallel.hpp - the same work on many items, on all cores. */
#ifndef LENSPROF_CLI_PARALLEL_HPP
#define LENSPROF_CLI_PARALLEL_HPP

#include <cstdint>
#include <functional>
#include <string>

#include "progress.hpp"

namespace lensprof {

/* Calls work(i) for every i below count, several at once, and shows progress as `what`. After a failure or an interrupt
 * no new item is begun; the failure of the lowest item is thrown, so that the message does not depend on timing
 * alone. */
void for_each_parallel(uint32_t count, const std::string &what, Progress &progress,
                       const std::function<void(uint32_t)> &work);

}  // namespace lensprof

#endif
