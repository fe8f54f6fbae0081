/* Response tables as the fit uses them: the same maths as lensprof_response_eval and _invert on a bare table. */
#ifndef LENSPROF_CORE_RESPONSE_H
#define LENSPROF_CORE_RESPONSE_H

#include <lensprof/model.h>

#ifdef __cplusplus
extern "C" {
#endif

#define LP_CURVE_LAST (LENSPROF_RESPONSE_SAMPLES - 1)

/* Whether an exponent is valid for a response. */
static inline int lp_is_gamma(double gamma) { return gamma >= 0.1 && gamma <= 10.0; }

/* f(x) of a table of 1024 samples; slope as lensprof_response_eval. The table need not end at 1. */
static inline double lp_curve_eval(const double *table, double x, double *slope) {
    if (!(x > 0.0) || x >= 1.0) {
        if (slope) *slope = 0.0;
        return x > 0.0 ? table[LP_CURVE_LAST] : table[0];
    }
    double position = x * LP_CURVE_LAST;
    int32_t j = (int32_t)position; /* signed: conversion takes one instruction, unsigned takes several */
    double step = table[j + 1] - table[j];
    if (slope) *slope = step * LP_CURVE_LAST;
    return table[j] + (position - j) * step;
}

/* The x at which f is b, given its samples j and j + 1: below < b <= above. */
static inline double lp_curve_between(double below, double above, double b, uint32_t j) {
    return (j + (b - below) / (above - below)) / LP_CURVE_LAST;
}

/* Smallest x with f(x) >= b, if table[low] < b <= table[high]; slope dg/db as lensprof_response_invert. */
static inline double lp_curve_invert_between(const double *table, double b, uint32_t low, uint32_t high,
                                             double *slope) {
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        if (table[middle] < b)
            low = middle;
        else
            high = middle;
    }
    if (slope) *slope = 1.0 / ((table[high] - table[low]) * LP_CURVE_LAST);
    return lp_curve_between(table[low], table[high], b, low);
}

/* The same over the whole table, which must not decrease. */
static inline double lp_curve_invert(const double *table, double b, double *slope) {
    if (slope) *slope = 0.0;
    if (!(b > table[0])) return 0.0;
    if (b > table[LP_CURVE_LAST]) return 1.0;
    return lp_curve_invert_between(table, b, 0, LP_CURVE_LAST, slope);
}

/* x^exponent on [0,1], clamped to it, and its slope. The slope of a root at 0 is infinite and returned as 0, as is
 * the slope outside. */
double lp_curve_power(double x, double exponent, double *slope);

/* table = f0 + sum coefficients[l] h_(l+1), ends set to 0 and 1 exactly. Not checked for monotony. */
void lp_emor_curve(const double *coefficients, uint32_t modes, double *table);

/* ln I at a level b in 0..1, with I the inverse response, and its derivative by every EMoR mode h: a change h of f
 * moves x with f(x) = b by -h(x) / f'(x). I is at least 1e-9. */
double lp_log_irradiance(const double *table, double b, double by_mode[LENSPROF_EMOR_MODES]);

/* Position of a response within its family f(x^(1/gamma)): q = ln ln(I(208/255) / I(48/255)), which moves by ln
 * gamma and does not depend on where the curve reaches white (docs/model.md, profiles/tools/measured_curves.py); and
 * its derivative by every EMoR mode. */
#define LP_GAUGE_DARK (48.0 / 255.0)
#define LP_GAUGE_BRIGHT (208.0 / 255.0)
#define LP_GAUGE_LEAST 1e-6 /* of ln(I / I), so that q is finite */
double lp_gauge_position(const double *table, double by_mode[LENSPROF_EMOR_MODES]);

#ifdef __cplusplus
}
#endif
#endif
