// Result of the fit: the camera's response, its errors, and whether the rendering uses a single curve.
#pragma once

#include <string>
#include <vector>

#include <lensprof/lensprof.h>

#include "cli/report/report.hpp"
#include "cli/response/curve_fit.hpp"
#include "cli/response/places.hpp"

namespace lensprof {

// Result for one raw file.
struct FileFindings {
    std::string file, rendered;  // rendered: the separate JPEG; empty = embedded
    PlacesOf from;               // without areas
    uint32_t places = 0;
    double radius = 0.0;                      // largest r of an area, half diagonals of the frame
    double corner = 1.0, corner_sigma = 0.0;  // irradiance of the rendering over that of the sensor at that r; centre 1
    double pattern_levels = 0.0, pattern_ev = 0.0;  // RMS of the non-radial map over the frame
    double noise_levels = 0.0;                      // of an area, neutral colours
    double white_ev = 0.0;  // EV between the white of the rendering and the sensor's saturation, for a neutral
    double gamma = 0.0, gamma_sigma = 0.0;  // from this file alone
    Rendering rendering;

    // Whether the camera brightened the corners.
    bool is_corrected() const;
};

struct ResponseReport {
    std::vector<FileFindings> files;
    lensprof_response response{};
    double gamma = 0.0;  // of the curve x^(1/gamma) with the same ratio of irradiance at 208 and 48
    double log_gamma_sigma = LENSPROF_UNKNOWN;
    double lowest = 0.0, highest = 0.0;  // range of measured grey levels of 255, without 1 in 100 at each end
    uint32_t tenths = 0;                 // share of the grey values that are measured
    bool shows_white = false;            // the rendering reaches white before the sensor saturates
    bool is_corrected = false;           // for most files
    bool usable = false;
    Verdict verdict;
    double load_s = 0.0, solve_s = 0.0;
    int64_t profile_id = 0;
};

// Fits all files together, and each alone if there are several. Failure (not_usable) for too few areas.
void fit_files(const std::vector<std::vector<Place>> &places, const lensprof_response &prior, ResponseReport &report);

// The file with the strongest map.
const FileFindings &most_patterned(const ResponseReport &report);

// Judges whether the response may be stored, and warnings: sets `usable` and `verdict`.
void judge(ResponseReport &report);

Json response_report_json(const ResponseReport &report);
void print_response_report(const ResponseReport &report, std::ostream &out);

}  // namespace lensprof
