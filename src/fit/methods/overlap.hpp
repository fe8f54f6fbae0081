// The fit from checked input to result: starts, gauge, number of modes and falloff curves, final fit.
#pragma once

#include "fit/verdict/quality.hpp"
#include "fit/verdict/result.hpp"

namespace lensprof {

void fit_overlap(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures, FitResult &result);

// The same by method `radiance`; at least one track must have a pair.
void fit_radiance(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                  const Tracks &tracks, lensprof_exposure *exposures, FitResult &result);

// Absolute transfer residuals of pairs under a model, levels of 255. falloffs: of every lens setting.
std::vector<double> transfer_levels(const lensprof_response &response, const std::vector<Falloffs> &falloffs,
                                    const std::vector<lensprof_fit_image> &images, const lensprof_exposure *exposures,
                                    const std::vector<lensprof_pair> &pairs, int channels);

}  // namespace lensprof
