// The stored profile that a fit may use as its prior.
#pragma once

#include <memory>
#include <string>

#include "photo/calibration/profile_store.hpp"

namespace lensprof {

struct EarlierProfile {
    int64_t id = 0;                             // 0: none
    std::unique_ptr<lensprof_profile> profile;  // or NULL
    std::string reason;                         // why there is no prior
    bool is_composed = false;                   // composed of profiles at other settings; `id` is the nearest
    bool is_own = true;                         // `id` belongs to the database that the result is stored in
};

// The profile stored for the key, or one composed of the profiles of its lens and camera (lensprof_store_lookup_in of
// the databases of `o`), unless it comes from a fit that was not usable. If `id` is not 0, the profile with this id in
// the first database; Failure if that cannot be used. No pictures count twice: if the profile was made from `source`,
// its own prior (provenance.prior_id) is used again. If no profile is stored, the reason is empty unless
// `is_requested`. Failure (usage) if `source` is deeper in its history and `is_requested`: the prior would add no
// information.
EarlierProfile find_stored_prior(const StoreOptions &o, int64_t id, bool is_requested, const lensprof_profile_key &key,
                                 const std::string &source);

}  // namespace lensprof
