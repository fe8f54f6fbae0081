// What the verdict on fields measures.
#include <algorithm>
#include <cmath>

#include "fit/fields/rules.hpp"

namespace lensprof {
namespace {

// The largest of the channels in some respect.
template <class Of>
double worst_of(const lensprof_fields_result &r, Of of) {
    double worst = 0.0;
    for (uint32_t c = 0; c < r.channels; c++) worst = std::max(worst, of(r.channel[c]));
    return worst;
}

// The first picture that satisfies is_one.
template <class Is>
Measured of_first(const JudgedFields &judged, double count, Is is_one) {
    const auto &pictures = judged.fit.pictures;
    const auto first = std::find_if(pictures.begin(), pictures.end(), is_one);
    if (first == pictures.end()) return of_value(count);
    return of_image(of_value(count), static_cast<uint32_t>(first - pictures.begin()));
}

}  // namespace

namespace measure {

Measured fields_that_differ(const JudgedFields &judged) {
    return of_values(judged.r.used, judged.r.used, fields_limits::kFew);
}

Measured fields_repeated(const JudgedFields &judged) {
    const auto &pictures = judged.fit.pictures;
    return of_first(judged, judged.r.repeated,
                    [&](const FieldPicture &picture) { return &pictures[picture.same_as] != &picture; });
}

Measured fields_pattern(const JudgedFields &judged) {
    return of_value(worst_of(judged.r, [](const auto &channel) { return channel.pattern; }));
}

// A pattern of some size that the pictures share more than they differ.
Measured fields_scene(const JudgedFields &judged) {
    const Measured pattern = fields_pattern(judged);
    const double share = worst_of(judged.r, [](const auto &channel) { return channel.pattern_share; });
    return of_values(pattern.value > fields_limits::kSceneDetail ? share : 0.0, pattern.value, share);
}

Measured fields_error(const JudgedFields &judged) {
    return of_value(worst_of(judged.r, [](const auto &channel) { return channel.shading_error; }));
}

Measured fields_offset(const JudgedFields &judged) {
    if (judged.fit.options.given_offset || !is_linear(judged.fit)) return {};
    return {worst_of(judged.r, [](const auto &channel) { return channel.offset_found ? 0.0 : 1.0; }), 0, {}};
}

Measured fields_white(const JudgedFields &judged) { return of_value(judged.r.white_share); }

Measured fields_left_out(const JudgedFields &judged) { return of_value(judged.r.white); }

Measured fields_black(const JudgedFields &judged) { return of_value(judged.r.black); }

Measured fields_unseen(const JudgedFields &judged) { return of_value(judged.r.unseen_share); }

// How much worse an even frame predicts the pictures that were held out: least over the channels.
Measured fields_gain(const JudgedFields &judged) {
    double least = INFINITY;
    for (uint32_t c = 0; c < judged.r.channels; c++)
        least = std::min(least, judged.r.channel[c].even_rms / std::max(judged.r.channel[c].heldout_rms, 1e-12));
    return {least, 0, {}};
}

}  // namespace measure

void judge_fields(FieldsFit &fit) {
    JudgedFields judged{fit, fit.result};
    if (fit.result.shading.columns) judged.state = kIsFitted;
    if (measure::fields_offset(judged).value > 0.0) judged.state |= kHasOpenOffset;
    fit.verdict.clear();
    apply_rules(kFieldsRules, judged, fit.verdict);
    fit.result.usable = is_usable(fit.verdict);
    fit.result.findings = count_findings(fit.verdict), fit.result.passed = count_passed(fit.verdict);
}

}  // namespace lensprof
