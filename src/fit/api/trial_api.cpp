// The C interface of the trial of profiles: argument checks, and conversion of exceptions to status codes.
#include <vector>

#include "fit/api/boundary.hpp"
#include "fit/api/fit_call.hpp"
#include "fit/api/fit_checks.hpp"
#include "fit/trial/trial.hpp"

using namespace lensprof;

namespace {

constexpr size_t kFirstTrialOptions = LP_END_OF(lensprof_trial_options, reserved);
constexpr size_t kFirstCandidate = LP_END_OF(lensprof_trial_candidate, below_none_sigma);
constexpr size_t kFirstTrialResult = LP_END_OF(lensprof_trial_result, before_rms);

lensprof_status take_options(const lensprof_trial_options *given, TrialInput &input, lensprof_error *error) {
    lensprof_trial_options options;
    lensprof_trial_options_init(&options);
    if (const char *wrong = given ? lp_sized_take(&options, given, kFirstTrialOptions) : nullptr)
        return fail(LENSPROF_ERROR_STRUCT_SIZE, error, "trial options: %s", wrong);
    const lensprof_status status = lensprof_response_set_typical(&input.typical, options.camera_kind, nullptr, nullptr);
    const Rule rules[] = {
        {options.channels == 1 || options.channels == 3, "channels must be 1 or 3"},
        {status == LENSPROF_OK, "camera_kind must be one of lensprof_camera_kind, 0..5"},
        {!options.reserved, "reserved must be 0"},
    };
    if (const char *wrong = first_broken(rules))
        return fail(LENSPROF_ERROR_ARGUMENT, error, "trial options: %s", wrong);
    input.channels = options.channels, input.camera_kind = options.camera_kind;
    return LENSPROF_OK;
}

lensprof_status check_profiles(const std::vector<const lensprof_profile *> &profiles, lensprof_error *error) {
    for (uint32_t i = 0; i < profiles.size(); i++) {
        if (!profiles[i])
            return fail_at(LENSPROF_ITEM_PROFILE, i, LENSPROF_ERROR_ARGUMENT, error, "its pointer is NULL");
        const lensprof_status status = lensprof_profile_validate(profiles[i]);
        if (status != LENSPROF_OK)
            return fail_at(LENSPROF_ITEM_PROFILE, i, status, error, "it is invalid; see lensprof_profile_validate");
    }
    return LENSPROF_OK;
}

lensprof_status check_targets(const lensprof_trial_candidate *candidates, size_t count,
                              const lensprof_trial_result *result, lensprof_error *error) {
    const char *wrong = lp_sized_wrong(result, kFirstTrialResult, sizeof *result);
    for (size_t i = 0; i < count && !wrong; i++) {
        wrong = lp_sized_wrong(lp_sized_at(candidates, i), kFirstCandidate, sizeof *candidates);
        if (!wrong && !lp_sized_is_alike(candidates, i)) wrong = "the candidates differ in struct_size";
    }
    return wrong ? fail(LENSPROF_ERROR_STRUCT_SIZE, error, "trial: %s", wrong) : LENSPROF_OK;
}

}  // namespace

extern "C" {

void lensprof_trial_options_init_sized(lensprof_trial_options *options, size_t size) {
    if (lp_sized_begin(options, size, kFirstTrialOptions)) options->channels = 3;
}

lensprof_status lensprof_trial_run(const lensprof_trial_options *options, const lensprof_fit_image *images,
                                   uint32_t image_count, const lensprof_pair *pairs, uint32_t pair_count,
                                   const lensprof_profile *const *profiles, uint32_t profile_count,
                                   lensprof_trial_candidate *candidates, lensprof_trial_result *result,
                                   lensprof_error *error) {
    return at_boundary("trial", error, [&] {
        clear(error);
        if (!images || (!pairs && pair_count) || !profiles || !candidates || !result)
            return fail(LENSPROF_ERROR_ARGUMENT, error, "trial: a pointer is NULL");
        if (!profile_count) return fail(LENSPROF_ERROR_ARGUMENT, error, "trial: at least one profile is needed");
        TrialInput input;
        input.profiles.assign(profiles, profiles + profile_count);
        lensprof_status status = take_options(options, input, error);
        if (status == LENSPROF_OK) status = check_targets(candidates, input.profiles.size() + 1, result, error);
        if (status == LENSPROF_OK) status = take_images(images, image_count, input.images, error);
        if (status == LENSPROF_OK)
            status = check_pairs(pairs, pair_count, input.images.data(), image_count, static_cast<int>(input.channels),
                                 error);
        if (status == LENSPROF_OK) status = check_profiles(input.profiles, error);
        if (status != LENSPROF_OK) return status;
        input.pairs.assign(pairs, pairs + pair_count);
        Trial trial;
        status = try_profiles(input, trial, error);
        if (status != LENSPROF_OK) return status;
        for (size_t i = 0; i < trial.candidates.size(); i++)
            lp_sized_copy(const_cast<void *>(lp_sized_at(candidates, i)), &trial.candidates[i]);
        lp_sized_copy(result, &trial.result);
        return LENSPROF_OK;
    });
}

}  // extern "C"
