// Options of the model that corrects, and of writing.
#pragma once

#include "cli/program/options.hpp"
#include "photo/correct/picture_model.hpp"

namespace lensprof {

// Declares --profile, --db and the options of the key.
void declare_model(Command &command, ModelOptions &o);
void declare_model_keys(Keys &keys, ModelOptions &o);  // of --set

// The options --threads and --overwrite.
void declare_writing(Command &command, CorrectionKind &kind);

}  // namespace lensprof
