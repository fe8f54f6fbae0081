// The fit from checked input to result: starts, gauge, number of modes and falloff curves, final fit.
#pragma once

#include "fit/verdict/quality.hpp"

namespace lensprof {

void fit_overlap(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures,
                 lensprof_fit_result &result);

// The same by method `radiance`; at least one track must have a pair.
void fit_radiance(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                  const Tracks &tracks, lensprof_exposure *exposures, lensprof_fit_result &result);

// Transfer residual of pairs under a model.
Summary transfer_summary(const lensprof_response &response, const lensprof_vignetting vignetting[3],
                         const lensprof_fit_image *images, const lensprof_exposure *exposures, uint32_t image_count,
                         const lensprof_pair *pairs, uint32_t pair_count, int channels);

}  // namespace lensprof
