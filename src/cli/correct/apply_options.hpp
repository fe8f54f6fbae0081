// The options of `lensprof apply`.
#pragma once

#include <string>
#include <vector>

#include "cli/program/options.hpp"
#include "photo/correct/correction.hpp"
#include "photo/correct/picture_model.hpp"

namespace lensprof {

// Exposure of the outputs.
enum class OutputExposure {
    by_default,  // mean with a project, else keep
    mean,
    reference,
    keep
};

// Output for camera raw files.
enum class RawOutput {
    by_default,  // DNG for a DNG, else TIFF
    dng,
    tif
};

struct ApplyOptions {
    ModelOptions model;
    RawOutput raw_output = RawOutput::by_default;
    std::string linear_end;  // of --encoding linear; empty: not given
    std::string pto, exposures, images, shard, output, sheet;
    OutputExposure exposure = OutputExposure::by_default;
    CorrectionKind kind;
    bool seed_exif = false, merge = false, skip = false, json = false, progress = false, has_output = true;
    std::vector<std::string> files;

    // The file with the exposures, and its option.
    const std::string &project() const { return pto.empty() ? exposures : pto; }
    const char *project_option() const { return pto.empty() ? "--model" : "--pto"; }
};

void declare_options(Command &command, ApplyOptions &o);

// Failure (usage) for options that exclude or need each other.
void check_project_options(const ApplyOptions &o);
void check_merge(const ApplyOptions &o);

}  // namespace lensprof
