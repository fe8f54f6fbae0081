/* The response of a camera, whatever its lens. */
#ifndef LENSPROF_STORE_LOOKUP_RESPONSE_H
#define LENSPROF_STORE_LOOKUP_RESPONSE_H

#include "store/profiles/profiles.h"

typedef struct lp_response_answer {
    uint32_t from;        /* lensprof_response_from */
    uint32_t camera_kind; /* lensprof_camera_kind */
    uint32_t rows;        /* profiles it is from */
    int64_t id[LENSPROF_LOOKUP_RESPONSES];
    double weight[LENSPROF_LOOKUP_RESPONSES];
    double sigma;         /* standard error of ln gamma */
    bool has_other_style; /* profiles of the camera were left out, as their picture style is another */
    uint32_t responses;   /* 1 or 3 */
    uint32_t modes;       /* parameters of the covariance: of all responses; 0 where it is not known */
    lensprof_response response[3];
    double covariance[LENSPROF_COVARIANCE_MAX * LENSPROF_COVARIANCE_MAX]; /* modes x modes */
} lp_response_answer;

/* What is known without a database: linear for raw pictures, else the typical response of the kind of camera. */
void lp_typical_answer(const lensprof_profile_key *key, lp_response_answer *answer);

/* The response of the camera by its profiles of rendered pictures. answer->rows is 0, and the rest as it was, where
 * there are no such profiles. `answer` holds the typical one. Within a transaction; uses store->scratch. */
lensprof_status lp_find_response(lensprof_store *store, const lensprof_profile_key *key,
                                 const lensprof_lookup_options *o, lp_response_answer *answer, lensprof_error *error);

/* Standard error of ln gamma that a profile states of its response: its own figure, else by the covariance of its
 * coefficients; LENSPROF_UNKNOWN where it states none. */
double lp_stated_gamma_sigma(const lensprof_profile *profile);

#endif
