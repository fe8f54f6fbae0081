/* The factor of an exposure. */
#ifndef LENSPROF_CORE_EXPOSURE_H
#define LENSPROF_CORE_EXPOSURE_H

#include <math.h>

#include <lensprof/model.h>

/* e * w of channel 0, 1 or 2. */
static inline double lp_exposure_factor(const lensprof_exposure *exposure, uint32_t channel) {
    return exp2(exposure->ev) * exposure->white_balance[channel];
}

#endif
