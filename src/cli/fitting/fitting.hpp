// The common parts of all commands that fit: options, the call of the library, the report.
#pragma once

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/fitting/store_options.hpp"
#include "cli/program/options.hpp"
#include "cli/program/progress.hpp"
#include "cli/program/run.hpp"
#include "cli/report/report.hpp"
#include "photo/base/output_file.hpp"
#include "photo/calibration/fit.hpp"
#include "photo/calibration/stored_prior.hpp"

namespace lensprof {

// Options that only some commands offer.
struct FitChoices {
    bool known_response = true;  // a project has a response that may be fixed
    bool stored_prior = false;   // a stored profile can be the prior
};

// Declares --fit, whose further keys are declared with what this returns.
Keys declare_fit(Command &command, FitOptions &o, FitChoices choices = {});

void declare_sampling(Keys &keys, SamplingOptions &o, const std::string &default_pairs);
void declare_max_side(Keys &keys, uint32_t &max_side);

// Failure (usage) for conflicting options.
void check_fit_options(const FitOptions &o);

// Where a result goes.
struct Finish {
    std::string method;  // for the provenance
    std::string source;  // the inputs
    bool json = false;
    bool equalizes_pictures = false;        // a result that corrects the pictures counts as success if nothing is to be
                                            // stored
    std::string report;                     // .html file that is written of the result; empty: none,
    Json *page = nullptr;                   // and what fit_page_data made for it
    OutputFiles *outputs = nullptr;         // committed after the profile is stored; or NULL
    const EarlierProfile *prior = nullptr;  // the prior of the fit; or NULL
};

// Stores a usable or forced result, prints it, and reports problems on standard error. Returns the exit code.
int finish_fit(BuildReport &report, const lensprof_profile_key &key, const StoreOptions &store, const Finish &finish,
               Streams &streams);

// Failure (usage) for a max-side that gives too few samples.
void check_max_side(uint32_t max_side);

}  // namespace lensprof
