/* Names of lenses compared word by word, where nothing else finds one. */
#include "store/names/names.h"

#include <stdlib.h>
#include <string.h>

#define MOST_WORDS 32
#define WORD_BYTES 24

/* Letters and numbers apart: "EF24-70mm f/2.8L II" has ef 24 70 l ii 2.8. */
typedef struct words {
    uint32_t count, numbers;
    char word[MOST_WORDS][WORD_BYTES];
    const char *maker; /* NULL = none is named */
} words;

static int is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c & 0x80); }
static int is_digit(char c) { return c >= '0' && c <= '9'; }

static int says_nothing(const char *word) {
    static const char *const idle[] = {"lens", "mm", "f", "mark", "mk", "carl"};
    for (size_t i = 0; i < sizeof idle / sizeof *idle; i++)
        if (!strcmp(word, idle[i])) return 1;
    return 0;
}

static int add_word(words *all, const char *word) {
    const char *maker = lp_maker_of(word);
    if (maker && !all->maker) all->maker = maker;
    if (maker || says_nothing(word)) return 1;
    if (all->count == MOST_WORDS) return 0;
    memcpy(all->word[all->count++], word, WORD_BYTES);
    return 1;
}

/* The number at `text`, without zeros that say nothing: 24.0 is 24; and not the 1 of "1:2.8". Returns what follows.
 */
static const char *take_number(words *all, const char *text, int *fits) {
    char word[WORD_BYTES] = "";
    size_t n = 0;
    int has_point = 0;
    while (*text == '0' && is_digit(text[1])) text++;
    for (; is_digit(*text) || (*text == '.' && is_digit(text[1]) && !has_point); text++) {
        has_point |= *text == '.';
        if (n + 1 < sizeof word) word[n++] = *text;
    }
    if (!strcmp(word, "1") && *text == ':') return text;
    while (has_point && n && word[n - 1] == '0') word[--n] = 0;
    if (has_point && n && word[n - 1] == '.') word[--n] = 0;
    all->numbers++;
    *fits &= add_word(all, word);
    return text;
}

static int compare(const void *a, const void *b) { return strcmp(a, b); }

/* False for a name of too many words. */
static int split(const char *name, words *all) {
    int fits = 1;
    memset(all, 0, sizeof *all);
    while (*name && fits) {
        char word[WORD_BYTES] = "";
        size_t n = 0;
        if (is_digit(*name)) {
            name = take_number(all, name, &fits);
            continue;
        }
        if (!is_letter(*name)) {
            name++;
            continue;
        }
        for (; is_letter(*name); name++)
            if (n + 1 < sizeof word) word[n++] = *name >= 'A' && *name <= 'Z' ? (char)(*name - 'A' + 'a') : *name;
        if (!strcmp(word, "for") && all->count) break; /* the mount */
        const size_t mark = !strncmp(word, "mkii", 4) ? 2 : !strncmp(word, "markii", 6) ? 4 : 0;
        memmove(word, word + mark, sizeof word - mark); /* the generation alone */
        fits = add_word(all, word);
    }
    qsort(all->word, all->count, WORD_BYTES, compare);
    return fits;
}

double lp_words_score(const char *a, const char *b, const char *camera_maker) {
    char camera[LP_NAME_BYTES];
    words x, y;
    if (!split(a, &x) || !split(b, &y) || !x.numbers || x.count != y.count) return 0.0;
    if (x.maker && y.maker && strcmp(x.maker, y.maker)) return 0.0;
    lp_squeeze(camera_maker, camera);
    const char *own = lp_maker_in_front(camera), *named = x.maker ? x.maker : y.maker;
    if (!x.maker != !y.maker && *camera && (!own || strcmp(own, named))) return 0.0;
    for (uint32_t i = 0; i < x.count; i++)
        if (strcmp(x.word[i], y.word[i])) return 0.0;
    return 0.6;
}

static double weight(const char *word) { return is_digit(*word) ? 3.0 : 1.0; }

double lp_words_likeness(const char *a, const char *b, const char *camera_maker) {
    char camera[LP_NAME_BYTES];
    words x, y;
    if (!split(a, &x) || !split(b, &y)) return 0.0;
    double common = 0.0, all = 0.0;
    uint32_t i = 0, j = 0;
    while (i < x.count || j < y.count) {
        const int order = i == x.count ? 1 : j == y.count ? -1 : strcmp(x.word[i], y.word[j]);
        const double w = weight(order <= 0 ? x.word[i] : y.word[j]);
        all += w;
        if (!order) common += w;
        i += order <= 0, j += order >= 0;
    }
    lp_squeeze(camera_maker, camera);
    const char *own = x.maker ? x.maker : lp_maker_in_front(camera),
               *other = y.maker ? y.maker : lp_maker_in_front(camera);
    const double share = all > 0.0 ? common / all : 0.0;
    return own && other && strcmp(own, other) ? 0.5 * share : share;
}
