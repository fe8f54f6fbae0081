/* Response tables as the fit uses them: the same maths as lensprof_response_eval and _invert on a bare table. */
#ifndef LENSPROF_CORE_RESPONSE_H
#define LENSPROF_CORE_RESPONSE_H

#include <lensprof/model.h>

#ifdef __cplusplus
extern "C" {
#endif

/* f(x) of a table of 1024 samples; slope as lensprof_response_eval. The table need not end at 1. */
double lp_curve_eval(const double *table, double x, double *slope);

/* Smallest x with f(x) >= b; slope dg/db as lensprof_response_invert. The table must not decrease. */
double lp_curve_invert(const double *table, double b, double *slope);

/* table = f0 + sum coefficients[l] h_(l+1), ends set to 0 and 1 exactly. Not checked for monotony. */
void lp_emor_curve(const double *coefficients, uint32_t modes, double *table);

#ifdef __cplusplus
}
#endif
#endif
