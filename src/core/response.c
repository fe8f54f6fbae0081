/* Response curves: one table of 1024 samples, evaluated and inverted by linear interpolation; linear and gamma
 * curves are evaluated by formula. The empirical model of response is f = f0 + sum alpha_l h_l (d'Angelo eq. 6). */
#include "core/response.h"

#include <math.h>
#include <string.h>

#include "core/emor_table.h"

#define LEAST_IRRADIANCE 1e-9 /* whose logarithm is taken */
#define LAST LP_CURVE_LAST

const double *lensprof_emor_table(uint32_t mode) { return mode <= LENSPROF_EMOR_MODES ? lp_emor_table[mode] : NULL; }

static int is_curve(const double *table) {
    if (table[0] != 0.0 || table[LAST] != 1.0) return 0;
    for (uint32_t j = 0; j < LAST; j++)
        if (!(table[j + 1] >= table[j])) return 0; /* also false for NaN */
    return 1;
}

void lensprof_response_set_linear(lensprof_response *response) {
    memset(response, 0, sizeof *response);
    response->kind = LENSPROF_RESPONSE_LINEAR;
    response->gamma = 1.0;
    for (uint32_t j = 0; j <= LAST; j++) response->table[j] = (double)j / LAST;
}

lensprof_status lensprof_response_set_gamma(lensprof_response *response, double gamma) {
    if (!response) return LENSPROF_ERROR_ARGUMENT;
    if (!lp_is_gamma(gamma)) return LENSPROF_ERROR_RESPONSE;
    memset(response, 0, sizeof *response);
    response->kind = LENSPROF_RESPONSE_GAMMA;
    response->gamma = gamma;
    for (uint32_t j = 1; j < LAST; j++) response->table[j] = pow((double)j / LAST, 1.0 / gamma);
    response->table[LAST] = 1.0;
    return LENSPROF_OK;
}

void lensprof_response_set_srgb(lensprof_response *response) {
    if (!response) return;
    lensprof_response_set_linear(response);
    response->kind = LENSPROF_RESPONSE_TABLE;
    for (uint32_t j = 1; j < LAST; j++) {
        const double x = (double)j / LAST;
        response->table[j] = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    }
}

void lp_emor_curve(const double *coefficients, uint32_t modes, double *table) {
    memcpy(table, lp_emor_table[0], sizeof lp_emor_table[0]);
    for (uint32_t l = 0; l < modes; l++)
        for (uint32_t j = 1; j < LAST; j++) table[j] += coefficients[l] * lp_emor_table[l + 1][j];
    table[0] = 0.0; /* the modes vanish at both ends except for rounding of the published figures */
    table[LAST] = 1.0;
}

lensprof_status lensprof_response_set_emor(lensprof_response *response, const double *coefficients, uint32_t modes) {
    double table[LENSPROF_RESPONSE_SAMPLES];
    if (!response || (modes && !coefficients) || modes > LENSPROF_EMOR_MODES) return LENSPROF_ERROR_ARGUMENT;
    for (uint32_t l = 0; l < modes; l++)
        if (!isfinite(coefficients[l])) return LENSPROF_ERROR_NOT_FINITE;
    lp_emor_curve(coefficients, modes, table);
    if (!is_curve(table)) return LENSPROF_ERROR_RESPONSE;
    memset(response->emor, 0, sizeof response->emor);
    for (uint32_t l = 0; l < modes; l++) response->emor[l] = coefficients[l];
    response->kind = LENSPROF_RESPONSE_EMOR;
    response->modes = modes;
    response->gamma = 1.0;
    memcpy(response->table, table, sizeof table);
    return LENSPROF_OK;
}

lensprof_status lensprof_response_set_table(lensprof_response *response, const double *values, uint32_t count) {
    double table[LENSPROF_RESPONSE_SAMPLES];
    if (!response || !values || count < 2 || count > (1u << 20)) return LENSPROF_ERROR_ARGUMENT;
    for (uint32_t i = 0; i < count; i++) {
        if (!isfinite(values[i])) return LENSPROF_ERROR_NOT_FINITE;
        if (i && values[i] < values[i - 1]) return LENSPROF_ERROR_RESPONSE;
    }
    if (!(fabs(values[0]) <= 1e-6 && fabs(values[count - 1] - 1.0) <= 1e-6)) return LENSPROF_ERROR_RESPONSE;
    for (uint32_t j = 1; j < LAST; j++) {
        double position = (double)j * (count - 1) / LAST;
        uint32_t i = (uint32_t)position;
        double value = values[i] + (position - i) * (values[i + 1] - values[i]);
        table[j] = value < 0.0 ? 0.0 : value > 1.0 ? 1.0 : value;
    }
    table[0] = 0.0;
    table[LAST] = 1.0;
    for (uint32_t j = 1; j <= LAST; j++) /* interpolation may round one unit down */
        if (table[j] < table[j - 1]) table[j] = table[j - 1];
    memset(response, 0, sizeof *response);
    response->kind = LENSPROF_RESPONSE_TABLE;
    response->gamma = 1.0;
    memcpy(response->table, table, sizeof table);
    return LENSPROF_OK;
}

