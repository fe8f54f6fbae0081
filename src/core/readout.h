/* What a sensor reads of its frame, checked, and the grid that it gives. */
#ifndef LENSPROF_CORE_READOUT_H
#define LENSPROF_CORE_READOUT_H

#include "core/sensor.h"

/* Copies and checks the caller's readout of a frame; sets width and height if they are 0. Status and text are those of
 * lensprof_sensor_plan_init. */
lensprof_status lp_readout_take(lensprof_readout *readout, const lensprof_readout *given, uint32_t frame_width,
                                uint32_t frame_height, lensprof_error *error);

/* Nodes of all planes; 0 if the readout is invalid in any frame. */
uint32_t lp_readout_nodes(const lensprof_readout *given);

uint32_t lp_readout_planes(const lensprof_readout *readout);

/* Whether samples of an axis (0 across, 1 down) are read backwards. */
int lp_readout_is_flipped(const lensprof_readout *readout, int axis);

lp_sensor_grid lp_readout_grid(const lensprof_readout *readout, uint32_t frame_width, uint32_t frame_height);

lensprof_status lp_sensor_levels_validate(const lensprof_sensor_levels *levels);

#endif
