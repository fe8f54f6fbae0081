// The options of every command that stores a profile.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/program/options.hpp"
#include "photo/calibration/profile_store.hpp"

namespace lensprof {

Keys declare_store(Command &command, StoreOptions &o);

// The choices of --key processing.
Choices<std::optional<uint32_t>> processing_choices();

// Failure (usage) for conflicting options. `reads_db`: --db is allowed with --no-store; `writes_other_files`: --force
// is allowed with --no-store, because the command writes other files of the result.
void check_store_options(const StoreOptions &o, bool reads_db = false, bool writes_other_files = false);

// Failure (usage) for the file of --report if it is not an .html file, would overwrite an input or the database, or
// cannot be written; nothing for an empty name.
void check_report(const std::string &report, const std::vector<std::string> &inputs, const StoreOptions &o);

}  // namespace lensprof
