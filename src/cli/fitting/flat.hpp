// The parts of `lensprof flat`: options, pictures, report.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/program/progress.hpp"
#include "cli/report/report.hpp"
#include "photo/base/library.hpp"
#include "photo/calibration/profile_store.hpp"
#include "photo/pictures/picture.hpp"

namespace lensprof {

struct FlatCommand {
    StoreOptions store;
    std::vector<std::string> files;
    std::vector<std::array<double, 4>> cards;  // x, y, width and height, px of the frame
    std::vector<uint32_t> shots;
    std::vector<double> ev, rotation_deg;
    uint32_t falloff_curves = 0, light = LENSPROF_FLAT_LIGHT_AUTO, grid = LENSPROF_FLAT_GRID_AUTO;
    bool free_center = true, linear = false, several = false, find_card = false, own_light = false, json = false,
         progress = false;
    int64_t profile = 0;
    std::optional<double> gamma;
    std::string report;  // .html file; empty: none
    double ev_sigma = 0.02, black = 2.0 / 255.0, white = 250.0 / 255.0;
    uint32_t max_side = 1600;
};

// All inputs of the library call, and the memory they refer to.
struct FlatInput {
    std::vector<std::string> names;  // picture names for reports
    std::vector<Picture> pictures;
    std::vector<std::vector<uint8_t>> masks;  // per picture; empty = the whole picture
    std::vector<lensprof_flat_image> images;
    std::vector<lensprof_response> response;  // one or three
    lensprof_profile_key key;                 // from EXIF of the first picture
    lensprof_flat_options options;
};

// Failure (usage) for conflicting options and counts that do not match the number of pictures.
void check_flat_options(const FlatCommand &o);

// Determines everything that needs no pixels: shots, exposures, rotations, response and key. Failure if something is
// missing.
FlatInput prepare_flat(const FlatCommand &o, Streams &streams);

// Reads the pictures and completes images and options.
void read_flat(const FlatCommand &o, Progress &progress, FlatInput &input);

// The report of `flat`.
struct FlatReport {
    std::vector<std::string> names;
    std::vector<uint32_t> shots;  // of the pictures
    std::vector<double> ev, rotated;
    std::vector<lensprof_flat_image_quality> quality;
    std::vector<lensprof_response> response;
    std::shared_ptr<const lensprof_flat> held;  // NULL without a fit
    lensprof_flat_result fit{};
    Verdict verdict;  // of it
    double load_s = 0, solve_s = 0;
    int64_t profile_id = 0;  // 0 = not stored
};

// The object that `flat --json` prints; docs/json.md describes the schema.
Json flat_json(const FlatReport &report);

void print_flat(const FlatReport &report, std::ostream &out);

// The bytes of the report as a web page.
std::string flat_page(const FlatReport &report, const std::string &title, const std::string &command,
                      const std::vector<std::string> &warnings);

}  // namespace lensprof
