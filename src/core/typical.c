/* What the kind of a camera reveals about its response: the mean of measured cameras and their scatter. */
#include "core/typical.h"

#include <string.h>

_Static_assert(LENSPROF_CAMERA_PHONE + 1 == LP_TYPICAL_KINDS, "the table has the kinds before LINEAR");

lensprof_status lensprof_response_set_typical(lensprof_response *response, uint32_t camera_kind, double *covariance,
                                              double *log_gamma_sigma) {
    enum {
        MODES = LENSPROF_EMOR_MODES
    };
    if (!response || camera_kind > LENSPROF_CAMERA_LINEAR) return LENSPROF_ERROR_ARGUMENT;
    if (camera_kind == LENSPROF_CAMERA_LINEAR) {
        lensprof_response_set_linear(response);
        if (covariance) memset(covariance, 0, MODES * MODES * sizeof *covariance);
        if (log_gamma_sigma) *log_gamma_sigma = 0.0;
        return LENSPROF_OK;
    }
    const lp_typical *typical = &lp_typical_responses[camera_kind];
    lensprof_status status = lensprof_response_set_emor(response, typical->emor, MODES);
    if (status != LENSPROF_OK) return status;
    const double *value = typical->covariance;
    for (uint32_t i = 0; i < MODES && covariance; i++)
        for (uint32_t j = 0; j <= i; j++) covariance[i * MODES + j] = covariance[j * MODES + i] = *value++;
    if (log_gamma_sigma) *log_gamma_sigma = typical->log_gamma_sigma;
    return LENSPROF_OK;
}
