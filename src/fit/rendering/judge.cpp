// What the verdict on a rendering measures.
#include <algorithm>

#include "fit/rendering/rules.hpp"

namespace lensprof {
namespace measure {

Measured tenths(const JudgedRendering &judged) { return of_value(judged.fit.result.tenths); }

Measured area_noise(const JudgedRendering &judged) {
    Measured worst = of_value(0.0);
    for (uint32_t i = 0; i < judged.fit.shots.size(); i++)
        if (judged.fit.shots[i].found.noise_levels > worst.value)
            worst = of_image(of_value(judged.fit.shots[i].found.noise_levels), i);
    return worst;
}

Measured tone_map(const JudgedRendering &judged) {
    const uint32_t number = judged.fit.most_patterned();
    const lensprof_rendering_shot &shot = judged.fit.shots[number].found;
    return of_image(of_values(shot.pattern_levels, shot.pattern_ev, shot.pattern_levels), number);
}

Measured gamma_sigma(const JudgedRendering &judged) { return of_value(judged.fit.result.gamma_sigma); }

// At the end where more are missing; the bright end is 256 levels.
Measured missing_ends(const JudgedRendering &judged) {
    const lensprof_rendering_result &r = judged.fit.result;
    return of_values(std::max(r.lowest, 256.0 / 255.0 - r.highest), r.lowest, r.highest);
}

}  // namespace measure

void judge_rendering(RenderingFit &fit) {
    fit.verdict.clear();
    apply_rules(kRenderingRules, JudgedRendering{fit}, fit.verdict);
    fit.result.usable = is_usable(fit.verdict);
}

}  // namespace lensprof
