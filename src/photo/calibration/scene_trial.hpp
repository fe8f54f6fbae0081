// Profiles tried on the pictures of a scene.
#pragma once

#include <vector>

#include <lensprof/trial.h>

#include "photo/base/events.hpp"
#include "photo/calibration/fit.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// Notes on a scene announce estimates, which a trial does not make; warnings concern the pictures.
class WarningsAlone : public ForwardedEvents {
public:
    using ForwardedEvents::ForwardedEvents;

    void notice(uint32_t severity, const std::string &item, const std::string &text) override {
        if (severity == LENSPROF_SEVERITY_WARNING) ForwardedEvents::notice(severity, item, text);
    }
};

// The pairs of one camera at one lens setting, as in a profile: the setting of the scene with most pairs. Warns of
// pictures of others, and of those whose falloff was corrected before.
class SceneTrial {
public:
    // Draws the pairs. Failure. The scene must live as long. `are_linear`: pictures of which it is unknown whether they
    // are rendered (PictureMetadata::may_be_linear) are linear.
    SceneTrial(const Scene &scene, bool are_linear, Events &events);

    // Of the image with most metadata.
    const lensprof_profile_key &key() const { return key_; }
    const std::string &file() const { return file_; }

    // One candidate per profile, then without falloff; `result` may be NULL. Failure (NOT_USABLE) for too few pairs.
    std::vector<lensprof_trial_candidate> run(const std::vector<const lensprof_profile *> &profiles,
                                              lensprof_trial_result *result = nullptr) const;

private:
    const Scene &scene_;
    lensprof_profile_key key_{};
    std::string file_;
    lensprof_trial_options options_{};
    std::vector<lensprof_fit_image> images_;
    std::vector<lensprof_pair> pairs_;
};

}  // namespace lensprof
