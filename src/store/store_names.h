/* Names of lenses and cameras, which are written in many ways. */
#ifndef LENSPROF_STORE_NAMES_H
#define LENSPROF_STORE_NAMES_H

#include <stdint.h>

#define LP_NAME_BYTES 256

/* Without ASCII case, blanks and signs, to text[LP_NAME_BYTES]: as the column lens_name has it. */
void lp_squeeze(const char *name, char *text);

/* 1: the same but for case and outer blanks; 0.9: but for signs; 0.8: but for a maker's name in front of one; else 0. */
double lp_name_score(const char *a, const char *b);

/* The squeezed names under which a lens may be stored: its own, without a maker in front, with the camera's maker. */
typedef struct lp_names {
    uint32_t count;
    char name[3][LP_NAME_BYTES];
} lp_names;

void lp_name_variants(const char *lens, const char *camera_maker, lp_names *names);

#endif
