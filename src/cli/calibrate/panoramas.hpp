// The panoramas of a folder: found, fitted and stored, each once, whatever the number of runs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/calibrate/inputs.hpp"
#include "cli/calibrate/ledger.hpp"
#include "cli/calibrate/noted_matches.hpp"
#include "cli/fitting/profile_store.hpp"
#include "cli/program/progress.hpp"

namespace lensprof {

struct CalibrateOptions {
    std::vector<std::string> inputs;
    std::string output;
    StoreOptions store;  // databases and no_store alone
    bool one_lens = false, overwrite = false, json = false, progress = false;
    uint32_t threads = 0;
};

constexpr const char *stood_still = "stood still";  // what a summary's `camera` may be: no panorama, and not fitted

struct Panorama {
    std::string name;              // "img000", of its first picture when it was found
    std::string project, preview;  // files in the output folder
    std::vector<const InputPicture *> pictures;
    std::string geometry;  // as a project without a result
    NotedMatches matches;  // where pictures show the same that the cameras do not fit
    std::string source;    // as provenances name it
    std::string key;       // of its pictures and of what is asked for
    Json summary;          // docs/json.md; `result` is null where no fit could be made
    bool evens() const;
};

struct Panoramas {
    std::vector<Panorama> list;                   // the one with most pictures first
    std::map<std::string, std::string> unjoined;  // files of pictures in none, and why
    bool is_registered = false;                   // by this run
    uint32_t fitted = 0;                          // by this run
};

// By the ledger, where the pictures are the same, else by registration. Panoramas of an earlier run keep their names.
Panoramas find_panoramas(const CalibrateOptions &o, const Inputs &inputs, Ledger &ledger, Progress &progress);

// Fits and stores those that the ledger does not have, writes their projects, and their mosaics before and after.
void fit_panoramas(const CalibrateOptions &o, Panoramas &panoramas, Ledger &ledger, Progress &progress);

// Removes projects and mosaics of panoramas that are no more.
void forget_panoramas(const CalibrateOptions &o, const Panoramas &panoramas, Ledger &ledger);

}  // namespace lensprof
