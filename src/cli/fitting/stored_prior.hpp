// The profile of the same lens and setting that a fit may start from, and whether it may.
#pragma once

#include <memory>
#include <string>

#include "cli/fitting/profile_store.hpp"

namespace lensprof {

struct EarlierProfile {
    int64_t id = 0;                             // 0: there is none
    std::unique_ptr<lensprof_profile> profile;  // or NULL
    std::string reason;                         // why there is none
    bool is_composed = false;                   // of profiles at other settings, of which `id` is the nearest
    bool is_own = true;                         // `id` is of the database that the result is stored in
};

// The profile that is stored for the key, or what is composed of those of its lens and camera (lensprof_store_lookup_in
// of the databases of `o`), unless it is of a fit that was not usable. Of the profile `id`, where that is not 0, in the
// first database; Failure where that is of no use. No pictures count twice: where the profile was made from `source`,
// the one that is in it (provenance.prior_id) is the prior again.
// Where nothing is stored at all the reason is empty unless `is_asked`. Failure (usage) where `source` is deeper in it,
// and `is_asked`: what was asked for would gain nothing.
EarlierProfile find_stored_prior(const StoreOptions &o, int64_t id, bool is_asked, const lensprof_profile_key &key,
                                 const std::string &source);

}  // namespace lensprof
