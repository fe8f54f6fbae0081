// The report of a fit as a web page (cli/page): what `--report` writes.
#pragma once

#include <string>
#include <vector>

#include "cli/fitting/project_fit.hpp"

namespace lensprof {

struct FitPageInput {
    const BuildReport &report;
    const FitInput &input;  // its pairs are between the images of `best`
    const Fitted &best;
    const std::vector<lensprof_fit_image> &images;  // of the report: with known exposures
    const Project &project;
    const std::vector<PictureMetadata> &metadata;  // of each image of the project
    std::string command;                           // that made the report
    std::vector<std::string> warnings;             // about the fit
    const char *subtitle = "Calibration from overlapping pictures";
    bool shows_pictures = true;
};

// The bytes of the page; pictures before and after are in it where the result corrects them. Deterministic.
std::string fit_page(const FitPageInput &input, Progress &progress);

}  // namespace lensprof
