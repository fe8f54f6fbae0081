/* Names of lenses compared word by word, where nothing else finds one. */
#include <string.h>

#include "store/names/names.h"
#include "store/names/words.h"

#define SAME_WORDS 0.6
#define WORDS_MISSING 0.5

/* Of one kind, how many words both have, and how many one of them has alone. */
typedef struct share {
    uint32_t common, alone[2];
} share;

static bool has(const lp_words *words, const char *text, lp_word_kind kind) {
    for (uint32_t i = 0; i < words->count; i++)
        if (words->word[i].kind == kind && !strcmp(words->word[i].text, text)) return true;
    return false;
}

static uint32_t count_numbers(const lp_words *words) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < words->count; i++) count += words->word[i].kind == LP_WORD_NUMBER;
    return count;
}

static share compare(const lp_words *x, const lp_words *y, lp_word_kind kind) {
    share s = {0, {0, 0}};
    const lp_words *both[2] = {x, y};
    for (int n = 0; n < 2; n++)
        for (uint32_t i = 0; i < both[n]->count; i++) {
            const lp_word *word = &both[n]->word[i];
            if (word->kind != kind) continue;
            if (!has(both[!n], word->text, kind))
                s.alone[n]++;
            else if (n == 0)
                s.common++;
        }
    return s;
}

/* In any order, "2/25" and "25mm f/2"; but "2.8-2.8" is not 2.8. */
static bool have_same_numbers(const lp_words *x, const lp_words *y) {
    const share s = compare(x, y, LP_WORD_NUMBER);
    return s.common && !s.alone[0] && !s.alone[1] && count_numbers(x) == count_numbers(y);
}

static bool is_contradiction(share s) { return !s.common && s.alone[0] && s.alone[1]; }

/* Identity: each word in the other, too, be it as a variant; and of the variants of a list one in the other. */
static bool is_same_identity(const lp_words *x, const lp_words *y) {
    bool has_variants = false, names_variant = false;
    for (uint32_t i = 0; i < x->count; i++) {
        const lp_word *word = &x->word[i];
        const bool other = has(y, word->text, LP_WORD_IDENTITY), variant = has(y, word->text, LP_WORD_VARIANT);
        if (word->kind == LP_WORD_IDENTITY && !other && !variant) return false;
        has_variants |= word->kind == LP_WORD_VARIANT;
        names_variant |= word->kind == LP_WORD_VARIANT && (other || variant);
    }
    return !has_variants || names_variant;
}

static bool is_named(const lp_words *words, const char *maker) {
    for (uint32_t i = 0; i < words->makers; i++)
        if (!strcmp(words->maker[i], maker)) return true;
    return false;
}

/* Something that not every maker's lenses are called; a letter ("E 28-75mm") does where no word is missing. */
static bool have_own_word(const lp_words *x, const lp_words *y, bool any_letter) {
    for (uint32_t i = 0; i < x->count; i++) {
        const lp_word *word = &x->word[i];
        if (word->kind == LP_WORD_NUMBER || lp_is_common_word(word->text)) continue;
        if (!word->text[1] && !any_letter) continue;
        if (has(y, word->text, word->kind)) return true;
    }
    return false;
}

/* Makers that are both named must be the same. One alone must be the camera's (`own_maker`, NULL = none that is known),
 * or that of lenses for others' cameras; then the names must share more than numbers, as where one alone has a code:
 * "E 20mm F2.8 F050" is no "Sony E 20mm F2.8". */
static bool may_be_same_maker(const lp_words *x, const lp_words *y, const char *camera_maker, const char *own_maker,
                              uint32_t apart) {
    const share codes = compare(x, y, LP_WORD_CODE);
    if (!x->makers && !y->makers) return true;
    if (x->makers && y->makers) {
        for (uint32_t i = 0; i < x->makers; i++)
            if (is_named(y, x->maker[i])) return true;
        return false;
    }
    if ((codes.alone[0] || codes.alone[1]) && !have_own_word(x, y, false)) return false;
    const lp_words *named = x->makers ? x : y;
    if (!*camera_maker || (own_maker && is_named(named, own_maker))) return true;
    for (uint32_t i = 0; i < named->makers; i++)
        if (own_maker && lp_makes_lenses_alone(named->maker[i])) return have_own_word(x, y, !apart);
    return false;
}

