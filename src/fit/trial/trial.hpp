// The trial of several profiles on the same pairs: the response of each, its residuals, and which one fits best.
#pragma once

#include <vector>

#include <lensprof/trial.h>

namespace lensprof {

struct TrialInput {
    uint32_t channels = 3, camera_kind = LENSPROF_CAMERA_ANY;
    lensprof_response typical;  // of the kind of camera; linear for sensor data, and then that of all candidates
    std::vector<lensprof_fit_image> images;
    std::vector<lensprof_pair> pairs;
    std::vector<const lensprof_profile *> profiles;
};

struct Trial {
    std::vector<lensprof_trial_candidate> candidates;  // per profile, then without falloff
    lensprof_trial_result result;
};

// Errors: NO_SAMPLES as lensprof_trial_run.
lensprof_status try_profiles(const TrialInput &input, Trial &trial, lensprof_error *error);

}  // namespace lensprof
