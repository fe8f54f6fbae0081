// The report of a fit as a web page (cli/page): what `--report` writes.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "photo/calibration/scene_fit.hpp"

namespace lensprof {

struct FitPageInput {
    const BuildReport &report;
    const FitInput &input;  // its pairs are between the images of `best`
    const Fitted &best;
    const std::vector<lensprof_fit_image> &images;  // of the report: with known exposures
    const Scene &scene;
    const std::vector<PictureMetadata> &metadata;  // of each image of the project
    std::string command;                           // that made the report
    const char *subtitle = "Calibration from overlapping pictures";
    bool shows_pictures = true;
};

// The page of a fit with its curves alone: falloff, response, and those of typical cameras.
nlohmann::ordered_json curves_page(const BuildReport &report, const std::string &path, const std::string &subtitle,
                                   const std::string &command);

// Everything in the page but the verdict and what depends on the stored profile; pictures before and after are in it if
// the result corrects them. Deterministic.
nlohmann::ordered_json fit_page_data(const FitPageInput &input, Events &events);

// Adds the verdict and the facts, once the profile is stored and all warnings are known.
void add_fit_verdict(nlohmann::ordered_json &data, const BuildReport &report, const std::vector<std::string> &warnings);

// The bytes of the page: `data` with its verdict and the result as JSON.
std::string fit_page(nlohmann::ordered_json data, const BuildReport &report, const std::vector<std::string> &warnings);

}  // namespace lensprof