/* A name of numbers alone is anybody's. */
static bool is_informative(const lp_words *words) {
    if (words->makers) return true;
    for (uint32_t i = 0; i < words->count; i++)
        if (words->word[i].kind != LP_WORD_NUMBER) return true;
    return false;
}

static void weigh(lp_words *x, lp_words *y, const char *own_maker) {
    const char *makers[2 * LP_MOST_MAKERS + 1];
    uint32_t count = 0;
    for (uint32_t i = 0; i < x->makers; i++) makers[count++] = x->maker[i];
    for (uint32_t i = 0; i < y->makers; i++) makers[count++] = y->maker[i];
    if (!count && own_maker) makers[count++] = own_maker;
    lp_weigh_words(x, makers, count);
    lp_weigh_words(y, makers, count);
}

static bool match(lp_words *x, lp_words *y, const char *camera_maker, uint32_t *apart) {
    char camera[LP_NAME_BYTES];
    *apart = 0;
    if (!have_same_numbers(x, y) || !is_informative(x) || !is_informative(y)) return false;
    lp_squeeze(camera_maker, camera);
    const char *own_maker = lp_maker_in_front(camera);
    weigh(x, y, own_maker);
    if (!is_same_identity(x, y) || !is_same_identity(y, x)) return false;
    for (int kind = LP_WORD_VARIANT; kind < LP_WORD_KINDS; kind++) {
        const share s = compare(x, y, (lp_word_kind)kind);
        if ((kind == LP_WORD_DESIGN || kind == LP_WORD_CODE) && is_contradiction(s)) return false;
        *apart += s.alone[0] + s.alone[1];
    }
    return may_be_same_maker(x, y, camera, own_maker, *apart);
}

bool lp_may_match(const lp_words *requested, const char *stored) {
    for (uint32_t i = 0; i < requested->count; i++)
        if (requested->word[i].kind == LP_WORD_NUMBER && !strstr(stored, requested->word[i].text)) return false;
    return true;
}

double lp_words_match(const lp_words *requested, const char *stored, const char *camera_maker, uint32_t *apart) {
    lp_words x, y = *requested;
    *apart = 0;
    if (!lp_split_words(stored, &x) || !match(&x, &y, camera_maker, apart)) return 0.0;
    return *apart ? WORDS_MISSING : SAME_WORDS;
}

double lp_words_score(const char *a, const char *b, const char *camera_maker) {
    lp_words x;
    uint32_t apart;
    return lp_split_words(a, &x) ? lp_words_match(&x, b, camera_maker, &apart) : 0.0;
}

static double weight(const lp_word *word) { return word->kind == LP_WORD_NUMBER ? 3.0 : 1.0; }

double lp_words_likeness(const char *a, const char *b, const char *camera_maker) {
    char camera[LP_NAME_BYTES];
    lp_words x, y;
    if (!lp_split_words(a, &x) || !lp_split_words(b, &y)) return 0.0;
    double common = 0.0, all = 0.0;
    for (uint32_t i = 0; i < x.count; i++) {
        const double w = weight(&x.word[i]);
        all += w;
        if (has(&y, x.word[i].text, x.word[i].kind)) common += w;
    }
    for (uint32_t i = 0; i < y.count; i++)
        if (!has(&x, y.word[i].text, y.word[i].kind)) all += weight(&y.word[i]);
    lp_squeeze(camera_maker, camera);
    const char *first_maker = x.makers ? x.maker[0] : lp_maker_in_front(camera),
               *second_maker = y.makers ? y.maker[0] : lp_maker_in_front(camera);
    const double likeness = all > 0.0 ? common / all : 0.0;
    return first_maker && second_maker && strcmp(first_maker, second_maker) ? 0.5 * likeness : likeness;
}
