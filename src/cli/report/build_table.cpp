// The table of `build`.
#include <algorithm>
#include <cmath>

#include "cli/report/findings.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

const char *describe_kind_from(KindFrom from) {
    return from == KindFrom::option     ? "as requested"
           : from == KindFrom::pictures ? "according to the pictures"
           : from == KindFrom::none ? "because no picture is a camera's own JPEG; use --fit camera-kind to change it"
                                    : "typical of reconstructions; use --fit camera-kind to change it";
}

void print_exposures(const BuildReport &report, std::ostream &out) {
    size_t width = 5;
    for (const auto &name : report.names) width = std::max(width, name.size());
    out << format("%-*s  %8s  %6s  %7s  %7s\n", static_cast<int>(width), "image", "EV", "+-", "red", "blue");
    for (size_t i = 0; i < report.names.size(); i++) {
        const auto &e = report.exposures[i];
        double sigma = i < report.quality.size() ? report.quality[i].ev_sigma : 0.0;
        std::string error = sigma > 0.0 ? format("%.3f", sigma) : std::string("-");
        if (std::isnan(e.ev)) {
            out << format("%-*s  %8s\n", static_cast<int>(width), report.names[i].c_str(),
                          is_left_out(report, i) ? "left out" : "unknown");
            continue;
        }
        out << format("%-*s  %+8.3f  %6s  %7.4f  %7.4f%s\n", static_cast<int>(width), report.names[i].c_str(), e.ev,
                      error.c_str(), e.white_balance[0], e.white_balance[2],
                      i == report.reference ? "  reference" : "");
    }
}

// Pictures used of those given, if these are a minority.
void print_minority(const BuildReport &report, std::ostream &out) {
    const size_t fitted = report.names.size(), all = fitted + report.left_out.size();
    size_t used = 0;
    for (size_t i = 0; i < fitted; i++) used += !is_left_out(report, i);
    if (2 * used < all) out << format("pictures  %zu of %zu used\n", used, all);
}

void print_gamma(const BuildReport &report, std::ostream &out) {
    const auto &fit = report.fit;
    if (fit.gamma_from == LENSPROF_GAMMA_KNOWN) {
        out << "gamma     known from the fixed parameters";
        if (report.camera_kind.kind == LENSPROF_CAMERA_LINEAR && fit.response.kind == LENSPROF_RESPONSE_LINEAR)
            out << ": a linear response, " << describe_kind_from(report.camera_kind.from);
        out << "\n";
        return;
    }
    const bool is_given = report.exposures_given && fit.gamma_from == LENSPROF_GAMMA_EXPOSURES;
    out << "gamma     from " << (is_given ? "the given exposures" : gamma_name(fit.gamma_from));
    if (fit.gamma_from == LENSPROF_GAMMA_PRIOR)
        out << " (of the kind " << camera_kind_name(report.camera_kind.kind) << ", "
            << describe_kind_from(report.camera_kind.from) << ")";
    if (fit.gamma_sigma > 0.0) out << format(", +- %.0f %%", 100.0 * fit.gamma_sigma);
    if (fit.gamma_from == LENSPROF_GAMMA_NONE) out << " (no prior; the +- here exclude its error)";
    out << ": the common exponent of " << (report.has_falloff ? "exposure, falloff" : "exposure")
        << " and response, which pictures alone do not determine (docs/model.md)\n";
}

void print_prior(const BuildReport &report, std::ostream &out) {
    if (!report.no_prior.empty()) out << "prior     of all cameras: " << report.no_prior << "\n";
    if (!report.prior_id) return;
    const uint32_t verdict = report.fit.profile_prior;
    out << "prior     " << (report.prior_is_composed ? "composed of profile " : "profile ") << report.prior_id
        << (report.prior_is_composed ? " and others of the lens and the camera" : "")
        << (verdict == LENSPROF_PROFILE_PRIOR_USED ? ", used by the result\n"
            : verdict == LENSPROF_PROFILE_PRIOR_RESPONSE_OVERRULED
                ? ", whose falloff is used; its response is overruled by the pictures\n"
            : verdict == LENSPROF_PROFILE_PRIOR_FALLOFF_OVERRULED
                ? ", whose response is used; its falloff is overruled by the pictures\n"
                : ", overruled by the pictures\n");
}

// What lenses have in common against the pictures, and what the result was left with.
void print_lens_prior(const lensprof_fit_result &fit, std::ostream &out) {
    if (fit.model == LENSPROF_FIT_MODEL_EXPOSURES)
        out << "model     exposures and white balances alone: no falloff is corrected\n";
    else if (fit.model == LENSPROF_FIT_MODEL_LENS)
        out << "model     exposures and white balances, and the stored falloff as it is\n";
    else if (fit.model == LENSPROF_FIT_MODEL_NOTHING)
        out << "model     nothing: the values above are not better than the pictures as they are\n";
    if (fit.equal_exposures) out << "exposure  taken as equal: none was known, and the pictures show no difference\n";
    if (fit.falloff_prior_distance > 0.0 || fit.center_prior_distance > 0.0)
        out << format(
            "lens      the pictures alone are %.1f (falloff) and %.1f (centre) standard errors from what lenses have "
            "in common; errors that neighbouring pairs share: %.1f times the variance of independent ones\n",
            fit.falloff_prior_distance, fit.center_prior_distance, fit.error_inflation);
}

