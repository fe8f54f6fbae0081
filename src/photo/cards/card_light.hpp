// The light on cards: brighter in the middle, it looks like falloff. Overlapping pictures of the lens tell them apart.
#pragma once

#include <string>
#include <vector>

#include <lensprof/trial.h>

#include "photo/cards/lens_cards.hpp"

namespace lensprof {

// A light that depends on the distance from the middle alone: 2^(c[0] r^2 + c[1] r^4), r in half diagonals of the frame
// at the focal length of the check; with the covariance of c.
struct RadialLight {
    double c[2] = {0.0, 0.0};
    double covariance[2][2] = {};

    double ev_at(double r) const { return (c[0] + c[1] * r * r) * r * r; }
};

// What pictures show about the light on the cards of a setting.
struct LightCheck {
    size_t setting = 0;  // which was checked
    std::string pictures;
    uint32_t corners = LENSPROF_TRIAL_CORNERS_NOT_SHOWN;  // lensprof_trial_corners, corrected with its profile
    uint32_t rings = 0;
    double ring_end[LENSPROF_TRIAL_RINGS] = {};  // largest r, half diagonals
    double ring_ev[LENSPROF_TRIAL_RINGS] = {}, ring_sigma_ev[LENSPROF_TRIAL_RINGS] = {};

    std::string text() const;  // "the corners come out too bright: +0.21 ± 0.04 EV"

    bool finds_light() const {
        return corners == LENSPROF_TRIAL_CORNERS_TOO_DARK || corners == LENSPROF_TRIAL_CORNERS_TOO_BRIGHT;
    }
};

// Tries the profile of the setting that the overlapping pictures were taken with. `are_linear`: those that are not
// marked as rendered or linear are linear. Failure if no setting is theirs, or if they do not overlap.
LightCheck check_light(const std::vector<std::string> &pictures, bool are_linear,
                       const std::vector<MeasuredSetting> &settings, Events &events);

// The light that explains the rings: by least squares, with a standard error of 0.5 EV of c before.
RadialLight light_of(const LightCheck &check);

// Divides the falloff of the setting checked by the light, and those of all settings of the same camera and lens with
// the same or a longer focal length, which see a part of it. Adds its error to their covariance, and notes to all
// settings. Returns the number of settings corrected.
size_t remove_light(const LightCheck &check, std::vector<MeasuredSetting> &settings);

// M(r) / light(r * scale) as a falloff curve again: k of least squares over the frame. False, with the profile
// unchanged, if that falls to zero within the frame.
bool divide_by_light(const RadialLight &light, double scale, lensprof_profile &profile);

}  // namespace lensprof
