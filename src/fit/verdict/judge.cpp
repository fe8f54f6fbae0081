#include "fit/verdict/judge.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "fit/verdict/rules.hpp"

namespace lensprof {
namespace {

// Verdicts on the profile that do not affect how even the pictures are.
bool is_of_profile(lensprof_reason code) {
    switch (code) {
    case LENSPROF_REASON_PATTERNS:
    case LENSPROF_REASON_FEW_GREYS:
    case LENSPROF_REASON_EXPOSURES_EQUAL:
    case LENSPROF_REASON_SMALL_RADIUS: return true;
    default: return false;
    }
}

}  // namespace

void judge(const Found &found, const std::function<void(FitResult &)> &judge_result, FitResult &r) {
    r.verdict.clear();
    Judged judged(found, r);
    apply_rules(kRules, judged, r.verdict);
    r.usable = is_usable(r.verdict);
    if (judge_result) judge_result(r);
    r.equalizes = 0;
    if (!r.usable && !is_of_profile(first_code(r.verdict))) return;
    judged.seam = judge_evenness(found, r);
    judged.state |= kHasSeams;
    if (r.usable) apply_rules(kRules, judged, r.verdict, kHasSeams);
}

lensprof_finding found_by_method(lensprof_reason code, const Measured &measured) {
    const auto *rule = std::find_if(std::begin(kMethodRules), std::end(kMethodRules),
                                    [=](const MethodRule &candidate) { return candidate.code == code; });
    if (rule == std::end(kMethodRules)) throw std::logic_error("no rule for this finding");
    return finding_of(code, rule->severity, measured, rule->limit);
}

}  // namespace lensprof
