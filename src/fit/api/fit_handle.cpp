#include "fit/api/fit_handle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <memory>

#include "core/profile.h"
#include "fit/api/fit_checks.hpp"
#include "fit/api/fit_methods.hpp"
#include "fit/api/held.hpp"
#include "fit/api/profile.hpp"
#include "fit/methods/overlap.hpp"
#include "fit/scene/colours.hpp"
#include "fit/verdict/output.hpp"
#include "fit/verdict/rules.hpp"

namespace lensprof {
namespace {

constexpr size_t kFindingsMax = kRuleCount + kMethodRuleCount;  // of one setting

// Numbers of the parts.
struct Counts {
    size_t images, settings = 1, cameras = 1;

    explicit Counts(const std::vector<lensprof_fit_image> &all) : images(all.size()) {
        for (const lensprof_fit_image &image : all) {
            settings = std::max<size_t>(settings, image.setting + size_t{1});
            cameras = std::max<size_t>(cameras, image.camera + size_t{1});
        }
    }
};

// The findings on one setting.
const Findings &findings_of(const FitCall &call, uint32_t setting) {
    return call.settings.empty() ? call.result.verdict : call.settings[setting].verdict;
}

// The result for one setting: of the reference's, with the parts of the setting and its camera.
lensprof_fit_result result_of(const FitCall &call, uint32_t setting, const Counts &counts) {
    FitResult result = call.result;
    result.setting_count = static_cast<uint32_t>(counts.settings);
    result.camera_count = static_cast<uint32_t>(counts.cameras);
    if (call.settings.empty()) {
        result.images = call.count() - std::min(result.left_out, call.count());
        result.setting_pairs = result.pairs;
        return result;
    }
    const auto image = std::find_if(call.images.begin(), call.images.end(),
                                    [=](const lensprof_fit_image &i) { return i.setting == setting; });
    if (image == call.images.end() || !call.settings[setting].images) {
        FitResult none = empty_result();
        none.setting_count = result.setting_count, none.camera_count = result.camera_count;
        return none;
    }
    result.camera = image->camera;
    const uint32_t reference = result.reference;
    if (!call.cameras.empty()) copy_camera(call.cameras[image->camera], result);
    result.reference = reference;
    copy_setting(call.settings[setting], result);
    result.images = call.settings[setting].images;
    result.setting_pairs = call.settings[setting].pairs;
    return result;
}

lensprof_fit_camera camera_of(const FitCall &call, uint32_t camera) {
    lensprof_fit_camera found;
    lensprof_fit_camera_init(&found);
    if (call.cameras.empty()) {
        found.images = call.count() - std::min(call.result.left_out, call.count());
        found.joined = 1;
        found.reference = call.result.reference;
        found.setting = call.images[found.reference].setting;
        return found;
    }
    const uint32_t size = found.struct_size;
    found = call.cameras[camera].joint;
    found.struct_size = size;
    return found;
}

// ARGUMENT for NULL, a released fit and a number out of range.
lensprof_status check_fit(const lensprof_fit *fit, const void *result, uint32_t number, uint32_t count,
                          const char *part, lensprof_error *error) {
    return check_part(fit, result, kHeld, "fit", number, count, part, error);
}

uint32_t setting_of(const lensprof_fit *fit, uint32_t setting) {
    return fit && setting == LENSPROF_FIT_REFERENCE ? fit->reference_setting : setting;
}

// Sum of counts; saturates instead of overflowing.
uint32_t sum_of(uint32_t a, uint32_t b) { return a + std::min(b, UINT32_MAX - a); }

void put_fit(const lensprof_fit &fit, uint32_t setting, lensprof_profile &target) {
    const lensprof_fit_result &result = fit.results[setting];
    put_result(result, name_of_method(fit.method), result.images, target);
    target.responses = 1;
    target.response[0] = result.response;
    lensprof_gain_grid_init(&target.grid);
    lensprof_provenance &provenance = target.provenance;
    provenance.pairs = result.setting_pairs;
    provenance.heldout_rms = result.heldout_rms;
    provenance.gamma_sigma = std::max(result.gamma_sigma, 0.0);
    const bool is_shown = result.response_from != LENSPROF_FIT_RESPONSE_KIND;
    std::snprintf(provenance.doubt, sizeof provenance.doubt, "%s", is_shown ? "" : LENSPROF_DOUBT_RESPONSE);
    if (setting != fit.reference_setting) return;
    provenance.images = sum_of(result.images, fit.prior_images);
    provenance.pairs = sum_of(result.setting_pairs, fit.prior_pairs);
}

// ARGUMENT without pairs; checks the pairs.
lensprof_status check_given(const lensprof_fit *fit, const lensprof_pair *pairs, uint32_t pair_count,
                            const void *target, lensprof_error *error) {
    const lensprof_status status = check_fit(fit, target, 0, 1, "", error);
    if (status != LENSPROF_OK) return status;
    if (!pairs || !pair_count) return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: there are no pairs");
    return check_pairs(pairs, pair_count, fit->images, fit->image_count, static_cast<int>(fit->channels), error);
}

// What a fit corrects its images with; an empty setting, as the reference.
ColourCorrection correction_of(const lensprof_fit &fit) {
    ColourCorrection correction;
    correction.images = fit.images, correction.exposures = fit.exposures;
    correction.reference = fit.results[fit.reference_setting].reference;
    for (uint32_t i = 0; i < fit.image_count; i++) {
        const lensprof_fit_result &own = fit.results[fit.images[i].setting],
                                  &result = own.images ? own : fit.results[fit.reference_setting];
        correction.responses.push_back(&result.response), correction.falloffs.push_back(result.vignetting);
    }
    return correction;
}

// Residuals of pairs whose images belong to one camera, which must hold for all.
std::vector<double> levels_of(const lensprof_fit &fit, const lensprof_pair *pairs, uint32_t pair_count) {
    const std::vector<lensprof_fit_image> images(fit.images, fit.images + fit.image_count);
    std::vector<Falloffs> falloffs;
    for (uint32_t s = 0; s < fit.setting_count; s++) {
        const lensprof_vignetting *curves = fit.results[s].vignetting;
        falloffs.push_back({curves[0], curves[1], curves[2]});
    }
    std::vector<double> all;
    for (uint32_t camera = 0; camera < fit.camera_count; camera++) {
        std::vector<lensprof_pair> own;
        std::copy_if(pairs, pairs + pair_count, std::back_inserter(own),
                     [&](const lensprof_pair &pair) { return images[pair.image[0]].camera == camera; });
        if (own.empty()) continue;
        const lensprof_response &response = fit.results[fit.cameras[camera].setting].response;
        const auto levels =
            transfer_levels(response, falloffs, images, fit.exposures, own, static_cast<int>(fit.channels));
        all.insert(all.end(), levels.begin(), levels.end());
    }
    return all;
}

}  // namespace

size_t fit_bytes(const std::vector<lensprof_fit_image> &images) {
    const Counts counts(images);
    return sizeof(lensprof_fit)
           + counts.settings * (sizeof(lensprof_fit_result) + kFindingsMax * sizeof(lensprof_finding))
           + counts.cameras * sizeof(lensprof_fit_camera)
           + counts.images
                 * (sizeof(lensprof_fit_image_quality) + sizeof(lensprof_fit_image) + sizeof(lensprof_exposure));
}

lensprof_fit *make_fit(const FitCall &call, const lensprof_exposure *exposures, void *memory, bool is_own) {
    const Counts counts(call.images);
    auto *block = static_cast<char *>(memory);
    lensprof_fit &fit = *take_block<lensprof_fit>(block, 1);
    fit = {};
    fit.is_own_memory = is_own;
    fit.image_count = call.count();
    fit.setting_count = static_cast<uint32_t>(counts.settings);
    fit.camera_count = static_cast<uint32_t>(counts.cameras);
    fit.reference_setting = call.images[call.result.reference].setting;
    fit.method = call.options.method, fit.channels = call.options.channels;
    const uint32_t prior = call.result.profile_prior;
    if (call.options.profile && prior != LENSPROF_PROFILE_PRIOR_NONE && prior != LENSPROF_PROFILE_PRIOR_OVERRULED) {
        fit.prior_images = call.options.profile->provenance.images;
        fit.prior_pairs = call.options.profile->provenance.pairs;
    }
    fit.results = take_block<lensprof_fit_result>(block, counts.settings);
    fit.findings = take_block<lensprof_finding>(block, counts.settings * kFindingsMax);
    fit.cameras = take_block<lensprof_fit_camera>(block, counts.cameras);
    fit.quality = take_block<lensprof_fit_image_quality>(block, counts.images);
    fit.images = take_block<lensprof_fit_image>(block, counts.images);
    fit.exposures = take_block<lensprof_exposure>(block, counts.images);
    for (uint32_t s = 0; s < counts.settings; s++) {
        fit.results[s] = result_of(call, s, counts);
        const Findings none, &found = fit.results[s].images ? findings_of(call, s) : none;
        hold_findings(found, kFindingsMax, fit.findings + s * kFindingsMax, fit.results[s]);
    }
    for (uint32_t k = 0; k < counts.cameras; k++) fit.cameras[k] = camera_of(call, k);
    for (uint32_t i = 0; i < counts.images; i++) {
        fit.quality[i] = call.quality[i];
        fit.quality[i].struct_size = sizeof fit.quality[i];
    }
    std::copy(call.images.begin(), call.images.end(), fit.images);
    std::copy_n(exposures, counts.images, fit.exposures);
    fit.mark = kHeld;
    return &fit;
}

}  // namespace lensprof

