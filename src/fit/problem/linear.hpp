// Whether samples are light.
#pragma once

#include <algorithm>

#include <lensprof/model.h>

namespace lensprof {

// Whether all responses are straight lines, as where none is given.
inline bool are_linear(const lensprof_response *responses, uint32_t count) {
    return !responses || std::all_of(responses, responses + count, [](const lensprof_response &response) {
        return response.kind == LENSPROF_RESPONSE_LINEAR;
    });
}

}  // namespace lensprof
