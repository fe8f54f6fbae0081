/* What a sensor plan is made from. */
#ifndef LENSPROF_CORE_SENSOR_PLAN_H
#define LENSPROF_CORE_SENSOR_PLAN_H

#include "core/options.h"
#include "core/readout.h"

/* The caller's options and readout, complete and valid, with the model and the levels in codes of input and output. */
typedef struct lp_sensor_source {
    lensprof_apply_options options;
    lensprof_readout readout;
    lp_model model;
    lensprof_sensor_levels levels[2];
    int has_colours; /* planes use more than one channel */
} lp_sensor_source;

/* Copies and checks them; status and text are those of lensprof_sensor_plan_init. */
lensprof_status lp_sensor_source_take(lp_sensor_source *source, const lensprof_apply_options *options,
                                      const lensprof_readout *readout, lensprof_error *error);

/* The gain of light of a plane at a pixel of the frame, without the readout's own gains. */
double lp_sensor_gain(const lp_sensor_source *source, uint32_t plane, double x, double y);

/* White less black of a plane, in codes. */
static inline double lp_sensor_span(const lp_sensor_source *source, enum lp_end end, uint32_t plane) {
    return source->levels[end].white - source->levels[end].black[plane];
}

#endif
