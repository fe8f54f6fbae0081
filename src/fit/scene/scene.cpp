#include "fit/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fit/scene/colours.hpp"
#include "fit/scene/matte.hpp"
#include "fit/scene/visits.hpp"
#include "fit/verdict/judge.hpp"
#include "fit/verdict/limits.hpp"

namespace lensprof {
namespace {

// Exposures and white balances with the typical response of the kind of camera and no falloff: the baseline without
// knowledge of the camera. All images are of one setting and camera.
SceneFit exposures_only(const FitCall &call, const lensprof_exposure *before) {
    SceneFit only(call, before);
    FitCall &of = *only.call;
    if (lensprof_response_set_typical(&of.held, of.options.camera_kind, nullptr, nullptr) != LENSPROF_OK)
        throw std::invalid_argument("unknown kind of camera");
    of.options.response = &of.held;
    of.options.vignetting = lensprof_vignetting{};
    of.options.profile = nullptr;
    of.options.free = 0;
    for (lensprof_fit_image &image : of.images) image.setting = image.camera = 0;
    of.make_room();
    return only;
}

// Whether held-out pairs differ less with response and falloff, by the median residual, which glossy objects affect
// less than the mean.
bool is_better(const FitResult &full, const FitResult &only) {
    return full.heldout_median == LENSPROF_UNKNOWN || only.heldout_median == LENSPROF_UNKNOWN
           || full.heldout_median < only.heldout_median;
}

// Exposures alone as the result, with the findings on which images take part.
void refuse_lens(FitResult &r) {
    remove_findings(r.verdict, [](const lensprof_finding &finding) {
        switch (finding.code) {
        case LENSPROF_REASON_IMAGES_LEFT_OUT:
        case LENSPROF_REASON_IMAGES_UNCONNECTED:
        case LENSPROF_REASON_LINKS_CONTRADICT:
        case LENSPROF_REASON_LINKS_UNVERIFIED: return false;
        default: return true;
        }
    });
    report_first(r, found_by_method(LENSPROF_REASON_EXPOSURES_ONLY, {}));
    r.model = LENSPROF_FIT_MODEL_EXPOSURES;
}

void set_equalizes(bool equalizes, FitCall &call) {
    call.result.equalizes = equalizes;
    if (!call.cameras.empty()) call.cameras[call.images[call.result.reference].camera].equalizes = equalizes;
}

// Refuses images of two visits, of which each is a component.
void judge_visits(const Visits &visits, FitCall &call) {
    if (visits.second.empty()) return;
    const auto is_second = [&](uint32_t image) {
        return std::binary_search(visits.second.begin(), visits.second.end(), image);
    };
    uint32_t first = 0;  // image of the larger group
    while (is_second(first)) first++;
    for (uint32_t i = 0; i < call.count(); i++) call.quality[i].component = is_second(i) ? visits.second[0] : first;
    const auto count = static_cast<double>(visits.second.size());
    const Measured measured = of_image(of_values(visits.ratio, count, visits.ratio), visits.second[0]);
    const lensprof_finding finding =
        finding_of(LENSPROF_REASON_IMAGE_GROUPS, LENSPROF_SEVERITY_REFUSAL, measured, kVisitRatio, Wording::light);
    for_each_verdict(call.result, [&](auto &verdict) { report_first(verdict, finding); });
    set_equalizes(false, call);
}

}  // namespace

SceneFit::SceneFit(const FitCall &like, const lensprof_exposure *before)
    : call(std::make_unique<FitCall>()), exposures(before, before + like.count()) {
    call->options = like.options;
    call->images = like.images;
    call->make_room();
}

uint32_t SceneFit::joined() const {
    return static_cast<uint32_t>(std::count_if(exposures.begin(), exposures.end(),
                                               [](const lensprof_exposure &e) { return !std::isnan(e.ev); }));
}

std::vector<double> SceneFit::differences(const SceneData &data) const {
    const ColourCorrection correction(*call, exposures.data());
    return colour_differences(data.pairs.data(), data.pairs.size(), call->channels(), &correction);
}

void fit_scene(const SceneData &data, const FitPairs &fit, FitCall &call, lensprof_exposure *exposures) {
    if (!call.options.free) return;
    const int channels = call.channels();
    SceneFit best(call, exposures), only = exposures_only(call, exposures);
    best.call->take(std::move(call));
    const bool has_baseline = fit(*only.call, data.pairs, only.exposures.data());
    const double before = colour_variance(colour_differences(data.pairs.data(), data.pairs.size(), channels, nullptr)),
                 baseline = has_baseline ? colour_variance(only.differences(data)) : HUGE_VAL;
    bool has_lens = !has_baseline || is_better(best.call->result, only.call->result);
    SceneData fitted = data;
    if (has_lens) {
        leave_out_glossy_points(fit, fitted, best);
        has_lens = colour_variance(best.differences(data)) < baseline;
    }
    if (has_lens)
        add_errors_by_halves(fitted, fit, best);
    else
        best = std::move(only), refuse_lens(best.call->result);
    const std::vector<double> differences = best.differences(data);
    call.take(std::move(*best.call));
    std::copy(best.exposures.begin(), best.exposures.end(), exposures);
    FitResult &r = call.result;
    r.colour_variance_before = before;
    r.colour_variance_exposures_only = has_baseline ? baseline : LENSPROF_UNKNOWN;
    r.colour_variance = colour_variance(differences);
    // With false matches, colours differ more than before regardless of the correction.
    set_equalizes(
        r.colour_variance < before && (r.colour_variance < kMuchLessColour * before || r.colour_variance < kGlossy),
        call);
    judge_visits(find_visits(call.count(), data, differences), call);
}

}  // namespace lensprof
