#include "photo/report/verdict.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "photo/base/library.hpp"

namespace lensprof {

const char *severity_name(uint32_t severity) {
    static const char *const names[] = {"passed", "note", "warning", "refusal"};
    return names[severity];
}

namespace {

using Json = nlohmann::ordered_json;

// at(index, finding) asks the library for one.
template <class Result, class At>
Verdict verdict_from(const Result &result, At at) {
    Verdict verdict;
    lensprof_error error{};
    for (uint32_t i = 0; i < result.findings + result.passed; i++) {
        lensprof_finding found;
        lensprof_finding_init(&found);
        check(at(i, &found, &error), "fit", &error);
        Finding finding(found.code, found.severity, found.text, {found.value, found.value + found.value_count});
        finding.item = found.item, finding.measured = found.measured, finding.limit = found.limit;
        if (i >= result.findings) finding.severity = found.rule_severity;
        (i < result.findings ? verdict.findings : verdict.passed).push_back(finding);
    }
    return verdict;
}

bool is_more_severe(const Finding &a, const Finding &b) { return a.severity > b.severity; }

Json number(double value) { return std::isnan(value) ? Json() : Json(value); }

Json finding_json(const Finding &finding) {
    Json json = {{"code", lensprof_reason_name(finding.code)},
                 {"severity", severity_name(finding.severity)},
                 {"text", finding.text},
                 {"item", nullptr},
                 {"values", finding.values},
                 {"measured", number(finding.measured)},
                 {"limit", number(finding.limit)}};
    if (finding.item.kind != LENSPROF_ITEM_NONE)
        json["item"] = {{"kind", finding.item.kind == LENSPROF_ITEM_SHOT ? "shot" : "image"},
                        {"index", finding.item.index},
                        {"file", finding.file}};
    return json;
}

}  // namespace

const Finding *Verdict::find(uint32_t wanted) const {
    const auto found =
        std::find_if(findings.begin(), findings.end(), [=](const Finding &f) { return f.code == wanted; });
    return found == findings.end() ? nullptr : &*found;
}

std::vector<std::string> Verdict::texts(uint32_t severity) const {
    std::vector<std::string> all;
    for (const Finding &finding : findings)
        if (finding.severity == severity) all.push_back(with_code(finding));
    return all;
}

void Verdict::add_first(const Finding &finding) {
    findings.insert(std::lower_bound(findings.begin(), findings.end(), finding, is_more_severe), finding);
}

void Verdict::add_last(const Finding &finding) {
    findings.insert(std::upper_bound(findings.begin(), findings.end(), finding, is_more_severe), finding);
}

Verdict verdict_of(const lensprof_fit *fit, uint32_t setting) {
    lensprof_fit_result result;
    lensprof_fit_result_init(&result);
    lensprof_error error{};
    check(lensprof_fit_setting_at(fit, setting, &result, &error), "fit", &error);
    return verdict_from(result, [=](uint32_t index, lensprof_finding *finding, lensprof_error *failure) {
        return lensprof_fit_finding_at(fit, setting, index, finding, failure);
    });
}

Verdict verdict_of(const lensprof_flat *flat) {
    lensprof_flat_result result;
    lensprof_flat_result_init(&result);
    lensprof_error error{};
    check(lensprof_flat_get(flat, &result, &error), "fit", &error);
    return verdict_from(result, [=](uint32_t index, lensprof_finding *finding, lensprof_error *failure) {
        return lensprof_flat_finding_at(flat, index, finding, failure);
    });
}

Verdict verdict_of(const lensprof_fields *fields) {
    lensprof_fields_result result;
    lensprof_fields_result_init(&result);
    lensprof_error error{};
    check(lensprof_fields_get(fields, &result, &error), "fit", &error);
    return verdict_from(result, [=](uint32_t index, lensprof_finding *finding, lensprof_error *failure) {
        return lensprof_fields_finding_at(fields, index, finding, failure);
    });
}

Verdict verdict_of(const lensprof_rendering *rendering, const lensprof_rendering_result &result) {
    return verdict_from(result, [&](uint32_t i, lensprof_finding *found, lensprof_error *error) {
        return lensprof_rendering_finding_at(rendering, i, found, error);
    });
}

void name_images(const std::vector<std::string> &names, Verdict &verdict) {
    for (Finding &finding : verdict.findings) {
        if (finding.item.kind != LENSPROF_ITEM_IMAGE || finding.item.index >= names.size()) continue;
        finding.file = names[finding.item.index];
        finding.text = with_name(finding.text, finding.item, finding.file);
    }
}

namespace {

// Of two shots, neither is known to be the odd one: both are named. Of more without an odd one, none is.
void name_both_shots(const std::vector<std::string> &names, const std::vector<uint32_t> &shots, Finding &finding) {
    const auto second = std::find_if(shots.begin(), shots.end(), [&](uint32_t shot) { return shot != shots.front(); });
    const auto is_third = [&](uint32_t shot) { return shot != shots.front() && shot != *second; };
    if (second == shots.end() || std::any_of(second, shots.end(), is_third)) return;
    finding.text += "; these are the shots of " + names.front() + " and " + names[size_t(second - shots.begin())];
}

}  // namespace

void name_shots(const std::vector<std::string> &names, const std::vector<uint32_t> &shots, Verdict &verdict) {
    for (Finding &finding : verdict.findings) {
        if (finding.code == LENSPROF_REASON_FLAT_SHOTS_DIFFER && finding.item.kind == LENSPROF_ITEM_NONE)
            name_both_shots(names, shots, finding);
        const auto shot = std::find(shots.begin(), shots.end(), finding.item.index);
        if (finding.item.kind != LENSPROF_ITEM_SHOT || shot == shots.end()) continue;
        finding.file = names[static_cast<size_t>(shot - shots.begin())];
        finding.text = with_name(finding.text, finding.item, "the shot of " + finding.file);
    }
}

void add_verdict(const Verdict &verdict, Json &json) {
    json["findings"] = Json::array();
    for (const Finding &finding : verdict.findings) json["findings"].push_back(finding_json(finding));
    json["passed"] = Json::array();
    for (const Finding &rule : verdict.passed)
        json["passed"].push_back({{"code", lensprof_reason_name(rule.code)},
                                  {"severity", severity_name(rule.severity)},
                                  {"measured", number(rule.measured)},
                                  {"limit", number(rule.limit)}});
}

std::string first_text(const Json &json) {
    const Json &findings = json["findings"];
    return findings.empty() ? "" : findings[0]["text"].get<std::string>();
}

std::string with_code(const Finding &finding) { return finding.text + " [" + lensprof_reason_name(finding.code) + "]"; }

void report_findings(const Verdict &verdict, const std::string &source, Events &events) {
    for (const Finding &finding : verdict.findings)
        if (finding.severity == LENSPROF_SEVERITY_WARNING || finding.severity == LENSPROF_SEVERITY_NOTE)
            events.notice(finding.severity, source, with_code(finding));
}

}  // namespace lensprof
