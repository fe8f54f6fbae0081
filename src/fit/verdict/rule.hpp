// A rule of a verdict, and how a table of them is applied.
#pragma once

#include "fit/verdict/finding.hpp"

namespace lensprof {

enum class Side {
    above,
    below
};

// Of the rows of a table.
constexpr lensprof_severity kRefuses = LENSPROF_SEVERITY_REFUSAL, kWarns = LENSPROF_SEVERITY_WARNING,
                            kNotes = LENSPROF_SEVERITY_NOTE;

// What is found if the measure is above (or below) the limit. `Subject` is what is judged; its `state` has the bits of
// all that is true of it.
template <class Subject>
struct VerdictRule {
    lensprof_reason code;
    lensprof_severity severity;
    uint32_t when;  // bits of the state that the rule needs
    Measured (*measure)(const Subject &);
    Side side;
    double limit;
    Wording wording;
};

// What a method finds by itself. The limit of its measure is NaN if more than one number decides.
struct MethodRule {
    lensprof_reason code;
    lensprof_severity severity;
    double limit;
};

template <class Subject>
lensprof_finding apply_rule(const VerdictRule<Subject> &rule, const Subject &subject, const Measured &measured) {
    const bool is_found = rule.side == Side::above ? measured.value > rule.limit : measured.value < rule.limit;
    if (!is_found) return passed_of(rule.code, rule.severity, measured.value, rule.limit);
    const Wording wording = rule.wording == Wording::usual ? subject.wording : rule.wording;
    return finding_of(rule.code, rule.severity, measured, rule.limit, wording);
}

// Adds what the rules find, in their order, and those that hold. Of several rules with one code, the first that finds
// something counts. With a `step`, only the rules that need this state apply.
template <class Subject, size_t count>
void apply_rules(const VerdictRule<Subject> (&rules)[count], const Subject &subject, Findings &findings,
                 uint32_t step = 0) {
    for (const VerdictRule<Subject> &rule : rules) {
        const bool applies = (subject.state & rule.when) == rule.when && (rule.when & step) == step;
        if (!applies || has_code(findings, rule.code)) continue;
        const Measured measured = rule.measure(subject);
        if (!std::isnan(measured.value)) add_last(findings, apply_rule(rule, subject, measured));
    }
}

}  // namespace lensprof
