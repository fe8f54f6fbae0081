/* Names of lenses and cameras, which are written in many ways. */
#ifndef LENSPROF_STORE_NAMES_H
#define LENSPROF_STORE_NAMES_H

#include <stdint.h>

#define LP_NAME_BYTES 256

/* Without ASCII case, blanks and signs, to text[LP_NAME_BYTES]: as the column lens_name has it. */
void lp_squeeze(const char *name, char *text);

/* 1: the same but for case and outer blanks; 0.9: but for signs; 0.8: but for a maker's name in front of one, or its
 * spelling ("NIKON CORPORATION"), or a camera's name elsewhere ("EOS REBEL T3i", "EOS 600D"); else 0. */
double lp_name_score(const char *a, const char *b);

/* Whether two makers may be the same: in one spelling for all, or the one a shorter form of the other; unknown ones
 * may.
 */
int lp_is_same_maker(const char *a, const char *b);

/* A camera's squeezed name without its maker, and those that it has in other countries, to names[]; returns how many.
 */
#define LP_CAMERA_NAMES 3
uint32_t lp_camera_names(const char *squeezed, const char *names[LP_CAMERA_NAMES]);

/* Behind the maker's name in front of a squeezed one, or the whole. */
const char *lp_without_maker(const char *squeezed);

/* The maker whose name this squeezed word is, or begins with, in one spelling for all; NULL = none. */
const char *lp_maker_of(const char *word);
const char *lp_maker_in_front(const char *squeezed);

/* 0.6: the same words in another order, but for what says nothing of the lens ("lens", "mm", "for Canon EF"), of the
 * same maker where both name one, and of that of the camera (empty = any) where one does; all numbers (focal lengths,
 * f-numbers) and generations (II, III) agree. Else 0. */
double lp_words_score(const char *a, const char *b, const char *camera_maker);

/* How much two names share, 0..1: the share of their words that both have, numbers (focal lengths, f-numbers) counting
 * three times; half of it for lenses of different makers. */
double lp_words_likeness(const char *a, const char *b, const char *camera_maker);

/* The squeezed names under which a lens may be stored: its own, without a maker in front, with the camera's maker, with
 * other spellings of its own. */
#define LP_NAME_VARIANTS 12
typedef struct lp_names {
    uint32_t count;
    char name[LP_NAME_VARIANTS][LP_NAME_BYTES];
} lp_names;

void lp_name_variants(const char *lens, const char *camera_maker, lp_names *names);

#endif
