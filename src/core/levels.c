/* Black and white level (lensprof/model.h): B = (sample - black) / (white - black). */
#include "core/levels.h"

#define LOWEST_BLACK -0.5
#define LEAST_SPAN 0.001 /* white over black: four codes of 12 bit */

lensprof_status lensprof_levels_validate(const lensprof_levels *levels) {
    if (!levels || !(levels->white >= 0.0 && levels->white <= 1.0)) return LENSPROF_ERROR_ARGUMENT;
    for (uint32_t c = 0; c < 3; c++)
        if (!(levels->black[c] >= LOWEST_BLACK && lp_level_span(levels, c) >= LEAST_SPAN))
            return LENSPROF_ERROR_ARGUMENT;
    return LENSPROF_OK;
}

double lensprof_levels_to_value(const lensprof_levels *levels, uint32_t channel, double sample) {
    return channel < 3 ? (sample - levels->black[channel]) / lp_level_span(levels, channel) : sample;
}

double lensprof_levels_to_sample(const lensprof_levels *levels, uint32_t channel, double value) {
    return channel < 3 ? levels->black[channel] + value * lp_level_span(levels, channel) : value;
}
