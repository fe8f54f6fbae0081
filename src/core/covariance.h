/* Indices into a covariance, whose order include/lensprof/profile.h states, and the variance of a falloff from it. */
#ifndef LENSPROF_CORE_COVARIANCE_H
#define LENSPROF_CORE_COVARIANCE_H

#include <lensprof/profile.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Number of EMoR coefficients of these responses: all parameters before the first falloff. */
uint32_t lp_covariance_modes(const lensprof_response *response, uint32_t responses);

/* Index of k1 of a curve after `modes` coefficients; curve = number of curves: index of the centre's x. */
static inline uint32_t lp_covariance_index(uint32_t modes, uint32_t curve) { return modes + 3 * curve; }

/* Variance of M at r^2 from the n x n covariance with k1 at index `first`. LENSPROF_UNKNOWN if the covariance does
 * not extend to k3, has no values for the three, or gives no valid variance (below 0, not finite). */
double lp_falloff_variance(const double *covariance, uint32_t n, uint32_t first, double r2);

/* The uncertainty of M in the corner as one number: the largest variance of `curves` falloffs, the first of which
 * has its k1 at index `first`. LENSPROF_UNKNOWN if none is known. */
static inline double lp_corner_variance(const double *covariance, uint32_t n, uint32_t first, uint32_t curves) {
    double largest = LENSPROF_UNKNOWN;
    for (uint32_t curve = 0; curve < curves; curve++) {
        const double variance = lp_falloff_variance(covariance, n, lp_covariance_index(first, curve), 1.0);
        if (variance > largest) largest = variance;
    }
    return largest;
}

#ifdef __cplusplus
}
#endif
#endif
