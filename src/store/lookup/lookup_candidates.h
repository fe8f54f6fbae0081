/* The rows that a lookup may use. */
#ifndef LENSPROF_STORE_LOOKUP_CANDIDATES_H
#define LENSPROF_STORE_LOOKUP_CANDIDATES_H

#include "falloff/prediction.h"
#include "store/profiles/profiles.h"

/* A row of the lens: how well it fits the camera, and its node. */
typedef struct lp_candidate {
    lp_falloff_node node;
    int of_unit;          /* 1: of the key's; 0: of any */
    int of_camera;        /* 1: of the key's; 0: of any; -1: of another */
    int has_own_response; /* the row's response is that of the key's pictures, too: same camera, processing and style */
    bool has_curve;       /* lp_read_curves has read node.k */
    bool is_replaced;     /* another row has the same setting and comes before it */
    int is_fixed;         /* of a camera whose lens has no name of its own: it cannot be changed */
    uint32_t processing;
    double crop;
    double color_temperature_k; /* LENSPROF_UNKNOWN = any */
} lp_candidate;

typedef struct lp_candidates {
    lp_candidate *all; /* free it */
    uint32_t count, capacity;
    double name_score;
    lensprof_profile_key last; /* names of the row before, which most rows share, and what they were found to be */
    double last_score;
    int last_camera;
    bool by_words;   /* the lens was found by the words of its name */
    bool by_table;   /* by_camera, as the table of cameras has it, whatever the profiles' cameras are called */
    bool by_camera;  /* no lens has the name: it is that which the camera has built in */
    bool any_unit;   /* asked for: profiles of single units, whatever the key's */
    bool has_lenses; /* nothing was found, since the camera has several lenses and none was asked for */
} lp_candidates;     /* by rising id */

/* Not blanks alone. */
bool lp_is_known(const char *text);

/* Picture styles: 1 the same, 0 one of them is not known, -1 different ones. */
int lp_fits_style(const char *stored, const char *requested);

/* Light falls off the same whatever is made of it: rows of raw and rendered pictures serve both, those of pictures that
 * the camera has corrected serve such ones alone, unless options->force_falloff. All rows of the lens under the first
 * of its names that any has, else of the lens with the same words; without a lens those of the camera, its own or those
 * of the only lens it has; these, too, where no lens has the name and the camera's is named after it, as it is built
 * in. Within a transaction. */
lensprof_status lp_find_candidates(lensprof_store *store, const lensprof_profile_key *key,
                                   const lensprof_lookup_options *o, lp_candidates *found, lensprof_error *error);

/* node.k of all of the group, by rising id, which lp_find_candidates leaves open. Within a transaction. */
lensprof_status lp_read_curves(lensprof_store *store, lp_candidates *group, lensprof_error *error);

#endif
