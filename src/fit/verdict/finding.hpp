// Findings: what a result was checked for, as data and as a sentence made from it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <lensprof/reason.h>

namespace lensprof {

// Refusals first, then warnings, notes and rules that hold; within a severity, the most important first.
using Findings = std::vector<lensprof_finding>;

// Which sentence states a code, where one does not suit all.
enum class Wording {
    usual,
    still,       // pictures of a stationary camera
    held,        // of a response or falloff that is given
    weak,        // the milder of two severities
    light,       // groups by light
    odd,         // with a response unlike those of measured cameras, or a shot unlike the others
    less,        // below its limit, negative, or the milder form of `odd`
    card,        // of a card
    alone,       // a card without rotated shots, or with few
    grid,        // a card with a gain grid
    alone_grid,  // with a gain grid, but few rotated shots
    rendering,   // of a raw frame
    map          // a rendering whose tones may be mapped locally
};

constexpr size_t kTextValues = 5;

// What a rule measures: the number compared with its limit, the item that has it, and the values of the code.
struct Measured {
    double value = NAN;  // NaN: the rule does not apply
    size_t count = 0;    // of `values` that the code has; the text can use all of them
    std::array<double, kTextValues> values = {};
    lensprof_item_kind kind = LENSPROF_ITEM_NONE;
    uint32_t index = 0;
};

// A measure whose number is its only value.
inline Measured of_value(double value) { return {value, 1, {value}}; }
inline Measured of_values(double value, double first, double second) { return {value, 2, {first, second}}; }
inline Measured of_image(Measured measured, uint32_t index) {
    measured.kind = LENSPROF_ITEM_IMAGE, measured.index = index;
    return measured;
}
inline Measured of_shot(Measured measured, uint32_t number) {
    measured.kind = LENSPROF_ITEM_SHOT, measured.index = number;
    return measured;
}

// The finding of a rule, with its sentence; `limit` may be NaN.
lensprof_finding finding_of(lensprof_reason code, lensprof_severity severity, const Measured &measured,
                            double limit = NAN, Wording wording = Wording::usual);

// A rule that holds; `severity` is what it would find otherwise.
lensprof_finding passed_of(lensprof_reason code, lensprof_severity severity, double measured, double limit);

// Adds a finding before (or after) those of its severity.
void add_first(Findings &findings, const lensprof_finding &finding);
void add_last(Findings &findings, const lensprof_finding &finding);

// Removes what is_one(finding) selects.
template <class Is>
void remove_findings(Findings &findings, Is is_one) {
    findings.erase(std::remove_if(findings.begin(), findings.end(), is_one), findings.end());
}

// Gives the item another number, in the text as well.
void rename_item(uint32_t index, lensprof_finding &finding);

// The code of the most important finding; NONE if all rules hold.
lensprof_reason first_code(const Findings &findings);

// Number of findings, and of rules that hold.
uint32_t count_findings(const Findings &findings);
uint32_t count_passed(const Findings &findings);

bool is_usable(const Findings &findings);
bool has_code(const Findings &findings, lensprof_reason code);

}  // namespace lensprof
