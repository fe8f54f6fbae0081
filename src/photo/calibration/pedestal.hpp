// A black level that nobody stated, as the pairs of linear pictures show it.
#pragma once

#include <optional>
#include <vector>

#include <lensprof/fit.h>

namespace lensprof {

struct Pedestal {
    double level = 0.0, sigma = 0.0;  // shares of full scale
};

// With a black level b, ln(v1 - b) - ln(v2 - b) of a pair is the difference of exposure and falloff at all grey levels;
// without it, dark pairs differ less. b is fitted with the exposures and a falloff that all images share, to the green
// values. Empty unless it is clearly above 0.
std::optional<Pedestal> find_pedestal(const std::vector<lensprof_pair> &pairs,
                                      const std::vector<lensprof_fit_image> &images);

}  // namespace lensprof
