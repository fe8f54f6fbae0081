// A JSON object as one line of UTF-8, whatever the encoding of its file names.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "photo/base/format.hpp"
#include "photo/base/utf8.hpp"
#include "photo/report/report.hpp"

namespace lensprof {
namespace {

std::string hex_of(const std::string &text) {
    std::string hex;
    for (const char c : text) hex += format("%02x", static_cast<unsigned char>(c));
    return hex;
}

// The bytes of a text that is not UTF-8, or of a list with such texts; null if not needed.
Json bytes_of(const Json &value) {
    if (value.is_string()) return is_utf8(value.get<std::string>()) ? Json() : Json(hex_of(value.get<std::string>()));
    if (!value.is_array()) return Json();
    Json list = Json::array();
    bool any = false;
    for (const Json &item : value) {
        list.push_back(item.is_string() ? bytes_of(item) : Json());
        any = any || !list.back().is_null();
    }
    return any ? list : Json();
}

// Adds to every member with text that is not UTF-8 one with its bytes.
void keep_bytes(Json &json) {
    if (json.is_object()) {
        Json kept = Json::object();
        for (const auto &member : json.items()) {
            kept[member.key()] = member.value();
            const Json bytes = bytes_of(member.value());
            if (!bytes.is_null()) kept[member.key() + "_bytes"] = bytes;
        }
        json = std::move(kept);
    }
    for (Json &item : json)
        if (item.is_structured()) keep_bytes(item);
}

bool has_only_utf8(const Json &json) {
    if (json.is_string()) return is_utf8(json.get_ref<const std::string &>());
    return !json.is_structured() || std::all_of(json.begin(), json.end(), has_only_utf8);
}

}  // namespace

Json kept_in_utf8(const Json &json) {
    if (has_only_utf8(json)) return json;
    Json kept = json;
    keep_bytes(kept);
    return Json::parse(kept.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void print_json(const Json &json, std::ostream &out) { out << kept_in_utf8(json).dump() << "\n"; }

}  // namespace lensprof
