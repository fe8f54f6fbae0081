#include "fit/trial/trial.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "fit/base/fail.hpp"
#include "fit/trial/residuals.hpp"
#include "fit/trial/rings.hpp"

namespace lensprof {
namespace {

// A profile, or none, and its residuals.
struct Candidate {
    const lensprof_profile *profile = nullptr;
    std::vector<lensprof_response> responses;
    TrialErrors errors;
    RingFalloff rings;
    lensprof_trial_candidate found;

    explicit Candidate(const lensprof_profile *of) : profile(of) {
        lensprof_trial_candidate_init(&found);
        found.response_from = LENSPROF_TRIAL_RESPONSE_KIND;
    }

    TrialModel with(const std::vector<lensprof_response> &curves) const {
        return {profile, curves.data(), static_cast<uint32_t>(curves.size())};
    }
    TrialErrors errors_with(const std::vector<lensprof_response> &curves, const TrialPairs &pairs) const {
        return try_model(pairs, with(curves));
    }
};

bool has_falloff(const lensprof_profile &profile) {
    const auto is_curved = [](const lensprof_vignetting &v) {
        return std::any_of(v.k, v.k + 3, [](double k) { return k != 0.0; });
    };
    return profile.grid.columns || std::any_of(profile.vignetting, profile.vignetting + profile.vignettings, is_curved);
}

// For rendered pictures only the falloff of a raw profile applies.
bool has_response(const lensprof_profile &profile) {
    return profile.key.processing != LENSPROF_PROCESSING_RAW || profile.response[0].kind != LENSPROF_RESPONSE_LINEAR;
}

bool is_linear(const lensprof_response &response) { return response.kind == LENSPROF_RESPONSE_LINEAR; }

// The response of the profile, or that of sensor data. Without either the best one is found later.
void set_response(const lensprof_response &typical, Candidate &candidate) {
    const lensprof_profile &profile = *candidate.profile;
    candidate.found.has_falloff = has_falloff(profile);
    if (is_linear(typical)) {
        candidate.found.response_from = LENSPROF_TRIAL_RESPONSE_LINEAR;
        candidate.responses = {typical};
    } else if (has_response(profile)) {
        candidate.found.response_from = LENSPROF_TRIAL_RESPONSE_OWN;
        candidate.responses.assign(profile.response, profile.response + profile.responses);
    }
}

// For a candidate without a response of its own: the best one, of the kind of camera or of a profile.
void use_best_response(const TrialPairs &pairs, const std::vector<Candidate> &candidates,
                       const lensprof_response &typical, Candidate &candidate) {
    candidate.found.response_from = is_linear(typical) ? LENSPROF_TRIAL_RESPONSE_LINEAR : LENSPROF_TRIAL_RESPONSE_KIND;
    candidate.errors = candidate.errors_with({typical}, pairs);
    const auto rms_of = [](const TrialErrors &errors) {  // of what is not an outlier
        return figures_of(errors, explained_pairs({&errors})).rms;
    };
    for (uint32_t i = 0; i < candidates.size(); i++) {
        if (candidates[i].found.response_from != LENSPROF_TRIAL_RESPONSE_OWN) continue;
        TrialErrors errors = candidate.errors_with(candidates[i].responses, pairs);
        if (rms_of(errors) >= rms_of(candidate.errors)) continue;
        candidate.errors = std::move(errors);
        candidate.found.response_from = LENSPROF_TRIAL_RESPONSE_OTHER, candidate.found.response_profile = i;
    }
}

// The profiles, then no falloff, with their residuals.
std::vector<Candidate> measured(const TrialPairs &pairs, const TrialInput &input) {
    std::vector<Candidate> candidates;
    for (const lensprof_profile *profile : input.profiles) {
        candidates.emplace_back(profile);
        set_response(input.typical, candidates.back());
        if (!candidates.back().responses.empty())
            candidates.back().errors = candidates.back().errors_with(candidates.back().responses, pairs);
    }
    candidates.emplace_back(nullptr);
    for (Candidate &candidate : candidates)
        if (candidate.responses.empty()) use_best_response(pairs, candidates, input.typical, candidate);
    return candidates;
}

ResponseError error_of_response(const Candidate &candidate, const std::vector<Candidate> &candidates,
                                uint32_t camera_kind) {
    const uint32_t other = candidate.found.response_profile;
    switch (candidate.found.response_from) {
    case LENSPROF_TRIAL_RESPONSE_OWN: return own_error(*candidate.profile, camera_kind);
    case LENSPROF_TRIAL_RESPONSE_OTHER: return foreign_error(candidates[other].profile, camera_kind);
    case LENSPROF_TRIAL_RESPONSE_KIND: return foreign_error(nullptr, camera_kind);
    default: return {};
    }
}

// The falloff that each candidate leaves.
void find_rings(const TrialPairs &pairs, const TrialInput &input, std::vector<Candidate> &candidates) {
    for (Candidate &candidate : candidates) {
        std::vector<lensprof_response> curves = candidate.responses;
        if (candidate.found.response_from == LENSPROF_TRIAL_RESPONSE_OTHER)
            curves = candidates[candidate.found.response_profile].responses;
        else if (curves.empty())
            curves = {input.typical};
        candidate.rings = remaining_falloff(pairs, candidate.with(curves),
                                            error_of_response(candidate, candidates, input.camera_kind));
        put_rings(candidate.rings, candidate.found);
    }
}

// Fills in the figures of all candidates, of which the last has no falloff; false if no pair is explained.
bool compare(const TrialPairs &pairs, std::vector<Candidate> &candidates, lensprof_trial_result &result) {
    std::vector<const TrialErrors *> errors;
    for (const Candidate &candidate : candidates) errors.push_back(&candidate.errors);
    const std::vector<bool> is_explained = explained_pairs(errors);
    result.measured = static_cast<uint32_t>(std::count(is_explained.begin(), is_explained.end(), true));
    result.unexplained = static_cast<uint32_t>(is_explained.size()) - result.measured;
    if (!result.measured) return false;
    result.before_rms = figures_of(uncorrected_errors(pairs), is_explained).rms;
    for (Candidate &candidate : candidates) {
        const TrialFigures figures = figures_of(candidate.errors, is_explained);
        candidate.found.heldout_rms = figures.rms, candidate.found.heldout_median = figures.median;
    }
    const auto is_smaller = [](const Candidate &a, const Candidate &b) {
        return a.found.heldout_rms < b.found.heldout_rms;
    };
    const auto last = candidates.end() - 1, best = std::min_element(candidates.begin(), last, is_smaller);
    result.best = static_cast<uint32_t>(best - candidates.begin());
    uint32_t as_good = 0;
    for (auto candidate = candidates.begin(); candidate <= last; candidate++) {
        lensprof_trial_candidate &found = candidate->found;
        const TrialDifference excess = difference_of(candidate->errors, best->errors, pairs, is_explained);
        const TrialDifference gain = difference_of(last->errors, candidate->errors, pairs, is_explained);
        found.above_best = excess.levels, found.above_best_sigma = excess.sigma;
        found.below_none = gain.levels, found.below_none_sigma = gain.sigma;
        found.as_good_as_best = !excess.is_clear(),
        found.better_than_none = gain.is_clear() || is_flatter(candidate->rings);
        result.usable |= found.better_than_none;
        as_good += candidate != last && found.as_good_as_best;
    }
    result.decided = result.usable && as_good == 1;
    return true;
}

void count_pairs(const TrialPairs &pairs, lensprof_trial_result &result) {
    std::set<uint32_t> images;
    for (const auto *half : {&pairs.train, &pairs.heldout})
        for (const lensprof_pair &pair : *half) images.insert(pair.image, pair.image + 2);
    result.images = static_cast<uint32_t>(images.size());
    result.fitted = static_cast<uint32_t>(pairs.train.size());
}

}  // namespace

lensprof_status try_profiles(const TrialInput &input, Trial &trial, lensprof_error *error) {
    const TrialPairs pairs = split_pairs(input.images, input.pairs, input.channels);
    if (pairs.heldout.size() < LENSPROF_TRIAL_PAIRS)
        return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                    "trial: of %zu pairs %zu can be measured, but at least %d are needed; give pictures that overlap "
                    "by a third",
                    input.pairs.size(), pairs.heldout.size(), LENSPROF_TRIAL_PAIRS);
    std::vector<Candidate> candidates = measured(pairs, input);
    find_rings(pairs, input, candidates);
    lensprof_trial_result_init(&trial.result);
    std::copy_n(kEnds, kRings, trial.result.ring_end);
    count_pairs(pairs, trial.result);
    if (!compare(pairs, candidates, trial.result))
        return fail(LENSPROF_ERROR_NO_SAMPLES, error,
                    "trial: no candidate explains any of %zu pairs; give pairs that show the same",
                    pairs.heldout.size());
    for (const Candidate &candidate : candidates) trial.candidates.push_back(candidate.found);
    return LENSPROF_OK;
}

}  // namespace lensprof
