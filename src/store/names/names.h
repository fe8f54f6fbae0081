/* Names of lenses and cameras, which are written in many ways. */
#ifndef LENSPROF_STORE_NAMES_H
#define LENSPROF_STORE_NAMES_H

#include <stdbool.h>
#include <stdint.h>

#include "store/names/words.h"

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

/* The part of a squeezed name after a leading maker, or the whole. */
const char *lp_without_maker(const char *squeezed);

/* The maker whose name this squeezed word is, or begins with, in one spelling for all; NULL = none. */
const char *lp_maker_of(const char *word);
const char *lp_maker_in_front(const char *squeezed);

/* Whether a maker, in that spelling, makes lenses for others' cameras and none for its own. */
bool lp_makes_lenses_alone(const char *maker);

/* False where the numbers of the names differ, in most cases: a quick look before lp_words_match. */
bool lp_may_match(const lp_words *requested, const char *stored);

/* 0.6: the same words in another order, except for words that do not identify the lens ("lens", "mm", "for Canon EF");
 * 0.5: some that may be missing are in one of the names alone (glass and advertising: "ED", "M.Zuiko Digital" and "M.",
 * "(IF)"; the maker's code, "A032"), *apart is how many. All numbers (focal lengths, f-numbers) agree, and all other
 * words, as generations (II, III), mounts, motors and stabilisers, tell lenses apart. Makers that are both named are
 * the same; one that is named in one of them is the camera's (empty = any), or makes lenses for others'. Else 0. */
double lp_words_match(const lp_words *requested, const char *stored, const char *camera_maker, uint32_t *apart);
double lp_words_score(const char *a, const char *b, const char *camera_maker);

/* Whether the lens is that of several variants which is meant where none is named: "... (Standard)". */
bool lp_is_standard(const char *lens);

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
