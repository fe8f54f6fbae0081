// The verdict on the response of a rendering: all rules, the most important first within a severity. `limits.hpp`
// states where a limit comes from.
#pragma once

#include "fit/rendering/limits.hpp"
#include "fit/rendering/rendering.hpp"
#include "fit/verdict/rule.hpp"

namespace lensprof {

struct JudgedRendering {
    const RenderingFit &fit;
    uint32_t state = 0;
    Wording wording = Wording::rendering;
};

using RenderingRule = VerdictRule<JudgedRendering>;

namespace measure {

Measured tenths(const JudgedRendering &judged);
Measured area_noise(const JudgedRendering &judged);
Measured tone_map(const JudgedRendering &judged);
Measured gamma_sigma(const JudgedRendering &judged);
Measured missing_ends(const JudgedRendering &judged);

}  // namespace measure

// clang-format off
constexpr RenderingRule kRenderingRules[] = {
    {LENSPROF_REASON_FEW_GREYS,     kRefuses, 0, measure::tenths,       Side::below, rendering_limits::kFewestTenths,      Wording::usual},
    {LENSPROF_REASON_SCATTER,       kRefuses, 0, measure::area_noise,   Side::above, rendering_limits::kLargestNoise,      Wording::usual},
    {LENSPROF_REASON_PATTERNS,      kRefuses, 0, measure::tone_map,     Side::above, rendering_limits::kStrongMap,         Wording::usual},
    {LENSPROF_REASON_UNDETERMINED,  kRefuses, 0, measure::gamma_sigma,  Side::above, rendering_limits::kLargestGammaSigma, Wording::usual},
    {LENSPROF_REASON_PATTERNS,      kWarns,   0, measure::tone_map,     Side::above, rendering_limits::kWeakMap,           Wording::map},
    {LENSPROF_REASON_MISSING_GREYS, kNotes,   0, measure::missing_ends, Side::above, rendering_limits::kMissingGreys,      Wording::usual},
};
// clang-format on
constexpr size_t kRenderingRuleCount = sizeof kRenderingRules / sizeof *kRenderingRules;

}  // namespace lensprof
