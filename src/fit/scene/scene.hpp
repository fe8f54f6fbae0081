// Fits of a scene that was seen from many sides, of which a reconstruction matched points.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "fit/methods/fit_call.hpp"

namespace lensprof {

struct SceneData {
    std::vector<lensprof_pair> pairs;
    std::vector<uint32_t> points;   // per pair: the scene point that it shows
    std::vector<double> distances;  // per pair: between its two views; empty: unknown
};

// Fits pairs with the options and images of a call, which receives the result; false if the pairs are insufficient.
using FitPairs = std::function<bool(FitCall &call, const std::vector<lensprof_pair> &pairs, lensprof_exposure *found)>;

// One of several fits of a scene.
struct SceneFit {
    std::unique_ptr<FitCall> call;
    std::vector<lensprof_exposure> exposures;

    // With the options and images of another call, without a result. `exposures`: what is there before a fit.
    SceneFit(const FitCall &like, const lensprof_exposure *before);

    uint32_t joined() const;

    // The colour differences of pairs that are corrected with this fit.
    std::vector<double> differences(const SceneData &data) const;
};

// Continues the fit of all pairs of a scene, whose result is in `call` and `exposures`: leaves out glossy points, adds
// the errors that two halves of the points differ by, compares colours with those corrected by exposures and white
// balances alone, which become the result if that is not better, and refuses two visits in different light.
void fit_scene(const SceneData &data, const FitPairs &fit, FitCall &call, lensprof_exposure *exposures);

}  // namespace lensprof
