/* Typical responses of the kinds of cameras, as profiles/tools/make_typical_responses.py measures them. */
#ifndef LENSPROF_CORE_TYPICAL_H
#define LENSPROF_CORE_TYPICAL_H

#include <lensprof/model.h>

#define LP_TYPICAL_KINDS 5 /* ANY, FILM, DIGITAL, CAMERA, PHONE */

typedef struct lp_typical {
    double log_gamma_sigma;
    double emor[LENSPROF_EMOR_MODES];
    double covariance[LENSPROF_EMOR_MODES * (LENSPROF_EMOR_MODES + 1) / 2]; /* lower triangle, row by row */
} lp_typical;

extern const lp_typical lp_typical_responses[LP_TYPICAL_KINDS];

#endif
