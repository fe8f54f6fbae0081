// Options of lookups, in addition to the key.
#pragma once

#include <lensprof/lensprof.h>

#include "cli/program/options.hpp"

namespace lensprof {

struct LookupOptions {
    uint32_t distance_rule = LENSPROF_DISTANCE_USUAL;
    double crop_factor = LENSPROF_UNKNOWN;
    bool doubtful = false;

    void add_keys(Keys keys);  // of --key
    lensprof_lookup_options options() const;
};

}  // namespace lensprof
