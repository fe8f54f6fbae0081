// Made by profiles/tools/make_falloff_prior.py of 19757 entries; do not edit.
// Statistics of Lensfun's lens data (CC BY-SA 3.0, see NOTICE).
#include "fit/prior/falloff_prior.hpp"

namespace lensprof {

const FalloffClass kFalloffClasses[kSensorClassCount][kStopClassCount] = {
    {
        // full frame or larger, wide open: 1550 entries; M(1) at the mean 0.348
        {{-0.2624, -0.5739, -1.0563},
         {{0.012557, 0.022751, 0.033757}, {0.022751, 0.044479, 0.070760}, {0.033757, 0.070760, 0.129355}}},
        // full frame or larger, 1 stop: 1522 entries; M(1) at the mean 0.533
        {{-0.0877, -0.2619, -0.6296},
         {{0.003653, 0.007891, 0.012452}, {0.007891, 0.019728, 0.034358}, {0.012452, 0.034358, 0.075022}}},
        // full frame or larger, 2 stops: 1424 entries; M(1) at the mean 0.664
        {{-0.0763, -0.1804, -0.4095},
         {{0.003115, 0.006597, 0.010553}, {0.006597, 0.015010, 0.025789}, {0.010553, 0.025789, 0.054661}}},
        // full frame or larger, 3 stops or more: 3680 entries; M(1) at the mean 0.752
        {{-0.0743, -0.1628, -0.2848},
         {{0.002620, 0.005825, 0.009951}, {0.005825, 0.013154, 0.022597}, {0.009951, 0.022597, 0.040603}}},
    },
    {
        // smaller sensor, wide open: 2757 entries; M(1) at the mean 0.564
        {{-0.1462, -0.3160, -0.5733},
         {{0.008921, 0.017405, 0.027317}, {0.017405, 0.036002, 0.059118}, {0.027317, 0.059118, 0.106640}}},
        // smaller sensor, 1 stop: 2631 entries; M(1) at the mean 0.742
        {{-0.0510, -0.1297, -0.2988},
         {{0.001705, 0.004023, 0.007612}, {0.004023, 0.010470, 0.021078}, {0.007612, 0.021078, 0.048933}}},
        // smaller sensor, 2 stops: 2040 entries; M(1) at the mean 0.818
        {{-0.0485, -0.1047, -0.2011},
         {{0.001406, 0.003064, 0.005712}, {0.003064, 0.006824, 0.012812}, {0.005712, 0.012812, 0.026613}}},
        // smaller sensor, 3 stops or more: 4153 entries; M(1) at the mean 0.831
        {{-0.0496, -0.1072, -0.1851},
         {{0.001373, 0.002982, 0.005133}, {0.002982, 0.006601, 0.011448}, {0.005133, 0.011448, 0.020395}}},
    },
};

}  // namespace lensprof
