#include "cli/profiles/lookup_report.hpp"
#include <nlohmann/json.hpp>

#include "cli/program/format.hpp"

namespace lensprof {

Json reason_codes_json(const lensprof_lookup &how) {
    Json codes = Json::array();
    for (uint32_t code : how.reason_code)
        if (code != LENSPROF_REASON_NONE) codes.push_back(lensprof_reason_name(code));
    return codes;
}

Json lookup_json(const lensprof_lookup &how) {
    Json rows = Json::array();
    for (uint32_t i = 0; i < how.rows; i++) rows.push_back({{"id", how.id[i]}, {"weight", how.weight[i]}});
    return {{"exact", how.exact != 0},
            {"rows", rows},
            {"distance", how.distance},
            {"sigma", how.sigma == LENSPROF_UNKNOWN ? Json() : Json(how.sigma)},
            {"name_score", how.name_score},
            {"reason", how.reason},
            {"reason_codes", reason_codes_json(how)}};
}

std::string describe_prediction(const lensprof_lookup &how) {
    return format("predicted from %s of this lens, the nearest (%lld) at %.2f of the 0.5 that are allowed",
                  counted(how.rows, "profile").c_str(), static_cast<long long>(how.id[0]), how.distance);
}

void print_lookup(const lensprof_lookup &how, std::ostream &out) {
    if (how.exact)
        out << "stored    as profile " << how.id[0] << "\n";
    else
        out << describe_prediction(how) << "\n";
    if (how.sigma != LENSPROF_UNKNOWN) out << format("sigma     %.3f of M in the corner\n", how.sigma);
    if (how.name_score < 1.0) out << format("name      matched with score %.1f\n", how.name_score);
    if (*how.reason) out << "mind      " << how.reason << "\n";
}

}  // namespace lensprof
