// Fits without glossy points, whose highlights at a fixed position in the frame look like falloff and like drifting
// exposures; each is too small for a robust loss.
#pragma once

#include "fit/scene/scene.hpp"

namespace lensprof {

// Refits without the points whose colours differ most between views until the exposures are stable. `data` keeps the
// pairs that were fitted last.
void leave_out_glossy_points(const FitPairs &fit, SceneData &data, SceneFit &best);

// Increases the standard errors of exposures and white balances by the difference between fits of two halves of the
// points: pairs of a point are not independent, and residuals of selected points are smaller than those of all.
void add_errors_by_halves(const SceneData &data, const FitPairs &fit, SceneFit &best);

}  // namespace lensprof
