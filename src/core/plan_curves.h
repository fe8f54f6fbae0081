/* The curves of a plan, as tables. */
#ifndef LENSPROF_CORE_PLAN_CURVES_H
#define LENSPROF_CORE_PLAN_CURVES_H

#include "core/options.h"
#include "core/plan.h"

/* Number of floats that the tables need. */
size_t lp_curve_numbers(const lensprof_apply_options *options, const lp_model *model);

/* Fills the tables at `memory` and the plan's curve data; returns the memory after the tables. */
float *lp_prepare_curves(lensprof_plan *plan, const lensprof_apply_options *options, const lp_model *model,
                         float *memory);

#endif
