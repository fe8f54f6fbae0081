// Options that select profiles by camera, lens and setting.
#pragma once

#include "cli/program/options.hpp"
#include "photo/calibration/key_filter.hpp"
#include "photo/correct/lookup_options.hpp"

namespace lensprof {

// Declares --camera and others, and --key, whose further keys are declared with what this returns.
Keys declare_key_filter(Command &command, KeyFilter &filter);
void declare_lookup(Keys keys, LookupOptions &o);  // of --key

// Failure (usage) for names too long to be stored.
void check_names(const KeyFilter &filter);

}  // namespace lensprof
