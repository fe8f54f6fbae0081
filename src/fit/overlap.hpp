// The overlap fit from checked input to result: starts, number of modes, final fit, diagnostics.
#pragma once

#include "solver.hpp"

namespace lensprof {

void fit_overlap(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures,
                 lensprof_fit_result &result);

// Transfer residual of pairs under a model, levels of 255.
struct Summary {
    double rms = 0.0, median = 0.0;
};
Summary transfer_summary(const lensprof_response &response, const lensprof_vignetting &vignetting,
                         const lensprof_fit_image *images, const lensprof_exposure *exposures, uint32_t image_count,
                         const lensprof_pair *pairs, uint32_t pair_count, int channels);

}  // namespace lensprof
