#include "photo/correct/lookup_report.hpp"
#include <algorithm>
#include <cmath>
#include <iterator>

#include <nlohmann/json.hpp>

#include "photo/base/format.hpp"
#include "photo/base/nearest.hpp"
#include "photo/calibration/key_filter.hpp"

namespace lensprof {

namespace {

const char *response_from_name(uint32_t from) {
    static const char *const names[] = {"profile", "camera", "kind", "raw"};
    return from <= LENSPROF_RESPONSE_FROM_RAW ? names[from] : "unknown";
}

Json known(double value) { return value == LENSPROF_UNKNOWN ? Json() : Json(value); }

const std::string &database(const Found &found, uint32_t index) {
    static const std::string none;
    return index < found.databases.size() ? found.databases[index] : none;
}

// The database, if there are several.
std::string in_database(const Found &found, uint32_t index) {
    return found.databases.size() > 1 ? " in " + database(found, index) : std::string();
}

Json response_json(const Found &found) {
    const lensprof_lookup &lookup = found.lookup;
    Json rows = Json::array();
    for (uint32_t i = 0; i < lookup.response_rows; i++)
        rows.push_back({{"id", lookup.response_id[i]}, {"weight", lookup.response_weight[i]}});
    if (found.response_is_given) return {{"from", "given"}};
    return {{"from", response_from_name(lookup.response_from)},
            {"camera_kind", camera_kind_name(lookup.camera_kind)},
            {"rows", rows},
            {"database", lookup.response_rows ? Json(database(found, lookup.response_store)) : Json()},
            {"gamma_sigma", known(lookup.response_sigma)}};
}

std::string describe_response(const Found &found) {
    const lensprof_lookup &lookup = found.lookup;
    if (found.response_is_given) return "as given";
    switch (lookup.response_from) {
    case LENSPROF_RESPONSE_FROM_CAMERA:
        return "of the camera, from " + counted(lookup.response_rows, "profile")
               + in_database(found, lookup.response_store)
               + format(", \u00b1 %.1f %% in gamma", 100.0 * lookup.response_sigma);
    case LENSPROF_RESPONSE_FROM_KIND:
        return format("typical of its kind (%s), \u00b1 %.1f %% in gamma", camera_kind_name(lookup.camera_kind),
                      100.0 * lookup.response_sigma);
    case LENSPROF_RESPONSE_FROM_RAW: return "linear";
    default: return "of the profile";
    }
}

// The parts of a standard error. The response's part is what remains.
std::string describe_parts(const lensprof_lookup &lookup) {
    std::string text;
    const double others = std::hypot(lookup.falloff_sigma, std::hypot(lookup.distance_sigma, lookup.sensor_sigma)),
                 response = std::sqrt(std::max(lookup.sigma * lookup.sigma - others * others, 0.0));
    if (lookup.distance_sigma > 0.0) text += format(", distance %.3f", lookup.distance_sigma);
    if (lookup.sensor_sigma > 0.0) text += format(", sensor size %.3f", lookup.sensor_sigma);
    if (response >= 0.0005) text += format(", response %.3f", response);
    return text.empty() ? text : " (falloff " + format("%.3f", lookup.falloff_sigma) + text + ")";
}

// Removes the sentence of a reason from a text of several.
void remove_sentence(uint32_t code, std::string &text) {
    const std::string sentence = lensprof_reason_text(code);
    const size_t position = text.find(sentence);
    if (position == std::string::npos) return;
    const size_t separator_bytes = position >= 2 ? 2 : 0;  // "; "
    text.erase(position - separator_bytes, sentence.size() + separator_bytes);
    if (text.rfind("; ", 0) == 0) text.erase(0, 2);
}

std::string describe_prediction(const Found &found) {
    const lensprof_lookup &lookup = found.lookup;
    const std::string in_file = in_database(found, lookup.falloff_store);
    if (lookup.exact) return format("stored as profile %lld", static_cast<long long>(lookup.id[0])) + in_file;
    return "predicted from " + counted(lookup.rows, "profile") + " of this lens" + in_file
           + format(", the nearest (%lld) at %.2f of the allowed 0.5", static_cast<long long>(lookup.id[0]),
                    lookup.distance);
}

}  // namespace

Json reason_codes_json(const lensprof_lookup &lookup) {
    Json codes = Json::array();
    for (uint32_t code : lookup.reason_code)
        if (code != LENSPROF_REASON_NONE) codes.push_back(lensprof_reason_name(code));
    return codes;
}

Found with_response_given(Found found) {
    lensprof_lookup &lookup = found.lookup;
    found.response_is_given = true;
    lookup.response_sigma = 0.0;
    if (lookup.falloff_sigma != LENSPROF_UNKNOWN)
        lookup.sigma = std::hypot(lookup.falloff_sigma, std::hypot(lookup.distance_sigma, lookup.sensor_sigma));
    std::vector<uint32_t> codes;
    std::string text = lookup.reason;
    for (uint32_t code : lookup.reason_code) {
        if (code != LENSPROF_REASON_LOOKUP_TYPICAL_RESPONSE && code != LENSPROF_REASON_LOOKUP_OTHER_STYLE) {
            codes.push_back(code);
            continue;
        }
        remove_sentence(code, text);
    }
    codes.resize(std::size(lookup.reason_code));
    std::copy(codes.begin(), codes.end(), lookup.reason_code);
    std::fill(std::begin(lookup.reason), std::end(lookup.reason), '\0');
    std::copy(text.begin(), text.end(), lookup.reason);
    return found;
}

Json lookup_json(const Found &found) {
    const lensprof_lookup &lookup = found.lookup;
    Json rows = Json::array();
    for (uint32_t i = 0; i < lookup.rows; i++) rows.push_back({{"id", lookup.id[i]}, {"weight", lookup.weight[i]}});
    return {{"exact", lookup.exact != 0},
            {"rows", rows},
            {"database", database(found, lookup.falloff_store)},
            {"distance", lookup.distance},
            {"sigma", known(lookup.sigma)},
            {"falloff_sigma", known(lookup.falloff_sigma)},
            {"distance_sigma", lookup.distance_sigma},
            {"sensor_sigma", lookup.sensor_sigma},
            {"response", response_json(found)},
            {"name_score", lookup.name_score},
            {"reason", lookup.reason},
            {"reason_codes", reason_codes_json(lookup)}};
}

std::string describe_briefly(const Found &found) {
    const lensprof_lookup &lookup = found.lookup;
    std::string others = lookup.reason;  // the parts of the error cover these two
    remove_sentence(LENSPROF_REASON_LOOKUP_USUAL_DISTANCE, others);
    remove_sentence(LENSPROF_REASON_LOOKUP_TYPICAL_RESPONSE, others);
    std::string text = lookup.exact ? format("falloff of profile %lld", static_cast<long long>(lookup.id[0]))
                                    : "falloff predicted from " + counted(lookup.rows, "profile");
    text += in_database(found, lookup.falloff_store) + ", response " + describe_response(found);
    return others.empty() ? text : text + "; " + others;
}

std::string describe_error(const lensprof_lookup &lookup) {
    if (lookup.sigma == LENSPROF_UNKNOWN) return "the error of M is unknown";
    return format("relative illuminance in the corner \u00b1 %.3f", lookup.sigma) + describe_parts(lookup);
}

constexpr uint32_t kMaxNames = 3;

// "EOS 6D" of "Canon EOS 6D".
static std::string without_maker(const std::string &model, const std::string &maker) {
    const size_t length = maker.size() + 1;
    const bool begins =
        !maker.empty() && model.size() > length && letters_changed(model.substr(0, length), maker + " ") == 0;
    return begins ? model.substr(length) : model;
}

// Ranked by the number of letters in which the model differs, at most half of them.
static std::vector<std::string> nearest_cameras(const Databases &databases, const lensprof_profile_key &key) {
    std::vector<std::pair<size_t, std::string>> ranked;
    for (size_t i = 0; i < databases.size(); i++)
        for (const auto &row : listed<lensprof_store_summary>(
                 databases.file(i),
                 [&](lensprof_store_summary *buffer, uint32_t capacity, uint32_t *count, lensprof_error *error) {
                     return lensprof_store_list_names(databases.store(i), LENSPROF_NAMES_CAMERAS, "", buffer, capacity,
                                                      count, error);
                 })) {
            const std::string given = without_maker(key.camera_model, row.camera_maker);
            const size_t changes = letters_changed(given, without_maker(row.camera_model, row.camera_maker));
            if (changes <= given.size() / 2)
                ranked.emplace_back(changes, camera_name(row.camera_maker, row.camera_model));
        }
    std::stable_sort(ranked.begin(), ranked.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
    std::vector<std::string> cameras;
    for (const auto &entry : ranked)
        if (cameras.size() < kMaxNames && std::find(cameras.begin(), cameras.end(), entry.second) == cameras.end())
            cameras.push_back(entry.second);
    return cameras;
}

std::vector<std::string> nearest_names(const Databases &databases, const lensprof_profile_key &key,
                                       const lensprof_lookup &lookup) {
    const auto has_reason = [&](uint32_t code) {
        return std::find(std::begin(lookup.reason_code), std::end(lookup.reason_code), code)
               != std::end(lookup.reason_code);
    };
    if (has_reason(LENSPROF_REASON_LOOKUP_NO_CAMERA) && *key.camera_model) return nearest_cameras(databases, key);
    if (!has_reason(LENSPROF_REASON_LOOKUP_NO_LENS)) return {};
    std::vector<std::string> lenses;
    for (const char *name : lookup.nearest)
        if (*name) lenses.emplace_back(name);
    return lenses;
}

std::string describe_nearest(const std::vector<std::string> &names) {
    std::string text;
    for (const std::string &name : names) text += (text.empty() ? "; nearest names: " : "; ") + name;
    return text;
}

std::string lookup_lines(const Found &found) {
    const lensprof_lookup &lookup = found.lookup;
    std::string lines =
        "lookup    falloff " + describe_prediction(found) + "\n          response " + describe_response(found) + "\n";
    if (lookup.sigma > 0.0)
        lines += format("sigma     %.3f of M in the corner", lookup.sigma) + describe_parts(lookup) + "\n";
    else
        lines += "sigma     unknown: the profile does not state its error\n";
    if (lookup.name_score < 1.0) lines += format("name      matched with score %.1f\n", lookup.name_score);
    return *lookup.reason ? lines + "warning   " + lookup.reason + "\n" : lines;
}

}  // namespace lensprof
