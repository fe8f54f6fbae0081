/* The falloff of a lens at a focus distance that is not known. */
#ifndef LENSPROF_STORE_LOOKUP_DISTANCE_H
#define LENSPROF_STORE_LOOKUP_DISTANCE_H

#include <lensprof/store.h>

#include "falloff/prediction.h"

/* As lp_predict_falloff, at->distance_m aside; *sigma receives the standard error of M in the corner by the distance.
 * rule: lensprof_distance_rule. */
int lp_predict_any_distance(const lp_falloff_nodes *nodes, const lp_falloff_node *target, uint32_t rule,
                            lp_falloff_prediction *prediction, double *sigma);

#endif
