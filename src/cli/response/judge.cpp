// Judges whether the result is the response of a camera.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/program/format.hpp"
#include "cli/response/findings.hpp"

namespace lensprof {
namespace {

constexpr double max_scatter = 6.0;  // levels
constexpr double max_gamma_sigma = 0.1;

void refuse(ResponseReport &report, uint32_t code, const std::string &text, std::vector<double> values) {
    report.usable = false;
    report.verdict.add_first({code, LENSPROF_SEVERITY_REFUSAL, text, std::move(values)});
}

double worst_noise(const ResponseReport &report) {
    double worst = 0.0;
    for (const FileFindings &file : report.files) worst = std::max(worst, file.noise_levels);
    return worst;
}

}  // namespace

const FileFindings &most_patterned(const ResponseReport &report) {
    return *std::max_element(report.files.begin(), report.files.end(),
                             [](const auto &a, const auto &b) { return a.pattern_levels < b.pattern_levels; });
}

void judge(ResponseReport &report) {
    const FileFindings &pattern = most_patterned(report);
    const double noise = worst_noise(report);
    const std::string named = report.files.size() > 1 ? pattern.file + ": " : "";
    report.usable = true;
    if (report.tenths < 4)
        return refuse(
            report, LENSPROF_REASON_FEW_GREYS,
            format("only %u of ten parts of the grey value range are covered; take a picture with smooth areas of all "
                   "brightnesses",
                   report.tenths),
            {double(report.tenths)});
    if (noise > max_scatter)
        return refuse(report, LENSPROF_REASON_SCATTER,
                      format("the rendered picture deviates by %.1f levels from any curve of the raw values; it may "
                             "be another shot, or developed differently",
                             noise),
                      {noise});
    if (pattern.pattern_levels > strong_pattern)
        return refuse(
            report, LENSPROF_REASON_PATTERNS,
            named
                + format(
                    "tones were mapped locally (a map of %.1f levels over the frame remains); switch off D-Lighting, "
                    "Auto Lighting Optimizer, DRO, HDR and similar functions",
                    pattern.pattern_levels),
            {pattern.pattern_ev, pattern.pattern_levels});
    if (report.log_gamma_sigma > max_gamma_sigma)
        return refuse(report, LENSPROF_REASON_UNDETERMINED,
                      format("the exponent is known only to %.0f %%; take a picture with all brightnesses",
                             100.0 * report.log_gamma_sigma),
                      {});
    const auto add = [&](uint32_t severity, uint32_t code, const std::string &text, std::vector<double> values) {
        report.verdict.add_last({code, severity, text, std::move(values)});
    };
    if (pattern.pattern_levels > weak_pattern)
        add(LENSPROF_SEVERITY_WARNING, LENSPROF_REASON_PATTERNS,
            named
                + format("a map of %.1f levels over the frame remains; the camera may have mapped tones locally",
                         pattern.pattern_levels),
            {pattern.pattern_ev, pattern.pattern_levels});
    if (report.lowest > 48.0 || report.highest < 208.0)
        add(LENSPROF_SEVERITY_NOTE, LENSPROF_REASON_MISSING_GREYS,
            format("only grey levels %.0f to %.0f are measured; beyond them the response is that of a typical "
                   "camera, continued",
                   report.lowest, report.highest),
            {report.lowest / 255.0, report.highest / 255.0});
}

}  // namespace lensprof
