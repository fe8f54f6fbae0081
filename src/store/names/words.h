/* A lens's name as words of several kinds. */
#ifndef LENSPROF_STORE_WORDS_H
#define LENSPROF_STORE_WORDS_H

#include <stdbool.h>
#include <stdint.h>

#define LP_MOST_WORDS 32
#define LP_WORD_BYTES 24
#define LP_MOST_MAKERS 4

typedef enum lp_word_kind {
    LP_WORD_NUMBER,   /* focal length or f-number */
    LP_WORD_IDENTITY, /* distinguishes lenses: mount, motor, stabiliser, generation, line */
    LP_WORD_VARIANT,  /* one of a list: that of "II/L/WR" which the lens is */
    LP_WORD_OPTIONAL, /* left out as one likes: glass, advertising */
    LP_WORD_DESIGN,   /* "Summilux", which the numbers tell as well */
    LP_WORD_CODE,     /* the maker's number of the lens: "A032", "SAL1855", "016" */
    LP_WORD_KINDS
} lp_word_kind;

typedef struct lp_word {
    char text[LP_WORD_BYTES];
    lp_word_kind kind;
} lp_word;

/* "EF24-70mm f/2.8L II" has ef 24 70 2.8 l ii. */
typedef struct lp_words {
    uint32_t count, makers;
    lp_word word[LP_MOST_WORDS];
    const char *maker[LP_MOST_MAKERS]; /* those that are named, in lp_maker_of's spelling */
} lp_words;

/* Letters and numbers apart, without words that carry no information ("lens", "mm", "& compatibles", "for Canon EF").
 * Words that depend on the maker are identity until lp_weigh_words. False for a name of too many words. */
bool lp_split_words(const char *name, lp_words *words);

/* The kinds of words that depend on whose lens it is. */
void lp_weigh_words(lp_words *words, const char *const *makers, uint32_t count);

/* Whether letters of the name may be a word that lenses of several makers share: "af", "macro", "ii". */
bool lp_is_common_word(const char *text);

#endif
