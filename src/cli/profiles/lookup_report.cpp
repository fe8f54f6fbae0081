#include "cli/profiles/lookup_report.hpp"
#include <algorithm>
#include <iterator>

#include <nlohmann/json.hpp>

#include "cli/program/format.hpp"

namespace lensprof {

Json reason_codes_json(const lensprof_lookup &how) {
    Json codes = Json::array();
    for (uint32_t code : how.reason_code)
        if (code != LENSPROF_REASON_NONE) codes.push_back(lensprof_reason_name(code));
    return codes;
}

namespace {

const char *response_from_name(uint32_t from) {
    static const char *const names[] = {"profile", "camera", "kind", "raw"};
    return from <= LENSPROF_RESPONSE_FROM_RAW ? names[from] : "unknown";
}

Json known(double value) { return value == LENSPROF_UNKNOWN ? Json() : Json(value); }

Json response_json(const lensprof_lookup &how) {
    Json rows = Json::array();
    for (uint32_t i = 0; i < how.response_rows; i++)
        rows.push_back({{"id", how.response_id[i]}, {"weight", how.response_weight[i]}});
    return {{"from", response_from_name(how.response_from)},
            {"camera_kind", camera_kind_name(how.camera_kind)},
            {"rows", rows},
            {"database", how.response_store},
            {"gamma_sigma", known(how.response_sigma)}};
}

std::string describe_response(const lensprof_lookup &how) {
    switch (how.response_from) {
    case LENSPROF_RESPONSE_FROM_CAMERA:
        return format("of the camera, from %s, \u00b1 %.1f %% in gamma", counted(how.response_rows, "profile").c_str(),
                      100.0 * how.response_sigma);
    case LENSPROF_RESPONSE_FROM_KIND:
        return format("typical of its kind (%s), \u00b1 %.1f %% in gamma", camera_kind_name(how.camera_kind),
                      100.0 * how.response_sigma);
    case LENSPROF_RESPONSE_FROM_RAW: return "linear";
    default: return "of the profile";
    }
}

// What a standard error is made of, but for the falloff's own.
std::string describe_parts(const lensprof_lookup &how) {
    std::string text;
    if (how.distance_sigma > 0.0) text += format(", %.3f by the distance", how.distance_sigma);
    if (how.sensor_sigma > 0.0) text += format(", %.3f by the sensor's size", how.sensor_sigma);
    return text.empty() ? text : " (falloff " + format("%.3f", how.falloff_sigma) + text + ")";
}

}  // namespace

Json lookup_json(const lensprof_lookup &how) {
    Json rows = Json::array();
    for (uint32_t i = 0; i < how.rows; i++) rows.push_back({{"id", how.id[i]}, {"weight", how.weight[i]}});
    return {{"exact", how.exact != 0},
            {"rows", rows},
            {"database", how.falloff_store},
            {"distance", how.distance},
            {"sigma", known(how.sigma)},
            {"falloff_sigma", known(how.falloff_sigma)},
            {"distance_sigma", how.distance_sigma},
            {"sensor_sigma", how.sensor_sigma},
            {"response", response_json(how)},
            {"name_score", how.name_score},
            {"reason", how.reason},
            {"reason_codes", reason_codes_json(how)}};
}

std::string describe_prediction(const lensprof_lookup &how) {
    return format("predicted from %s of this lens, the nearest (%lld) at %.2f of the 0.5 that are allowed",
                  counted(how.rows, "profile").c_str(), static_cast<long long>(how.id[0]), how.distance);
}

std::string describe_lookup(const lensprof_lookup &how) {
    std::string text = "falloff " + describe_prediction(how) + "; response " + describe_response(how)
                       + format("; standard error %.3f of M in the corner", how.sigma) + describe_parts(how);
    if (*how.reason) text += std::string("; ") + how.reason;
    return text;
}

std::vector<std::string> nearest_lenses(lensprof_store *store, const lensprof_profile_key &key,
                                        const lensprof_lookup &how) {
    const auto *end = std::end(how.reason_code);
    if (std::find(std::begin(how.reason_code), end, LENSPROF_REASON_LOOKUP_NO_LENS) == end) return {};
    lensprof_store_name names[3];
    uint32_t count = 0;
    if (lensprof_store_nearest_lenses(store, &key, names, 3, &count, nullptr) != LENSPROF_OK) return {};
    std::vector<std::string> lenses;
    for (uint32_t i = 0; i < count; i++) lenses.emplace_back(names[i].lens);
    return lenses;
}

std::string describe_nearest(const std::vector<std::string> &lenses) {
    std::string text;
    for (const std::string &lens : lenses) text += (text.empty() ? "; nearest names: " : "; ") + lens;
    return text;
}

void print_lookup(const lensprof_lookup &how, std::ostream &out) {
    if (how.exact)
        out << "stored    as profile " << how.id[0] << "\n";
    else
        out << "falloff   " << describe_prediction(how) << "\nresponse  " << describe_response(how) << "\n";
    if (how.sigma != LENSPROF_UNKNOWN)
        out << format("sigma     %.3f of M in the corner", how.sigma) << describe_parts(how) << "\n";
    if (how.name_score < 1.0) out << format("name      matched with score %.1f\n", how.name_score);
    if (*how.reason) out << "mind      " << how.reason << "\n";
}

}  // namespace lensprof
