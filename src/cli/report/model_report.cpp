// Response, falloff and covariance, the parts that fits and profiles share, as rows of a table.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {

namespace {

double corner(const lensprof_vignetting &v) { return lensprof_vignetting_eval(&v, 1.0, nullptr); }

// 100 M at r, " +- " and its standard error if known; an error is never printed as 0.0.
std::string light_at(const lensprof_profile &profile, uint32_t curve, double r, bool &is_known) {
    double sigma;
    const double m = lensprof_profile_radial_falloff(&profile, curve, r, &sigma), percent = 100.0 * sigma;
    is_known = sigma > 0.0;
    return format("%.1f", 100.0 * m) + (is_known ? format(percent < 0.05 ? " +- %.1g" : " +- %.1f", percent) : "");
}

// The light with the grid, which holds what the polynomial does not: k1..k3 alone can be far from it.
std::string light_with_grid(const lensprof_profile &profile, uint32_t curve, double aspect) {
    const uint32_t channel = profile.vignettings == 3 ? curve : 1;
    const double corner_light = mean_light(profile, channel, 1.0, aspect);
    const std::string text =
        format("          light at r = 0.5: %.1f %%, %s: %.1f %% (%.2f stops), with the gain grid",
               100.0 * mean_light(profile, channel, 0.5, aspect),
               profile.image_circle.radius > 0.0 ? "at the edge of the image circle" : "in the corners",
               100.0 * corner_light, -std::log2(corner_light));
    if (profile.image_circle.radius > 0.0) return text + "\n";
    return text
           + format(", which holds what k1..k3 do not: these alone give %.1f %%\n",
                    100.0 * corner(profile.vignetting[curve]));
}

}  // namespace

void print_vignettings(const lensprof_profile &profile, std::ostream &out, double aspect) {
    static const char *const channels[3] = {" of red", " of green", " of blue"};
    for (uint32_t c = 0; c < profile.vignettings; c++) {
        const lensprof_vignetting &v = profile.vignetting[c];
        const char *channel = profile.vignettings == 3 ? channels[c] : "";
        if (!has_falloff(v)) {
            out << "falloff" << channel << "   none: not measured, or fixed at zero\n";
            continue;
        }
        out << "falloff" << channel
            << format("   k1 %+.4f  k2 %+.4f  k3 %+.4f   centre %+.4f %+.4f half diagonals\n", v.k[0], v.k[1], v.k[2],
                      v.center[0], v.center[1]);
        if (profile.grid.columns) {
            out << light_with_grid(profile, c, aspect);
            continue;
        }
        bool is_known;
        const bool has_circle = profile.image_circle.radius > 0.0;
        const double r = has_circle ? std::min(profile.image_circle.radius, 1.0) : 1.0;
        const std::string middle = light_at(profile, c, 0.5, is_known), end = light_at(profile, c, r, is_known);
        out << format("          light at r = 0.5: %s %%, %s: %s %% (%.2f stops)%s\n", middle.c_str(),
                      has_circle ? "at the edge of the image circle" : "in the corner", end.c_str(),
                      -std::log2(lensprof_vignetting_eval(&v, r * r, nullptr)), is_known ? "" : ", error unknown");
    }
}

void print_response(const lensprof_response &r, std::ostream &out) {
    static const char *const kinds[] = {"linear", "gamma", "EMoR", "table"};
    std::string kind = kinds[r.kind];
    if (r.kind == LENSPROF_RESPONSE_EMOR) kind += format(", %u modes", r.modes);
    if (r.kind == LENSPROF_RESPONSE_GAMMA) kind += format(" %.3g", r.gamma);
    out << "response  " << kind << ";  grey value (of 255) at irradiance";
    for (double x : {0.01, 0.05, 0.2, 0.5})
        out << format("  %g: %.1f", x, 255.0 * lensprof_response_eval(&r, x, nullptr));
    out << "\n";
}

}  // namespace lensprof
