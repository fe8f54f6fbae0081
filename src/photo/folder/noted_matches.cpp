#include "photo/folder/noted_matches.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace lensprof {
namespace {

constexpr size_t kNumbers = 10;  // per match: image, image, x, y, x, y, and the four numbers of the map

double rounded(double value, double steps) { return std::round(steps * value) / steps; }

bool are_numbers(const Json &list, size_t images) {
    size_t n = 0;
    return std::all_of(list.begin(), list.end(), [&](const Json &number) {
        return n++ % kNumbers > 1 ? number.is_number() : number.is_number_unsigned() && number.get<uint64_t>() < images;
    });
}

}  // namespace

// A flat array; positions to 0.01 px.
Json json_of(const NotedMatches &matches) {
    Json list = Json::array();
    for (const lensprof_match &m : matches.list) {
        for (uint32_t image : m.image) list.push_back(image);
        for (const auto &xy : m.xy)
            for (double coordinate : xy) list.push_back(rounded(coordinate, 100.0));
        for (const auto &row : m.map)
            for (double coefficient : row) list.push_back(rounded(coefficient, 1e4));
    }
    return {{"are_all", matches.are_all}, {"list", list}};
}

bool read_noted(const Json &json, size_t images, NotedMatches &matches) {
    if (!json.is_object() || !json.contains("are_all") || !json["are_all"].is_boolean() || !json.contains("list"))
        return false;
    const Json &list = json["list"];
    if (!list.is_array() || list.size() % kNumbers || !are_numbers(list, images)) return false;
    matches.are_all = json["are_all"].get<bool>();
    matches.list.assign(list.size() / kNumbers, lensprof_match{});
    auto next = list.begin();
    const auto read_next = [&](auto &value) { (next++)->get_to(value); };
    for (lensprof_match &m : matches.list) {
        for (uint32_t &image : m.image) read_next(image);
        for (auto &xy : m.xy)
            for (double &coordinate : xy) read_next(coordinate);
        for (auto &row : m.map)
            for (double &coefficient : row) read_next(coefficient);
    }
    return true;
}

}  // namespace lensprof
