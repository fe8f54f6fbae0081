#include "cli/report/verdict.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/program/library.hpp"

namespace lensprof {

void name_image(const std::vector<std::string> &names, Verdict &verdict) {
    if (verdict.item.kind != LENSPROF_ITEM_IMAGE || verdict.item.index >= names.size()) return;
    verdict.file = names[verdict.item.index];
    verdict.text = with_name(verdict.text, verdict.item, verdict.file);
}

void name_shot(const std::vector<std::string> &names, const std::vector<uint32_t> &shots, Verdict &verdict) {
    const auto shot = std::find(shots.begin(), shots.end(), verdict.item.index);
    if (verdict.item.kind != LENSPROF_ITEM_SHOT || shot == shots.end()) return;
    verdict.file = names[static_cast<size_t>(shot - shots.begin())];
    verdict.text = with_name(verdict.text, verdict.item, "the shot of " + verdict.file);
}

void add_verdict(const Verdict &verdict, nlohmann::ordered_json &json) {
    json["reason"] = verdict.text;
    json["reason_code"] = lensprof_reason_name(verdict.code);
    json["reason_item"] = nullptr;
    if (verdict.item.kind != LENSPROF_ITEM_NONE)
        json["reason_item"] = {{"kind", verdict.item.kind == LENSPROF_ITEM_SHOT ? "shot" : "image"},
                               {"index", verdict.item.index},
                               {"file", verdict.file}};
    json["reason_values"] = verdict.values;
}

}  // namespace lensprof
