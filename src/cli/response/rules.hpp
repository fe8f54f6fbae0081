// The verdict on the response of a rendering: all rules with their limits, the most important first within a severity.
#pragma once

#include "cli/program/format.hpp"
#include "cli/response/findings.hpp"

namespace lensprof {

struct ResponseRule {
    lensprof_reason code;
    lensprof_severity severity;
    double (*measure)(const ResponseReport &report);
    bool is_above;  // found if the measure is above the limit; else below
    double limit;
    std::vector<double> (*values)(const ResponseReport &report);  // docs/reasons.md has their units
    std::string (*text)(const ResponseReport &report);
};

// Limits. Tenths of the grey values, as for pairs.
constexpr double kFewestTenths = 4.0;
// Noise of an area, levels of 255, as for pairs: above the noise of any camera.
constexpr double kMostNoise = 6.0;
// Map of residuals over the frame, levels of 255. Rounding leaves up to half a level.
constexpr double kStrongMap = 1.2, kWeakMap = 0.5;
// Standard error of ln gamma: 10 % of the exponent.
constexpr double kLargestGammaSigma = 0.1;
// Grey levels of 255 that are missing at the dark or the bright end.
constexpr double kMissingLevels = 48.0;

namespace response_measure {

double tenths(const ResponseReport &report);
double noise(const ResponseReport &report);
double map(const ResponseReport &report);
double gamma_sigma(const ResponseReport &report);
double missing_levels(const ResponseReport &report);

std::vector<double> of_map(const ResponseReport &report);
std::vector<double> range(const ResponseReport &report);
inline std::vector<double> none(const ResponseReport &) { return {}; }

// "FILE: " if there are several.
std::string patterned_file(const ResponseReport &report);

}  // namespace response_measure

// clang-format off
constexpr ResponseRule kResponseRules[] = {
    {LENSPROF_REASON_FEW_GREYS, LENSPROF_SEVERITY_REFUSAL, response_measure::tenths, false, kFewestTenths,
     [](const ResponseReport &r) { return std::vector<double>{response_measure::tenths(r)}; },
     [](const ResponseReport &r) { return format("only %u of ten parts of the grey value range are covered; take a picture with smooth areas of all brightnesses", r.tenths); }},
    {LENSPROF_REASON_SCATTER, LENSPROF_SEVERITY_REFUSAL, response_measure::noise, true, kMostNoise,
     [](const ResponseReport &r) { return std::vector<double>{response_measure::noise(r)}; },
     [](const ResponseReport &r) { return format("the rendered picture deviates by %.1f levels from any curve of the raw values; it may be another shot, or developed differently", response_measure::noise(r)); }},
    {LENSPROF_REASON_PATTERNS, LENSPROF_SEVERITY_REFUSAL, response_measure::map, true, kStrongMap, response_measure::of_map,
     [](const ResponseReport &r) { return response_measure::patterned_file(r) + format("tones were mapped locally (a map of %.1f levels over the frame remains); switch off D-Lighting, Auto Lighting Optimizer, DRO, HDR and similar functions", response_measure::map(r)); }},
    {LENSPROF_REASON_UNDETERMINED, LENSPROF_SEVERITY_REFUSAL, response_measure::gamma_sigma, true, kLargestGammaSigma, response_measure::none,
     [](const ResponseReport &r) { return format("the exponent is known only to %.0f %%; take a picture with all brightnesses", 100.0 * r.log_gamma_sigma); }},
    {LENSPROF_REASON_PATTERNS, LENSPROF_SEVERITY_WARNING, response_measure::map, true, kWeakMap, response_measure::of_map,
     [](const ResponseReport &r) { return response_measure::patterned_file(r) + format("a map of %.1f levels over the frame remains; the camera may have mapped tones locally", response_measure::map(r)); }},
    {LENSPROF_REASON_MISSING_GREYS, LENSPROF_SEVERITY_NOTE, response_measure::missing_levels, true, kMissingLevels, response_measure::range,
     [](const ResponseReport &r) { return format("only grey levels %.0f to %.0f are measured; beyond them the response is that of a typical camera, continued", r.lowest, r.highest); }},
};
// clang-format on

}  // namespace lensprof
