// The report of `lensprof flat`: a JSON object and a table.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/fitting/flat.hpp"
#include "cli/report/findings.hpp"
#include "photo/base/format.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

const char *light_name(uint32_t light) {
    static const char *const names[] = {"auto", "even", "plane", "quadratic"};
    return light <= LENSPROF_FLAT_LIGHT_QUADRATIC ? names[light] : "unknown";
}

Json images_json(const CardFit &report) {
    Json images = Json::array();
    for (size_t i = 0; i < report.files.size(); i++) {
        const auto &q = report.quality[i];
        images.push_back({{"file", report.files[i]},
                          {"shot", report.shots[i]},
                          {"ev", report.ev[i]},
                          {"rotation_deg", report.rotated[i]},
                          {"card", {q.card[0], q.card[1], q.card[2], q.card[3]}},
                          {"cells", q.cells},
                          {"radius", q.radius},
                          {"white_share", q.white_share},
                          {"black_share", q.black_share},
                          {"noise_levels", q.noise_levels},
                          {"ev_residual", q.ev_residual},
                          {"residual", q.residual},
                          {"gradient", {q.gradient[0], q.gradient[1]}}});
    }
    return images;
}

Json spots_json(const lensprof_flat_result &fit) {
    Json spots = Json::array();
    for (uint32_t i = 0; i < std::min<uint32_t>(fit.spots, LENSPROF_FLAT_SPOTS); i++) {
        const auto &s = fit.spot[i];
        spots.push_back({{"x", s.x}, {"y", s.y}, {"radius", s.radius}, {"depth", s.depth}, {"shots", s.shots}});
    }
    return spots;
}

void print_images(const CardFit &report, std::ostream &out) {
    size_t width = 5;
    for (const auto &name : report.files) width = std::max(width, name.size());
    out << format("%-*s  %4s  %7s  %7s  %6s  %7s  %7s  %6s  %7s  %-13s\n", static_cast<int>(width), "image", "shot",
                  "EV", "rotated", "r", "white %", "black %", "noise", "resid %", "light right, down %");
    for (size_t i = 0; i < report.files.size(); i++) {
        const auto &q = report.quality[i];
        out << format("%-*s  %4u  %+7.2f  %7g  %6.2f  %7.1f  %7.1f  %6.2f  %7.2f  %+6.1f %+6.1f\n",
                      static_cast<int>(width), report.files[i].c_str(), report.shots[i], report.ev[i],
                      report.rotated[i], q.radius, 100.0 * q.white_share, 100.0 * q.black_share, q.noise_levels,
                      100.0 * q.residual, 100.0 * q.gradient[0], 100.0 * q.gradient[1]);
    }
}

Json levels_json(const lensprof_flat_result &fit) {
    const double *black = fit.levels.black;
    return {{"black", {black[0], black[1], black[2]}},
            {"white", fit.levels.white > 0.0 ? fit.levels.white : 1.0},
            {"offset", fit.black_offset},
            {"black_sigma", fit.black_sigma},
            {"black_ev", fit.black_ev},
            {"from_pictures", fit.black_shown != 0}};
}

// Nothing for black that is 0 and not uncertain.
void print_levels(const lensprof_flat_result &fit, std::ostream &out) {
    const double *black = fit.levels.black;
    if (black[0] == 0.0 && black[1] == 0.0 && black[2] == 0.0 && fit.black_sigma == 0.0) return;
    out << format("black     %.3f %% of full scale", 100.0 * black[1]);
    if (black[0] != black[1] || black[2] != black[1])
        out << format(" (red %.3f, blue %.3f)", 100.0 * black[0], 100.0 * black[2]);
    if (fit.black_sigma > 0.0) out << " +- " << error_text(100.0 * fit.black_sigma);
    out << (fit.black_shown ? ", as the pictures show" : "");
    out << format("; its error changes the corner by %.3f EV\n", fit.black_ev);
}

void print_spots(const lensprof_flat_result &fit, std::ostream &out) {
    if (!fit.spots) return;
    out << format("dust      %u spots excluded:", fit.spots);
    const uint32_t listed_count = std::min<uint32_t>(fit.spots, 5);
    for (uint32_t i = 0; i < listed_count; i++)
        out << format("  %.0f,%.0f px (%.1f %% darker, in %u of %u shots)", fit.spot[i].x, fit.spot[i].y,
                      100.0 * fit.spot[i].depth, fit.spot[i].shots, fit.shots);
    out << (listed_count < fit.spots ? "  ...\n" : "\n");
}

}  // namespace