lensprof_status lensprof_response_validate(const lensprof_response *response) {
    if (!response || response->kind > LENSPROF_RESPONSE_TABLE) return LENSPROF_ERROR_ARGUMENT;
    if (response->modes > LENSPROF_EMOR_MODES) return LENSPROF_ERROR_RESPONSE;
    if (response->kind == LENSPROF_RESPONSE_GAMMA && !lp_is_gamma(response->gamma)) return LENSPROF_ERROR_RESPONSE;
    if (response->kind == LENSPROF_RESPONSE_EMOR)
        for (uint32_t l = 0; l < LENSPROF_EMOR_MODES; l++)
            if (!isfinite(response->emor[l]) || (l >= response->modes && response->emor[l] != 0.0))
                return LENSPROF_ERROR_RESPONSE;
    return is_curve(response->table) ? LENSPROF_OK : LENSPROF_ERROR_RESPONSE;
}

double lp_curve_power(double x, double exponent, double *slope) {
    if (slope) *slope = 0.0;
    if (!(x > 0.0)) return 0.0;
    if (x >= 1.0) return 1.0;
    double y = pow(x, exponent);
    if (slope) *slope = exponent * y / x;
    return y;
}

double lensprof_response_eval(const lensprof_response *response, double x, double *slope) {
    switch (response->kind) {
    case LENSPROF_RESPONSE_LINEAR: return lp_curve_power(x, 1.0, slope);
    case LENSPROF_RESPONSE_GAMMA: return lp_curve_power(x, 1.0 / response->gamma, slope);
    default: return lp_curve_eval(response->table, x, slope);
    }
}

double lensprof_response_invert(const lensprof_response *response, double b, double *slope) {
    switch (response->kind) {
    case LENSPROF_RESPONSE_LINEAR: return lp_curve_power(b, 1.0, slope);
    case LENSPROF_RESPONSE_GAMMA: return lp_curve_power(b, response->gamma, slope);
    default: return lp_curve_invert(response->table, b, slope);
    }
}

void lensprof_response_eval_many(const lensprof_response *response, const double *x, size_t count, double *values,
                                 double *slopes) {
    for (size_t i = 0; i < count; i++) values[i] = lensprof_response_eval(response, x[i], slopes ? slopes + i : NULL);
}

void lensprof_response_invert_many(const lensprof_response *response, const double *b, size_t count,
                                   double *irradiances, double *slopes) {
    for (size_t i = 0; i < count; i++)
        irradiances[i] = lensprof_response_invert(response, b[i], slopes ? slopes + i : NULL);
}

double lp_log_irradiance(const double *table, double b, double by_mode[LENSPROF_EMOR_MODES]) {
    double slope, x = lp_curve_invert(table, b, &slope);
    if (x < LEAST_IRRADIANCE) x = LEAST_IRRADIANCE;
    for (uint32_t l = 0; l < LENSPROF_EMOR_MODES; l++)
        by_mode[l] = -lp_curve_eval(lp_emor_table[l + 1], x, NULL) * slope / x;
    return log(x);
}

double lp_gauge_position(const double *table, double by_mode[LENSPROF_EMOR_MODES]) {
    double of_dark[LENSPROF_EMOR_MODES];
    const double bright = lp_log_irradiance(table, LP_GAUGE_BRIGHT, by_mode);
    double range = bright - lp_log_irradiance(table, LP_GAUGE_DARK, of_dark);
    if (range < LP_GAUGE_LEAST) range = LP_GAUGE_LEAST;
    for (uint32_t l = 0; l < LENSPROF_EMOR_MODES; l++) by_mode[l] = (by_mode[l] - of_dark[l]) / range;
    return log(range);
}
