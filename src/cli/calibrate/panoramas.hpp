// The panoramas of a folder: found, fitted and stored once, regardless of the number of runs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/calibrate/inputs.hpp"
#include "cli/calibrate/ledger.hpp"
#include "cli/calibrate/noted_matches.hpp"
#include "cli/program/progress.hpp"
#include "photo/calibration/profile_store.hpp"

namespace lensprof {

struct CalibrateOptions {
    std::vector<std::string> inputs;
    std::string output, report;
    StoreOptions store;  // only databases and no_store are used
    bool one_lens = false, overwrite = false, json = false, progress = false;
    uint32_t threads = 0;
};

constexpr const char *camera_stationary = "stood still";  // value of `camera` in a summary: not a panorama, not fitted

struct Panorama {
    std::string name;              // such as "img000", after its first picture when it was found
    std::string project, preview;  // files in the output folder
    std::vector<const InputPicture *> pictures;
    std::string geometry;  // the project before the fit
    NotedMatches matches;  // matches that the cameras do not explain
    std::string source;    // the source stored in the provenance
    std::string key;       // hash of its pictures and the options
    Json summary;          // docs/json.md; `result` is null if the fit failed
    Json page;             // its part of a report, without pictures (fit_page_data); null if the fit failed
    bool equalizes() const;
};

struct Panoramas {
    std::vector<Panorama> list;                   // largest first
    std::map<std::string, std::string> unjoined;  // reason by file, for pictures in no panorama
    std::map<std::string, std::string> copies;    // and for copies of other pictures, which are not corrected
    bool is_registered = false;                   // by this run
    uint32_t fitted = 0;                          // by this run
};

// Takes panoramas from the ledger if the pictures are unchanged, else from registration. Panoramas of an earlier run
// keep their names.
Panoramas find_panoramas(const CalibrateOptions &o, const Inputs &inputs, Ledger &ledger, Progress &progress);

// Fits and stores the panoramas missing from the ledger, writes their projects and their mosaics before and after.
// Removes projects and mosaics of panoramas that no longer exist.
void fit_panoramas(const CalibrateOptions &o, Panoramas &panoramas, Ledger &ledger, Progress &progress);

// Removes projects and mosaics of panoramas that are no more.
void remove_obsolete_panoramas(const CalibrateOptions &o, const Panoramas &panoramas, Ledger &ledger);

}  // namespace lensprof
