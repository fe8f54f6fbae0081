// Made by profiles/tools/make_falloff_prior.py of 19757 entries; do not edit.
// Statistics of Lensfun's lens data (CC BY-SA 3.0, see NOTICE).
#include "fit/prior/falloff_prior.hpp"

namespace lensprof {

const FalloffClass kFalloffClasses[kFalloffClassCount] = {
    // wide open: 4307 entries; M(1) at the mean 0.466
    {{-0.1917, -0.4171, -0.7626},
     {{0.013112, 0.025633, 0.041225}, {0.025633, 0.052940, 0.088916}, {0.041225, 0.088916, 0.162246}}},
    // 1 stop: 4153 entries; M(1) at the mean 0.651
    {{-0.0654, -0.1810, -0.4287},
     {{0.002725, 0.006466, 0.011862}, {0.006466, 0.017390, 0.034523}, {0.011862, 0.034523, 0.079502}}},
    // 2 stops: 3464 entries; M(1) at the mean 0.758
    {{-0.0600, -0.1336, -0.2770},
     {{0.002172, 0.004756, 0.008679}, {0.004756, 0.010823, 0.020376}, {0.008679, 0.020376, 0.044316}}},
    // 3 stops or more: 7833 entries; M(1) at the mean 0.800
    {{-0.0592, -0.1288, -0.2233},
     {{0.001953, 0.004298, 0.007403}, {0.004298, 0.009610, 0.016648}, {0.007403, 0.016648, 0.029792}}},
};

}  // namespace lensprof
