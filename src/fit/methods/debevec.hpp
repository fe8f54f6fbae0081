// The response from known exposures (Debevec & Malik 1997), as the reference that others are measured against: linear
// least squares for G = ln f^-1 at every grey level.
#pragma once

#include <lensprof/fit.h>

namespace lensprof {

// The images' known exposures are taken as exact, their white balances and the falloff as given.
void fit_debevec(const lensprof_fit_options &options, const lensprof_fit_image *images, uint32_t image_count,
                 const lensprof_pair *pairs, uint32_t pair_count, lensprof_exposure *exposures,
                 lensprof_fit_result &result);

// The exposure of an image, EV, by what is known: relative to the reference, whose own stays as given.
double known_exposure(const lensprof_fit_image *images, uint32_t reference, uint32_t i);

}  // namespace lensprof
