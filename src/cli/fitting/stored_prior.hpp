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
};

// The profile that is stored for the key, or what is composed of those of its lens and camera, unless it has no
// covariance or is of a fit that was not usable. No pictures count twice: where it was made from `source`, the one that
// is in it (provenance.prior_id) is the prior again; Failure (usage) where `source` is deeper in it.
EarlierProfile find_stored_prior(const StoreOptions &o, const lensprof_profile_key &key, const std::string &source);

}  // namespace lensprof
