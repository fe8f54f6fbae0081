// The report of a fit as a web page (cli/page): what `--report` writes.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/project_fit.hpp"

namespace lensprof {

struct FitPageInput {
    const ProjectFit &done;
    const Project &project;
    const std::vector<PictureMetadata> &metadata;  // of each image
    std::string command;                           // that made the report
    std::vector<std::string> warnings;             // about the fit
};

// The bytes of the page; pictures before and after are in it where the result corrects them. Deterministic.
std::string fit_page(const FitPageInput &input, Progress &progress);

}  // namespace lensprof
