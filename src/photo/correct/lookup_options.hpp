// How lookups answer, in addition to the key.
#pragma once

#include <lensprof/store.h>

namespace lensprof {

struct LookupOptions {
    uint32_t distance_rule = LENSPROF_DISTANCE_USUAL;
    double crop_factor = LENSPROF_UNKNOWN;
    bool doubtful = false;

    lensprof_lookup_options options() const {
        lensprof_lookup_options options;
        lensprof_lookup_options_init(&options);
        options.distance_rule = distance_rule;
        options.with_doubt = doubtful;
        return options;
    }
};

}  // namespace lensprof
