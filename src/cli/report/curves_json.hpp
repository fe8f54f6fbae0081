// Curves of profiles as JSON, for the charts of a page (cli/page).
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <lensprof/lensprof.h>

namespace lensprof {

// Adds {label, m, sigma} per falloff curve: relative illuminance at equal steps of r, and its standard error. Three
// curves get the names of their channels.
void add_falloff_curves(const lensprof_profile &profile, const std::string &label, nlohmann::ordered_json &curves);

// Adds {label, f, sigma} per response: f at equal steps of x. `sigma`, the standard error by the covariance of the EMoR
// coefficients, is missing if the covariance does not include them.
void add_response_curves(const lensprof_profile &profile, const std::string &label, nlohmann::ordered_json &curves);

// "0.67 ± 0.07 (-0.59 EV)": the light in the corner in the green curve, with more digits if its error is below 0.01.
std::string corner_text(const lensprof_profile &profile);

// {label, low, high}: the middle 68 % of the measured cameras of a kind (a mixture of all for LENSPROF_CAMERA_ANY),
// at the same steps; null for LENSPROF_CAMERA_LINEAR.
nlohmann::ordered_json typical_band(uint32_t camera_kind);

}  // namespace lensprof
