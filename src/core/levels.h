/* Black and white level of pictures. */
#ifndef LENSPROF_CORE_LEVELS_H
#define LENSPROF_CORE_LEVELS_H

#include <lensprof/model.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whether any number is not 0. */
static inline int lp_has_levels(const lensprof_levels *levels) {
    return levels->black[0] != 0.0 || levels->black[1] != 0.0 || levels->black[2] != 0.0 || levels->white != 0.0;
}

/* The white level, full scale if 0. */
static inline double lp_white_level(const lensprof_levels *levels) { return levels->white > 0.0 ? levels->white : 1.0; }

/* White less black of a channel. */
static inline double lp_level_span(const lensprof_levels *levels, uint32_t channel) {
    return lp_white_level(levels) - levels->black[channel];
}

#ifdef __cplusplus
}
#endif
#endif