using namespace lensprof;

extern "C" {

size_t lensprof_fit_bytes(const lensprof_fit_image *images, uint32_t image_count) {
    try {
        std::vector<lensprof_fit_image> taken;
        const bool is_valid = images && image_count && take_images(images, image_count, taken, nullptr) == LENSPROF_OK;
        return is_valid ? fit_bytes(taken) : 0;
    } catch (const std::exception &) {
        return 0;
    }
}

void lensprof_fit_destroy(lensprof_fit *fit) {
    if (!fit || fit->mark != kHeld) return;
    fit->mark = 0;
    if (fit->is_own_memory) ::operator delete(fit);
}

lensprof_status lensprof_fit_image_at(const lensprof_fit *fit, uint32_t index, lensprof_fit_image_quality *quality,
                                      lensprof_error *error) {
    const lensprof_status status = check_fit(fit, quality, index, fit ? fit->image_count : 0, "image", error);
    return status == LENSPROF_OK ? give(fit->quality[index], quality,
                                        LP_END_OF(lensprof_fit_image_quality, known_ev_left_out), "fit", error)
                                 : status;
}

lensprof_status lensprof_fit_setting_at(const lensprof_fit *fit, uint32_t setting, lensprof_fit_result *result,
                                        lensprof_error *error) {
    const uint32_t number = setting_of(fit, setting);
    const lensprof_status status = check_fit(fit, result, number, fit ? fit->setting_count : 0, "setting", error);
    return status == LENSPROF_OK
               ? give(fit->results[number], result, LP_END_OF(lensprof_fit_result, seconds), "fit", error)
               : status;
}

lensprof_status lensprof_fit_camera_at(const lensprof_fit *fit, uint32_t camera, lensprof_fit_camera *result,
                                       lensprof_error *error) {
    const lensprof_status status = check_fit(fit, result, camera, fit ? fit->camera_count : 0, "camera", error);
    return status == LENSPROF_OK
               ? give(fit->cameras[camera], result, LP_END_OF(lensprof_fit_camera, reserved), "fit", error)
               : status;
}

lensprof_status lensprof_fit_finding_at(const lensprof_fit *fit, uint32_t setting, uint32_t index,
                                        lensprof_finding *finding, lensprof_error *error) {
    const uint32_t number = setting_of(fit, setting);
    const lensprof_status status = check_fit(fit, finding, number, fit ? fit->setting_count : 0, "setting", error);
    if (status != LENSPROF_OK) return status;
    return give_finding(fit->findings + size_t{number} * kFindingsMax, fit->results[number], index, finding, "fit",
                        error);
}

lensprof_status lensprof_fit_profile(const lensprof_fit *fit, uint32_t setting, lensprof_profile *profile,
                                     lensprof_error *error) {
    const uint32_t number = setting_of(fit, setting);
    const lensprof_status status = check_fit(fit, profile, number, fit ? fit->setting_count : 0, "setting", error);
    if (status != LENSPROF_OK) return status;
    if (!fit->results[number].images)
        return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: setting %u has no image in it; choose one with images",
                    number);
    return change_given_profile(
        profile, [&](lensprof_profile &target) { put_fit(*fit, number, target); }, error);
}