Json flat_json(const CardFit &report) {
    const auto &fit = report.fit;
    Json json;
    json["schema"] = json_schema;
    json["method"] = "flat";
    json["usable"] = fit.usable != 0;
    add_verdict(report.verdict, json);
    json["images"] = images_json(report);
    json["vignetting"] = vignetting_json(fit.vignetting, fit.vignettings);
    json["response"] = response_json(report.response.data(), static_cast<uint32_t>(report.response.size()));
    json["light"] = light_name(fit.light);
    json["separated"] = fit.separated != 0;
    json["shots"] = fit.shots;
    json["cells"] = fit.cells;
    json["radius"] = fit.radius;
    json["residual"] = {{"noise", fit.noise},
                        {"cell", fit.residual},
                        {"texture", fit.texture},
                        {"frame", fit.frame_residual},
                        {"shot", fit.shot_residual},
                        {"with_grid", fit.gain_grid.columns ? Json(fit.grid_residual) : Json()},
                        {"inlier_share", fit.inlier_share}};
    json["corner"] = fit.corner;
    json["corner_sigma"] = fit.corner_sigma;
    const lensprof_image_circle &circle = fit.image_circle;
    json["image_circle"] = circle.radius > 0.0
                               ? Json{{"center", {circle.center[0], circle.center[1]}}, {"radius", circle.radius}}
                               : Json();
    json["edge"] = fit.edge_radius > 0.0 ? Json{{"radius", fit.edge_radius}, {"share", fit.edge_share}} : Json();
    json["light_ev"] = fit.light_ev;
    json["polynomial_error"] = fit.polynomial_error;
    json["levels"] = levels_json(fit);
    json["spot_count"] = fit.spots;
    json["spots"] = spots_json(fit);
    json["gain_grid"] = gain_grid_json(fit.gain_grid);
    json["iterations"] = fit.iterations;
    json["covariance"] = covariance_json(fit.covariance, fit.covariance_size);
    json["seconds"] = {{"load", report.load_s}, {"solve", report.solve_s}};
    json["profile"] = report.profile_id ? Json(report.profile_id) : Json();
    return json;
}

void print_flat(const CardFit &report, bool with_notes, std::ostream &out) {
    const auto &fit = report.fit;
    print_images(report, out);
    print_vignettings(*profile_of(*report.held), out, report.aspect);
    for (const auto &response : report.response) print_response(response, out);
    out << format("light     %s; its gradient %s\n", light_name(fit.light),
                  fit.light == LENSPROF_FLAT_LIGHT_EVEN ? "taken as zero"
                  : fit.separated                       ? "separated from the lens by the rotated shots"
                                                        : "and the centre separated only by the prior on the centre");
    out << format(
        "residual  %.2f %% of the light per cell (noise %.2f, texture %.2f, not radial %.2f, shots differ %.2f); %.1f "
        "%% inliers of %u cells\n",
        100.0 * fit.residual, 100.0 * fit.noise, 100.0 * fit.texture, 100.0 * fit.frame_residual,
        100.0 * fit.shot_residual, 100.0 * fit.inlier_share, fit.cells);
    if (fit.gain_grid.columns) {
        out << "corner    " << with_decimals_of(fit.corner_sigma, fit.corner) << " +- " << error_text(fit.corner_sigma)
            << " of the light in the middle, with the grid"
            << (fit.edge_radius > 0.0 ? format(", at the outermost cells (r = %.2f)", fit.radius) : "") << "\n";
        out << format("grid      %u x %u nodes for what k1..k3 leave: %.2f %% remain\n", fit.gain_grid.columns,
                      fit.gain_grid.rows, 100.0 * fit.grid_residual);
    }
    print_levels(fit, out);
    print_spots(fit, out);
    out << format("time      load %.2f s, solve %.2f s\n", report.load_s, report.solve_s);
    if (!fit.usable) out << "NOT USABLE: " << report.verdict.headline() << "\n";
    if (with_notes) print_findings(report.verdict, out);
}

}  // namespace lensprof
