#include "fit/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>

#include "fit/methods/unconstrained.hpp"
#include "fit/scene/colours.hpp"
#include "fit/scene/matte.hpp"
#include "fit/scene/visits.hpp"
#include "fit/verdict/judge.hpp"
#include "fit/verdict/limits.hpp"

namespace lensprof {
namespace {

// Exposures and white balances, with the typical response of the kind of camera and no falloff where these are free:
// the baseline without knowledge of the camera. All images are of one setting and camera.
class Baseline {
public:
    Baseline(const FitCall &call, const lensprof_exposure *before) : fit(call, before) {
        FitCall &of = *fit.call;
        if (of.options.free & LENSPROF_FREE_RESPONSE) {
            if (lensprof_response_set_typical(&of.held, of.options.camera_kind, nullptr, &gamma_sigma_) != LENSPROF_OK)
                throw std::invalid_argument("unknown kind of camera");
            of.options.response = &of.held;
        }
        if (of.options.free & LENSPROF_FREE_FALLOFF) of.options.vignetting = lensprof_vignetting{};
        of.options.profile = nullptr;
        of.options.free = 0;
        for (lensprof_fit_image &image : of.images) image.setting = image.camera = 0;
        of.make_room();
    }

    // The result, with the error of the typical response and the findings on the pairs and images.
    SceneFit result() && {
        FitResult &r = fit.call->result;
        if (gamma_sigma_ > 0.0) state_typical(gamma_sigma_, fit.call->count(), fit.exposures.data(), r);
        remove_findings(r.verdict, [](const lensprof_finding &finding) { return !is_of_data(finding.code); });
        report_first(r, found_by_method(LENSPROF_REASON_EXPOSURES_ONLY, {}));
        r.model = LENSPROF_FIT_MODEL_EXPOSURES;
        return std::move(fit);
    }

    SceneFit fit;

private:
    static bool is_of_data(uint32_t code) {
        switch (code) {
        case LENSPROF_REASON_IMAGE_GROUPS:
        case LENSPROF_REASON_FEW_PAIRS:
        case LENSPROF_REASON_FEW_INLIERS:
        case LENSPROF_REASON_IMAGE_DISAGREES:
        case LENSPROF_REASON_IMAGE_INCONSISTENT:
        case LENSPROF_REASON_IMAGES_LEFT_OUT:
        case LENSPROF_REASON_IMAGES_UNCONNECTED:
        case LENSPROF_REASON_LINKS_CONTRADICT:
        case LENSPROF_REASON_LINKS_UNVERIFIED:
        case LENSPROF_REASON_NOT_CONVERGED:
        case LENSPROF_REASON_EXPOSURE_UNCERTAIN: return true;
        default: return false;
        }
    }

    double gamma_sigma_ = 0.0;
};

// Whether held-out pairs differ less with response and falloff, by the median residual, which glossy objects affect
// less than the mean.
bool is_better(const FitResult &full, const FitResult &only) {
    return full.heldout_median == LENSPROF_UNKNOWN || only.heldout_median == LENSPROF_UNKNOWN
           || full.heldout_median < only.heldout_median;
}

void set_equalizes(bool equalizes, FitCall &call) {
    call.result.equalizes = equalizes;
    for (CameraResult &camera : call.cameras)
        if (camera.joint.images) camera.equalizes = equalizes;
}

// Whether colours agree after the correction. With false matches they differ more than before regardless of it.
bool agree_in_colour(const FitResult &r) {
    const bool is_determined = r.converged && r.colour_variance != LENSPROF_UNKNOWN
                               && !has_code(r.verdict, LENSPROF_REASON_FEW_PAIRS)
                               && !has_code(r.verdict, LENSPROF_REASON_IMAGE_GROUPS);
    return is_determined && r.colour_variance < r.colour_variance_before
           && (r.colour_variance < kMuchLessColour * r.colour_variance_before || r.colour_variance < kGlossy);
}

double known_or_unknown(double variance) { return std::isnan(variance) ? LENSPROF_UNKNOWN : variance; }

// Measures all on the same pairs: those whose images all of them have.
void keep_common(std::initializer_list<std::vector<double> *> all) {
    for (size_t p = 0; p < (*all.begin())->size(); p++)
        if (std::any_of(all.begin(), all.end(), [=](const auto *of) { return std::isnan((*of)[p]); }))
            for (std::vector<double> *of : all) (*of)[p] = NAN;
}

// Refuses images of two visits, of which each is a component.
void judge_visits(const Visits &visits, const lensprof_exposure *exposures, FitCall &call) {
    if (visits.second.empty()) return;
    const auto is_second = [&](uint32_t image) {
        return std::binary_search(visits.second.begin(), visits.second.end(), image);
    };
    uint32_t first = call.count();  // image of the larger group
    for (uint32_t i = call.count(); i-- > 0;)
        if (!is_second(i) && !std::isnan(exposures[i].ev)) first = i;
    for (uint32_t i = 0; i < call.count(); i++)
        if (is_second(i))
            call.quality[i].component = visits.second[0];
        else if (!std::isnan(exposures[i].ev))
            call.quality[i].component = first;
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
    SceneFit best(call, exposures);
    Baseline only(call, exposures);
    best.call->take(std::move(call));
    const bool has_baseline = fit(*only.fit.call, data.pairs, only.fit.exposures.data());
    std::vector<double> before = colour_differences(data.pairs.data(), data.pairs.size(), call.channels(), nullptr),
                        baseline = has_baseline ? only.fit.differences(data) : before, differences;
    bool has_lens = !has_baseline || is_better(best.call->result, only.fit.call->result);
    SceneData fitted = data;
    if (has_lens) {
        leave_out_glossy_points(fit, fitted, best);
        differences = best.differences(data);
        std::vector<double> with_lens = differences, without = baseline;
        keep_common({&with_lens, &without});
        has_lens = !has_baseline || colour_variance(with_lens) < colour_variance(without);
    }
    if (has_lens)
        add_errors_by_halves(fitted, fit, best);
    else
        best = std::move(only).result(), differences = baseline;
    std::vector<double> all_differences = differences;
    compare_unknown_exposures(data.pairs, call.channels(), ColourCorrection(*best.call, best.exposures.data()),
                              all_differences);
    keep_common({&differences, &baseline, &before});
    call.take(std::move(*best.call));
    std::copy(best.exposures.begin(), best.exposures.end(), exposures);
    FitResult &r = call.result;
    r.colour_variance_before = known_or_unknown(colour_variance(before));
    r.colour_variance_exposures_only = has_baseline ? known_or_unknown(colour_variance(baseline)) : LENSPROF_UNKNOWN;
    r.colour_variance = known_or_unknown(colour_variance(differences));
    set_equalizes(agree_in_colour(r), call);
    judge_visits(find_visits(call.count(), data, all_differences), exposures, call);
}

}  // namespace lensprof