lensprof_status lensprof_fit_transfer_rms(const lensprof_fit *fit, const lensprof_pair *pairs, uint32_t pair_count,
                                          double *rms, double *median, lensprof_error *error) {
    lensprof_status status = check_given(fit, pairs, pair_count, rms, error);
    for (uint32_t p = 0; p < pair_count && status == LENSPROF_OK; p++)
        for (const uint32_t image : pairs[p].image)
            if (std::isnan(fit->exposures[image].ev))
                return fail_at(LENSPROF_ITEM_IMAGE, image, LENSPROF_ERROR_ARGUMENT, error,
                               "was left out of the fit; leave its pairs out");
    for (uint32_t p = 0; p < pair_count && status == LENSPROF_OK; p++)
        if (fit->images[pairs[p].image[0]].camera != fit->images[pairs[p].image[1]].camera)
            return fail(LENSPROF_ERROR_ARGUMENT, error, "fit: pair %u connects two cameras; give those of one each", p);
    if (status != LENSPROF_OK) return status;
    try {
        const Summary summary = summarise(levels_of(*fit, pairs, pair_count));
        *rms = summary.rms;
        if (median) *median = summary.median;
        return LENSPROF_OK;
    } catch (const std::exception &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "fit: out of memory");
    }
}

lensprof_status lensprof_fit_colour_differences(const lensprof_fit *fit, const lensprof_pair *pairs,
                                                uint32_t pair_count, double *differences, lensprof_error *error) {
    const lensprof_status status = check_given(fit, pairs, pair_count, differences, error);
    if (status != LENSPROF_OK) return status;
    try {
        const ColourCorrection correction = correction_of(*fit);
        const auto found = colour_differences(pairs, pair_count, static_cast<int>(fit->channels), &correction);
        std::copy(found.begin(), found.end(), differences);
        return LENSPROF_OK;
    } catch (const std::exception &) {
        return fail(LENSPROF_ERROR_MEMORY, error, "fit: out of memory");
    }
}

}  // extern "C"
