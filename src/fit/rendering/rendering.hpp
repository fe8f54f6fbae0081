// The response of a camera from all its shots, its errors, and whether each rendering uses a single curve.
#pragma once

#include <vector>

#include "fit/rendering/areas.hpp"
#include "fit/verdict/finding.hpp"

namespace lensprof {

struct RenderingFit {
    lensprof_response prior;
    Stop stop;
    std::vector<RenderedShot> shots;
    lensprof_rendering_result result;
    Findings verdict;  // of the last fit

    // The number of the shot with the strongest map of residuals.
    uint32_t most_patterned() const;
};

// Fits all shots together, and each alone if there are several, and judges. Errors: those of lensprof_rendering_fit.
lensprof_status fit_shots(RenderingFit &fit, lensprof_error *error);

// Judges whether the response may be stored: sets `verdict`, and `usable` of the result.
void judge_rendering(RenderingFit &fit);

}  // namespace lensprof
