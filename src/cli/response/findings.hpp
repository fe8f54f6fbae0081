// What the fit says of the camera: its response, how sure that is, and whether the rendering is one curve at all.
#pragma once

#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/report/report.hpp"
#include "cli/response/curve_fit.hpp"
#include "cli/response/places.hpp"

namespace lensprof {

// Of a map of residuals over the frame, levels of 255: above it tones were mapped by their surroundings, or may have
// been.
constexpr double strong_pattern = 1.2, weak_pattern = 0.5;

// Of one raw file.
struct FileFindings {
    std::string file, rendered;  // rendered: the JPEG beside it; empty = embedded
    PlacesOf from;               // without places
    uint32_t places = 0;
    double radius = 0.0;                      // largest r of a place, half diagonals of the frame
    double corner = 1.0, corner_sigma = 0.0;  // light of the rendering over that of the sensor at that r; centre 1
    double pattern_levels = 0.0, pattern_ev = 0.0;  // of a map over the frame that is not radial, RMS
    double noise_levels = 0.0;                      // of a place, neutral colours
    double white_ev = 0.0;  // by how much the sensor's saturation of a neutral is above the rendering's white
    double gamma = 0.0, gamma_sigma = 0.0;  // of this file alone
    Rendering rendering;

    // Whether the camera brightened the corners.
    bool is_corrected() const;
};

struct ResponseReport {
    std::vector<FileFindings> files;
    lensprof_response response{};
    double gamma = 0.0;  // of the curve x^(1/gamma) with its ratio of light at 208 and 48
    double log_gamma_sigma = LENSPROF_UNKNOWN;
    double lowest = 0.0, highest = 0.0;  // grey levels of 255 that places show, 1 in 100 beyond each
    uint32_t tenths = 0;                 // of the grey values that are shown
    bool shows_white = false;            // the rendering reaches white before the sensor saturates
    bool is_corrected = false;           // of most files
    bool usable = false;
    Verdict verdict;
    double load_s = 0.0, solve_s = 0.0;
    int64_t profile_id = 0;
};

// Fits all files together, and each alone where there are several. Failure (not_usable) where there are too few places.
void fit_files(const std::vector<std::vector<Place>> &places, const lensprof_response &prior, ResponseReport &report);

// The file with the strongest map.
const FileFindings &most_patterned(const ResponseReport &report);

// Whether it is a response to store, and what is to be minded: sets `usable` and `verdict`.
void judge(ResponseReport &report);

Json response_report_json(const ResponseReport &report);
void print_response_report(const ResponseReport &report, std::ostream &out);

}  // namespace lensprof
