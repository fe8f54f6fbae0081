// The response from known exposures (Debevec & Malik 1997), the reference for the other methods: linear least squares
// for G = ln f^-1 at every grey level.
#pragma once

#include <lensprof/fit.h>

#include "fit/verdict/result.hpp"

namespace lensprof {

// The known exposures of the images are taken as exact; white balances and falloff are as given.
void fit_debevec(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures, FitResult &result);

// The known exposure of an image, EV, relative to the reference, whose own exposure stays as given.
double known_exposure(const lensprof_fit_image *images, uint32_t reference, uint32_t i);

}  // namespace lensprof
