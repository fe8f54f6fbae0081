// What becomes of a result: the profiles that are stored, and the notices about it.
#pragma once

#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/calibration/fit.hpp"
#include "photo/calibration/profile_store.hpp"
#include "photo/calibration/stored_prior.hpp"

namespace lensprof {

// Where profiles come from.
struct Storing {
    std::string method, source;             // for the provenance
    const EarlierProfile *prior = nullptr;  // the prior of the fit; or NULL
};

// The profile of a lens setting: its key, method and source; not yet the time.
std::unique_ptr<lensprof_profile> profile_of_setting(const BuildReport &report, const SettingReport &setting,
                                                     const Storing &how);

// Stores the profiles of every usable lens setting, or of all if forced.
void store_result(BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store, const Storing &how);

struct Outcome {
    bool is_good = false;  // a profile is usable, or, if nothing is to be stored, the pictures are corrected
    NoticeList notices;    // everything else that is wrong
    std::string refusal;   // if it is not good
};

// `equalizes_pictures`: a result that corrects the pictures counts if nothing is to be stored.
Outcome outcome_of(const BuildReport &report, const StoreOptions &store, const std::string &source,
                   bool equalizes_pictures);

// The message for a result that is not usable: the item, the reason, and that nothing was stored if it could have been.
std::string not_usable_text(const std::string &source, const Verdict &verdict, const StoreOptions &store);

}  // namespace lensprof
