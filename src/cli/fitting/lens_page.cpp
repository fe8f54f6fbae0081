// The report of a whole lens as a web page (cli/page).
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/fitting/lens_report.hpp"
#include "cli/page/page.hpp"
#include "cli/report/curves_json.hpp"
#include "photo/base/format.hpp"

namespace lensprof {
namespace {

Json settings_json(const LensCards &cards) {
    Json rows = Json::array();
    for (size_t n = 0; n < cards.settings.size(); n++) {
        const MeasuredSetting &setting = cards.settings[n];
        rows.push_back({setting.of.label, std::to_string(setting.of.pictures.size()),
                        setting.fit ? corner_text(*setting.fit->profile) : "–", result_text(cards, n)});
    }
    return rows;
}

// The pictures to take again and those missing, as a page's verdict.
Verdict verdict_of(const LensCards &cards) {
    Verdict verdict;
    for (const MeasuredSetting &setting : cards.settings)
        if (!setting.is_good())
            verdict.add_last(
                {LENSPROF_REASON_NONE, LENSPROF_SEVERITY_WARNING, setting.of.label + ": " + setting.refusal});
    for (const MissingSetting &setting : cards.missing)
        verdict.add_last(
            {LENSPROF_REASON_NONE, LENSPROF_SEVERITY_NOTE,
             "missing: " + missing_lens(cards, setting) + format(", %g mm, f/%g", setting.focal_mm, setting.aperture)});
    return verdict;
}

}  // namespace

std::string lens_page(const LensCards &cards, const std::string &command, const std::vector<std::string> &warnings) {
    const lensprof_profile_key &key = cards.settings.front().of.key;
    const std::string lens = *key.lens ? key.lens : "unknown lens";
    Json page = new_page("lens", lens, "Falloff of the lens, from pictures of a white card", command);
    page["verdict"] = page_verdict(cards.good() > 0, false, verdict_of(cards), warnings);
    page["facts"] = Json::array({{"camera", camera_name(key.camera_maker, key.camera_model)},
                                 {"settings", std::to_string(cards.settings.size())},
                                 {"good", std::to_string(cards.good())},
                                 {"to take again", std::to_string(cards.settings.size() - cards.good())},
                                 {"missing", std::to_string(cards.missing.size())}});
    page["settings"] = settings_json(cards);
    page["falloffs"] = Json::array(), page["falloff_points"] = Json::array(), page["responses"] = Json::array();
    for (const MeasuredSetting &setting : cards.settings)
        if (setting.is_good()) add_falloff_curves(*setting.fit->profile, setting.of.label, page["falloffs"]);
    page["images"] = Json::array();
    page["left_out"] = Json::array();
    for (const LeftOutCard &card : cards.left_out)
        page["left_out"].push_back({{"name", card.file}, {"reason", card.reason}});
    page["result"] = lens_json(cards);
    return page_of(page);
}

}  // namespace lensprof
