/* Radial falloff M = 1 + k1 r^2 + k2 r^4 + k3 r^6 (d'Angelo eq. 7), and exposure factors. */
#include <lensprof/model.h>

#include <math.h>

#define SMALLEST_M 0.001
#define LARGEST_K 1e6 /* far beyond any lens; keeps the arithmetic below accurate enough */

double lensprof_half_diagonal(uint32_t width, uint32_t height) {
    const double w = width, h = height;
    return 0.5 * sqrt(w * w + h * h); /* not hypot, which need not be exactly rounded */
}

double lensprof_vignetting_eval(const lensprof_vignetting *vignetting, double r2, double *slope) {
    const double *k = vignetting->k;
    if (slope) *slope = k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[2]);
    return 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
}

void lensprof_vignetting_eval_many(const lensprof_vignetting *vignetting, const double *r2, size_t count,
                                   double *values, double *slopes) {
    for (size_t i = 0; i < count; i++)
        values[i] = lensprof_vignetting_eval(vignetting, r2[i], slopes ? slopes + i : NULL);
}

double lensprof_vignetting_r2(const lensprof_vignetting *vignetting, uint32_t width, uint32_t height, double x,
                              double y, double *gradient) {
    double w = width, h = height;
    double rho = lensprof_half_diagonal(width, height);
    double dx = (x - 0.5 * (w - 1.0)) / rho - vignetting->center[0];
    double dy = (y - 0.5 * (h - 1.0)) / rho - vignetting->center[1];
    if (gradient) {
        gradient[0] = -2.0 * dx;
        gradient[1] = -2.0 * dy;
    }
    return dx * dx + dy * dy;
}

void lensprof_vignetting_r2_many(const lensprof_vignetting *vignetting, uint32_t width, uint32_t height,
                                 const double *xy, size_t count, double *r2, double *gradients) {
    for (size_t i = 0; i < count; i++)
        r2[i] = lensprof_vignetting_r2(vignetting, width, height, xy[2 * i], xy[2 * i + 1],
                                       gradients ? gradients + 2 * i : NULL);
}

lensprof_status lensprof_vignetting_validate(const lensprof_vignetting *vignetting) {
    if (!vignetting) return LENSPROF_ERROR_ARGUMENT;
    const double *k = vignetting->k, *c = vignetting->center;
    if (!isfinite(k[0]) || !isfinite(k[1]) || !isfinite(k[2])) return LENSPROF_ERROR_NOT_FINITE;
    if (!isfinite(c[0]) || !isfinite(c[1])) return LENSPROF_ERROR_NOT_FINITE;
    if (fabs(k[0]) > LARGEST_K || fabs(k[1]) > LARGEST_K || fabs(k[2]) > LARGEST_K) return LENSPROF_ERROR_VIGNETTING;
    if (fabs(c[0]) > 1.0 || fabs(c[1]) > 1.0) return LENSPROF_ERROR_VIGNETTING;
    /* The minimum over s = r^2 in [0, limit] is at an end or where dM/ds = k1 + 2 k2 s + 3 k3 s^2 = 0. */
    double reach = 1.0 + hypot(c[0], c[1]), limit = reach * reach, candidate[3] = {limit, 0.0, 0.0};
    double discriminant = k[1] * k[1] - 3.0 * k[2] * k[0];
    if (discriminant >= 0.0) { /* both roots without cancellation: q / (3 k3) and k1 / q */
        double q = -(k[1] + copysign(sqrt(discriminant), k[1]));
        if (k[2] != 0.0) candidate[1] = q / (3.0 * k[2]);
        if (q != 0.0) candidate[2] = k[0] / q;
    }
    for (int i = 0; i < 3; i++)
        if (candidate[i] > 0.0 && candidate[i] <= limit
            && !(lensprof_vignetting_eval(vignetting, candidate[i], NULL) >= SMALLEST_M))
            return LENSPROF_ERROR_VIGNETTING;
    return LENSPROF_OK;
}

void lensprof_exposure_init(lensprof_exposure *exposure) {
    exposure->ev = 0.0;
    for (int c = 0; c < 3; c++) exposure->white_balance[c] = 1.0;
}

lensprof_status lensprof_exposure_validate(const lensprof_exposure *exposure) {
    if (!exposure) return LENSPROF_ERROR_ARGUMENT;
    if (!(fabs(exposure->ev) <= 64.0)) return LENSPROF_ERROR_EXPOSURE;
    for (int c = 0; c < 3; c++)
        if (!(exposure->white_balance[c] >= 1e-6 && exposure->white_balance[c] <= 1e6)) return LENSPROF_ERROR_EXPOSURE;
    return LENSPROF_OK;
}
