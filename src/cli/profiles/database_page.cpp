#include "cli/profiles/database_page.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <nlohmann/json.hpp>

#include "cli/page/page.hpp"
#include "cli/report/curves_json.hpp"
#include "cli/report/report.hpp"
#include "photo/base/format.hpp"
#include "photo/report/falloff.hpp"

namespace lensprof {
namespace {

constexpr double infinity_m = 1000.0;  // JSON has no infinity

Json finite(double value) { return value == LENSPROF_UNKNOWN ? Json() : Json(std::isinf(value) ? infinity_m : value); }

std::string camera_of(const lensprof_profile_key &key) { return camera_name(key.camera_maker, key.camera_model); }

bool shows_falloff(const lensprof_profile &profile) {
    return has_falloff(profile.vignetting[green_curve(profile.vignettings)]);
}

Json setting_json(const StoredProfile &stored) {
    const lensprof_profile &p = *stored.profile;
    const lensprof_vignetting &green = p.vignetting[green_curve(p.vignettings)];
    std::string note = *p.key.unit ? std::string("unit ") + p.key.unit : std::string();
    if (*p.provenance.doubt) note += (note.empty() ? "" : ", ") + std::string("in doubt");
    return {{"id", stored.id},
            {"focal_mm", finite(p.key.focal_mm)},
            {"aperture", finite(p.key.aperture)},
            {"distance_m", finite(p.key.distance_m)},
            {"crop", finite(p.key.crop_factor)},
            {"processing", processing_name(p.key.processing)},
            {"k", std::vector<double>(green.k, green.k + 3)},
            {"note", note}};
}

const char *response_kind(const lensprof_profile &profile) {
    switch (profile.response[0].kind) {
    case LENSPROF_RESPONSE_LINEAR: return "linear";
    case LENSPROF_RESPONSE_GAMMA: return "gamma";
    case LENSPROF_RESPONSE_EMOR: return "measured (EMoR)";
    default: return "measured (table)";
    }
}

Json profile_facts(const lensprof_profile &p) {
    const lensprof_provenance &from = p.provenance;
    Json facts = Json::array();
    const auto add = [&](const char *name, const std::string &value) {
        if (!value.empty()) facts.push_back({name, value});
    };
    if (shows_falloff(p)) add("corner illuminance", corner_text(p));
    add("response", response_kind(p));
    add("processing", processing_name(p.key.processing));
    add("method", from.method);
    if (from.images) add("pictures", std::to_string(from.images));
    if (from.pairs) add("pairs", std::to_string(from.pairs));
    if (from.heldout_rms != LENSPROF_UNKNOWN) add("held-out residual", format("%.2f levels", from.heldout_rms));
    add("source", from.source);
    return facts;
}

// How many profiles there are to rely on.
Json database_verdict(const std::vector<StoredProfile> &profiles, size_t lenses,
                      const std::vector<std::string> &warnings) {
    const auto doubtful =
        static_cast<size_t>(std::count_if(profiles.begin(), profiles.end(), [](const StoredProfile &stored) {
            return *stored.profile->provenance.doubt || stored.profile->provenance.forced;
        }));
    Json details = warnings;
    if (doubtful)
        details.push_back(
            counted(doubtful, "profile")
            + " in doubt: lookups use them only with --key doubtful=yes; `lensprof profile check` gives reasons");
    return {{"level", doubtful == profiles.size() || !warnings.empty() ? "warn" : "good"},
            {"headline",
             counted(profiles.size() - doubtful, "usable profile") + " of " + counted(lenses, "lens", "lenses") + "."},
            {"details", details}};
}

}  // namespace

std::string profile_page(const StoredProfile &stored, const std::string &command) {
    const lensprof_profile &p = *stored.profile;
    const std::string subtitle = stored.id ? format("Profile %lld", static_cast<long long>(stored.id)) : "Profile";
    Json page = new_page("profile", describe_key(p.key), subtitle, command);
    const bool in_doubt = *p.provenance.doubt || p.provenance.forced;
    page["verdict"] = {{"level", in_doubt ? "warn" : "good"},
                       {"headline", in_doubt    ? "This profile is in doubt."
                                    : stored.id ? "A usable profile: its fit gave no reason for doubt."
                                                : "A profile from a file."},
                       {"details", Json::array()}};
    if (*p.provenance.doubt) page["verdict"]["details"].push_back(p.provenance.doubt);
    if (p.provenance.forced) page["verdict"]["details"].push_back("It was stored although its fit was not usable.");
    page["facts"] = profile_facts(p);
    page["falloffs"] = Json::array(), page["falloff_points"] = Json::array(), page["responses"] = Json::array();
    if (shows_falloff(p)) add_falloff_curves(p, "", page["falloffs"]);
    add_response_curves(p, "this profile", page["responses"]);
    page["typical"] = p.response[0].kind == LENSPROF_RESPONSE_LINEAR
                          ? Json()
                          : typical_band(*p.key.camera_model ? LENSPROF_CAMERA_STILL : LENSPROF_CAMERA_ANY);
    page["images"] = Json::array();
    page["result"] = profile_json(stored.id, p);
    return page_of(page);
}

std::string database_page(const std::vector<StoredProfile> &profiles, const std::string &name,
                          const std::string &command, const std::vector<std::string> &warnings) {
    std::map<std::pair<std::string, std::string>, Json> lenses;         // by camera and lens
    std::map<std::string, std::map<std::string, size_t>> camera_kinds;  // profiles of each kind of response
    for (const StoredProfile &stored : profiles) {
        const lensprof_profile_key &key = stored.profile->key;
        if (!camera_of(key).empty()) camera_kinds[camera_of(key)][response_kind(*stored.profile)]++;
        if (!shows_falloff(*stored.profile)) continue;
        Json &lens = lenses[{camera_of(key), key.lens}];
        if (lens.is_null()) lens = {{"camera", camera_of(key)}, {"lens", key.lens}, {"settings", Json::array()}};
        lens["settings"].push_back(setting_json(stored));
    }
    Json page = new_page("database", name, format("%zu profiles of a database", profiles.size()), command);
    page["verdict"] = database_verdict(profiles, lenses.size(), warnings);
    page["facts"] = Json::array();
    page["facts"].push_back({"profiles", std::to_string(profiles.size())});
    page["facts"].push_back({"lenses", std::to_string(lenses.size())});
    page["facts"].push_back({"cameras", std::to_string(camera_kinds.size())});
    page["lenses"] = Json::array(), page["cameras"] = Json::array();
    for (auto &[key, lens] : lenses) page["lenses"].push_back(std::move(lens));
    for (const auto &[camera, kinds] : camera_kinds) {
        std::string responses;
        size_t count = 0;
        for (const auto &[kind, number] : kinds)
            responses += (responses.empty() ? "" : ", ") + kind + format(" (%zu)", number), count += number;
        page["cameras"].push_back({{"name", camera}, {"profiles", count}, {"response", responses}});
    }
    return page_of(page);
}

}  // namespace lensprof
