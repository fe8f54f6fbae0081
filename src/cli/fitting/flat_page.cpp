// The report of `flat` as a web page (cli/page): falloff, its grid and the quality of the pictures.
#include <nlohmann/json.hpp>

#include "cli/fitting/flat.hpp"
#include "cli/page/page.hpp"
#include "cli/report/curves_json.hpp"
#include "photo/base/format.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

Json flat_facts(const CardFit &report, const lensprof_profile &profile) {
    Json facts = Json::array();
    const auto add = [&](const char *name, const std::string &value) { facts.push_back({name, value}); };
    add("corner illuminance", corner_text(profile));
    add("pictures", std::to_string(report.files.size()));
    add("shots", std::to_string(report.fit.shots));
    add("residual of a cell", format("%.2f %% (noise %.2f %%)", 100.0 * report.fit.residual, 100.0 * report.fit.noise));
    add("not radial", format("%.2f %%", 100.0 * report.fit.frame_residual));
    add("dust and marks", std::to_string(report.fit.spots));
    return facts;
}

}  // namespace

std::string flat_page(const CardFit &report, const std::string &title, const std::string &command,
                      const std::vector<std::string> &warnings) {
    const auto profile = profile_of(*report.held);
    Json page = new_page("card", title, "Falloff from pictures of a white card", command);
    page["verdict"] = page_verdict(report.fit.usable, false, report.verdict, warnings);
    page["facts"] = flat_facts(report, *profile);
    page["falloffs"] = Json::array(), page["falloff_points"] = Json::array(), page["responses"] = Json::array();
    add_falloff_curves(*profile, "", page["falloffs"]);
    add_response_curves(*profile, "response used", page["responses"]);
    page["images"] = Json::array();
    page["result"] = flat_json(report);
    return page_of(page);
}

}  // namespace lensprof
