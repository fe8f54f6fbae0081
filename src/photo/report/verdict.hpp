// The verdict of a result: findings with files instead of image numbers.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <lensprof/fields.h>
#include <lensprof/fit.h>
#include <lensprof/flat.h>
#include <lensprof/rendering.h>

#include "photo/base/events.hpp"

namespace lensprof {

struct Finding {
    uint32_t code = LENSPROF_REASON_NONE, severity = LENSPROF_SEVERITY_REFUSAL;
    std::string text;
    lensprof_item item{};
    std::string file;  // of the item; for a shot, its first picture
    std::vector<double> values;
    double measured = NAN, limit = NAN;

    Finding() = default;
    Finding(uint32_t of, uint32_t how_severe, const std::string &sentence, std::vector<double> numbers = {})
        : code(of), severity(how_severe), text(sentence), values(std::move(numbers)) {}
};

// The text with the name of its code, which docs/reasons.md explains: "... [few_pairs]".
std::string with_code(const Finding &finding);

struct Verdict {
    std::vector<Finding> findings;  // refusals, then warnings, then notes
    std::vector<Finding> passed;    // rules that hold

    // Of the most important finding; NONE and empty without findings.
    uint32_t code() const { return findings.empty() ? uint32_t{LENSPROF_REASON_NONE} : findings[0].code; }
    std::string text() const { return findings.empty() ? "" : findings[0].text; }
    std::string headline() const { return findings.empty() ? "" : with_code(findings[0]); }
    const Finding *find(uint32_t code) const;
    std::vector<std::string> texts(uint32_t severity) const;

    // Adds a finding, the first (or last) of its severity.
    void add_first(const Finding &finding);
    void add_last(const Finding &finding);
    void refuse(uint32_t code, const std::string &text) { add_first({code, LENSPROF_SEVERITY_REFUSAL, text}); }
};

// The findings that the library returns; of one lens setting.
Verdict verdict_of(const lensprof_fit *fit, uint32_t setting = LENSPROF_FIT_REFERENCE);
Verdict verdict_of(const lensprof_flat *flat);
Verdict verdict_of(const lensprof_fields *fields);
Verdict verdict_of(const lensprof_rendering *rendering, const lensprof_rendering_result &result);

// Replaces the numbers of images by their files.
void name_images(const std::vector<std::string> &names, Verdict &verdict);

// Replaces the numbers of shots by their first pictures, and names both of two shots that differ; `shots` has the shot
// per picture.
void name_shots(const std::vector<std::string> &names, const std::vector<uint32_t> &shots, Verdict &verdict);

// "passed", "note", "warning", "refusal".
const char *severity_name(uint32_t severity);

// Adds `findings` and `passed` to an object; docs/json.md describes them.
void add_verdict(const Verdict &verdict, nlohmann::ordered_json &json);

// The text of the first finding in what add_verdict wrote; empty without findings.
std::string first_text(const nlohmann::ordered_json &json);

// The warnings and notes, as notices about `source`.
void report_findings(const Verdict &verdict, const std::string &source, Events &events);

}  // namespace lensprof