// "links     12 verified, 2 not (too little texture to check the alignment), 1 contradicted".
std::string links_row(const std::vector<lensprof_link> &links) {
    size_t count[LENSPROF_LINK_CONTRADICTED + 1] = {};
    for (const lensprof_link &link : links) count[std::min<uint32_t>(link.state, LENSPROF_LINK_CONTRADICTED)]++;
    std::string row = format("links     %zu verified", count[LENSPROF_LINK_VERIFIED]);
    if (count[LENSPROF_LINK_UNVERIFIED])
        row += format(", %zu not (too little texture to check the alignment)", count[LENSPROF_LINK_UNVERIFIED]);
    if (count[LENSPROF_LINK_CONTRADICTED]) row += format(", %zu contradicted", count[LENSPROF_LINK_CONTRADICTED]);
    return row + "\n";
}

// For one lens setting, or for each.
void print_falloffs(const BuildReport &report, std::ostream &out) {
    if (report.settings.empty()) print_vignettings(*profile_of(*report.held), out);
    for (const SettingReport &setting : report.settings) {
        if (!setting.found.images) continue;
        out << "setting   " << setting.label << format(", %s", counted(setting.found.images, "picture").c_str())
            << (setting.found.usable ? "" : "; not stored as a profile") << "\n";
        print_vignettings(*profile_of(*report.held, setting.number), out);
    }
}

// For one camera, or for each, with its connection to that of the reference.
void print_responses(const BuildReport &report, std::ostream &out) {
    if (report.cameras.empty()) {
        if (report.fit.response_from == LENSPROF_FIT_RESPONSE_KIND)
            out << "response  typical of the kind of camera: the pictures do not determine it\n";
        print_response(report.fit.response, out);
    }
    for (const CameraReport &camera : report.cameras) {
        const lensprof_fit_camera &found = camera.found;
        out << "camera    " << camera.label;
        if (found.images) out << format(", %s", counted(found.images, "picture").c_str());
        if (!found.joined)
            out << (found.images ? "; not connected to the reference" : ": left out");
        else if (camera.is_reference)
            out << ", with the reference";
        else
            out << format("; the light of %u shared pairs differs by %.3f EV (median)", found.shared_pairs,
                          found.irradiance_difference_ev);
        if (found.images && !camera.is_reference && camera.fit.heldout_rms != LENSPROF_UNKNOWN)
            out << format("; residual %.2f levels (RMS, held out)", camera.fit.heldout_rms);
        out << "\n";
        if (!found.images) continue;
        if (camera.fit.response_from == LENSPROF_FIT_RESPONSE_KIND)
            out << "response  typical of the kind of camera: its pictures do not determine it\n";
        print_response(camera.fit.response, out);
    }
}

}  // namespace

void print_build(const BuildReport &report, std::ostream &out) {
    const auto &fit = report.fit;
    print_exposures(report, out);
    print_minority(report, out);
    if (report.has_falloff) print_falloffs(report, out);
    print_responses(report, out);
    print_levels(report.levels, out);
    print_gamma(report, out);
    print_prior(report, out);
    if (report.has_falloff) print_lens_prior(fit, out);
    std::string heldout = "not measured: too few pairs";
    if (fit.heldout_rms != LENSPROF_UNKNOWN)
        heldout = format("%.2f (RMS; median %.2f) on pairs left out of the fit", fit.heldout_rms, fit.heldout_median);
    out << format("residual  before %.2f, after %s, levels of 255; %.1f %% inliers of %u pairs\n", fit.before_rms,
                  heldout.c_str(), 100.0 * fit.inlier_share, fit.pairs);
    if (report.variance.pairs)
        out << format(
            "colours   variance of a point's colour over its views %.1f before, %.1f with exposures alone, %.1f with "
            "this result, levels squared\n",
            report.variance.before, report.variance.exposures_only, report.variance.result);
    if (!report.links.empty()) out << links_row(report.links);
    if (report.register_s > 0.0) out << format("time      find overlaps %.2f s\n", report.register_s);
    out << format("time      load %.2f s, sample %.2f s, solve %.2f s\n", report.load_s, report.sample_s, fit.seconds);
    if (!fit.usable && fit.equalizes && report.has_falloff)
        out << "CORRECTS these pictures; not stored as a profile: " << report.verdict.headline() << "\n";
    else if (!fit.usable)
        out << "NOT USABLE: " << report.verdict.headline() << "\n";
    print_findings(report.verdict, out);
}

}  // namespace lensprof
