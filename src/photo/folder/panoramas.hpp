// The panoramas of a folder: found, fitted and stored once, regardless of the number of runs.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "photo/base/events.hpp"
#include "photo/calibration/calibration.hpp"
#include "photo/calibration/profile_store.hpp"
#include "photo/folder/inputs.hpp"
#include "photo/folder/ledger.hpp"
#include "photo/folder/noted_scene.hpp"

namespace lensprof {

struct FolderOptions {
    std::vector<std::string> inputs;
    std::string output;
    StoreOptions store;  // only databases and no_store are used
    bool one_lens = false, overwrite = false;
    uint32_t threads = 0;

    // What a report needs of a calibration and its warnings; it is kept for later runs. Empty: nothing.
    std::function<Json(Calibration &, const std::vector<std::string> &warnings, Events &)> describe;
};

constexpr const char *camera_stationary = "stood still";  // value of `camera` in a summary: not a panorama, not fitted

struct Panorama {
    std::string name;              // such as "img000", after its first picture when it was found
    std::string project, preview;  // files in the output folder
    std::vector<const InputPicture *> pictures;
    FoundScene found;       // cameras and matches
    std::string source;     // the source stored in the provenance
    std::string key;        // hash of its pictures and the options
    Json summary;           // docs/json.md; `result` is null if the fit failed
    Json page;              // what FolderOptions.describe made of it; null if the fit failed
    std::string written;    // digest of the project file as written
    std::string exposures;  // text of exposures.json, with which it is corrected; empty: none
    bool equalizes() const;

    // Whether somebody has edited the project file since the fit.
    bool is_edited() const;

    // The scene with its result; that of its project file if that was edited. Failure.
    Scene corrected_scene() const;
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
Panoramas find_panoramas(const FolderOptions &o, const Inputs &inputs, Ledger &ledger, Events &events);

// Fits and stores the panoramas missing from the ledger, and writes their projects.
void fit_panoramas(const FolderOptions &o, Panoramas &panoramas, Ledger &ledger, Events &events);

// Removes projects and mosaics of panoramas that are no more.
void remove_obsolete_panoramas(const FolderOptions &o, const Panoramas &panoramas, Ledger &ledger);

}  // namespace lensprof
