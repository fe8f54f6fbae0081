// A profile as JSON.
#include <nlohmann/json.hpp>

#include "photo/base/library.hpp"
#include "photo/report/report.hpp"

namespace lensprof {

Json provenance_json(const lensprof_provenance &p) {
    return {{"method", p.method},
            {"software", p.software},
            {"source", p.source},
            {"created_unix_s", p.created_unix_s},
            {"images", p.images},
            {"pairs", p.pairs},
            {"heldout_rms", number_or_null(p.heldout_rms)},
            {"inlier_share", number_or_null(p.inlier_share)},
            {"doubt", p.doubt},
            {"prior_id", p.prior_id ? Json(p.prior_id) : Json()},
            {"forced", p.forced != 0},
            {"gamma_sigma", p.gamma_sigma > 0.0 ? Json(p.gamma_sigma) : Json()}};
}

Json profile_json(int64_t id, const lensprof_profile &profile) {
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.format = LENSPROF_FORMAT_JSON;
    Json json = Json::parse(exported("profile as JSON", {&profile}, options));
    json["response"]["values"] = samples_json(profile.response, profile.responses);
    if (id) json["id"] = id;
    return json;
}

}  // namespace lensprof
