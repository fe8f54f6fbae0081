/* Names of lenses read word by word. */
#include "store/names/words.h"

#include <stdio.h>
#include <string.h>

#include "store/names/names.h"

#define SHORTEST_CODE 2 /* digits */

static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c & 0x80); }
static bool is_digit(char c) { return c >= '0' && c <= '9'; }
static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

static bool is_one_of(const char *word, const char *const *list, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!strcmp(word, list[i])) return true;
    return false;
}
#define IS_ONE_OF(word, list) is_one_of(word, list, sizeof(list) / sizeof *(list))

static bool is_filler_word(const char *word) {
    static const char *const idle[] = {"lens", "mm", "f", "mark", "mk", "carl", "compatibles"};
    return IS_ONE_OF(word, idle);
}

static bool is_generation(const char *word) {
    static const char *const generations[] = {"ii", "iii", "iv"};
    return IS_ONE_OF(word, generations);
}

bool lp_is_common_word(const char *word) {
    static const char *const common[] = {"af", "mf", "mc", "macro", "micro", "fisheye", "pro"};
    return is_generation(word) || IS_ONE_OF(word, common);
}

/* Where a name is being read. */
typedef struct reading {
    lp_words *words;
    const char *text;
    char bracket;       /* that is open, or 0 */
    bool follows_bar;   /* "| Contemporary 016" */
    bool follows_plus;  /* "+ 1.4x": words of what is attached, which are never the lens's */
    bool follows_macro; /* "Macro 1:2" */
    uint32_t numbers;
} reading;

static bool add(reading *r, const char *text, lp_word_kind kind) {
    lp_words *w = r->words;
    if (w->count == LP_MOST_WORDS) return false;
    lp_word *word = &w->word[w->count++];
    memset(word, 0, sizeof *word);
    word->kind = r->follows_plus ? LP_WORD_IDENTITY : kind;
    snprintf(word->text, sizeof word->text, "%s%.*s", r->follows_plus ? "+" : "", LP_WORD_BYTES - 2, text);
    r->numbers += kind == LP_WORD_NUMBER;
    return true;
}

/* The letters at the text, in small ones; returns what follows. */
static const char *take_letters(const char *text, char *word) {
    size_t n = 0;
    for (; is_letter(*text); text++)
        if (n + 1 < LP_WORD_BYTES) word[n++] = lower(*text);
    word[n] = 0;
    return text;
}

/* Sigma's lines, which have one letter after a bar or in brackets. */
static const char *line_of(const reading *r, const char *word) {
    if (!r->follows_bar && r->bracket != '[') return word;
    return !strcmp(word, "a") ? "art" : !strcmp(word, "c") ? "contemporary" : !strcmp(word, "s") ? "sports" : word;
}

/* "diii" is di and ii, "mkii" and "markii" ii; returns the second part, after *first, or NULL. */
static const char *generation_in(char *word, const char **first) {
    *first = NULL;
    const size_t mark = !strncmp(word, "mk", 2) ? 2 : !strncmp(word, "mark", 4) ? 4 : !strncmp(word, "di", 2) ? 2 : 0;
    if (!mark || !is_generation(word + mark)) return NULL;
    if (*word == 'd') *first = "di";
    return word + mark;
}

static bool add_letters(reading *r, char *word) {
    const char *maker = lp_maker_of(word), *first;
    if (maker) {
        if (r->words->makers < LP_MOST_MAKERS) r->words->maker[r->words->makers++] = maker;
        return true;
    }
    if (is_filler_word(word)) return true;
    const char *generation = generation_in(word, &first);
    if (generation) return (!first || add(r, first, LP_WORD_IDENTITY)) && add(r, generation, LP_WORD_IDENTITY);
    if (!strcmp(word, "eye")) return true; /* "fish-eye" */
    if (!strcmp(word, "fish")) return add(r, "fisheye", LP_WORD_IDENTITY);
    const char *line = line_of(r, word);
    return add(r, line, r->bracket == '(' ? LP_WORD_OPTIONAL : LP_WORD_IDENTITY);
}

/* Length of a code at the text, 0 for none: letters followed by two or more digits and nothing else, "A032"; in
 * round brackets also with more letters. "F4" and "F16" are not codes, but "F045" is. */
static size_t code_at(const reading *r) {
    const char *text = r->text;
    size_t letters = 0, digits = 0;
    while (is_letter(text[letters])) letters++;
    while (is_digit(text[letters + digits])) digits++;
    if (digits < SHORTEST_CODE || (letters == 1 && lower(*text) == 'f' && !(text[1] == '0' && digits > 2))) return 0;
    size_t n = letters + digits;
    if (r->bracket == '(') {
        while (is_letter(text[n]) || is_digit(text[n])) n++;
        return letters ? n : 0;
    }
    if (!letters && !(*text == '0' && digits == 3)) return 0;
    return is_letter(text[n]) || (text[n] && strchr("-./", text[n]) && is_digit(text[n + 1])) ? 0 : n;
}

static bool take_code(reading *r, size_t length) {
    char word[LP_WORD_BYTES] = "";
    for (size_t i = 0; i < length && i + 1 < sizeof word; i++) word[i] = lower(r->text[i]);
    r->text += length;
    return add(r, word, LP_WORD_CODE);
}

/* At the end of a name that has its numbers already: "AF Nikkor 35mm f/2D 66", Nikon's number of the lens. */
static bool is_trailing_code(const reading *r, const char *end) {
    return r->numbers >= 2 && end - r->text >= SHORTEST_CODE && !strchr(r->text, '.') && !end[strspn(end, " ")]
           && r->text[-1] == ' ';
}

/* The number at the text, without redundant zeros: 24.0 is 24; and not the 1 of "1:2.8". */
static bool take_number(reading *r) {
    char word[LP_WORD_BYTES] = "";
    size_t n = 0;
    bool has_point = false;
    const char *end = r->text;
    while (*end == '0' && is_digit(end[1])) end++;
    for (; is_digit(*end) || (*end == '.' && is_digit(end[1]) && !has_point); end++) {
        has_point |= *end == '.';
        if (n + 1 < sizeof word) word[n++] = *end;
    }
    const bool is_ratio = !strcmp(word, "1") && *end == ':';
    if (is_ratio && r->follows_macro && r->numbers >= 2) { /* a scale */
        r->text = end + 1 + strspn(end + 1, "0123456789.");
        return true;
    }
    while (has_point && n && word[n - 1] == '0') word[--n] = 0;
    if (has_point && n && word[n - 1] == '.') word[--n] = 0;
    const bool is_times = lower(*end) == 'x' && !is_letter(end[1]) && n + 1 < sizeof word;
    if (is_times) word[n] = 'x';
    const lp_word_kind kind = is_times ? LP_WORD_IDENTITY : is_trailing_code(r, end) ? LP_WORD_CODE : LP_WORD_NUMBER;
    r->text = end + is_times;
    return is_ratio || add(r, word, kind);
}

/* Words that follow one another with slashes between, as "II/L/WR", or as "II L WR", where file names allow none. */
static void mark_variants(lp_words *words, uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; i++) words->word[i].kind = LP_WORD_VARIANT;
}

static void find_versions(lp_words *words) {
    static const char *const versions[] = {"ii", "iii", "l", "wr"};
    for (uint32_t i = 0, run = 0; i < words->count; i++) {
        run = IS_ONE_OF(words->word[i].text, versions) ? run + 1 : 0;
        if (run >= 3) mark_variants(words, i + 1 - run, run);
    }
}

/* Letters that are not a code; false if the name is full. Sets *done at "for Canon EF". */
static bool take_word(reading *r, bool *done) {
    char word[LP_WORD_BYTES];
    const uint32_t before = r->words->count;
    const bool is_after_slash = before > 0 && r->text[-1] == '/' && is_letter(r->text[-2]);
    r->text = take_letters(r->text, word);
    *done = !strcmp(word, "for") && before;
    if (*done) return true;
    if (!strcmp(word, "g") && is_digit(*r->text) && !is_digit(r->text[1]) && !is_letter(r->text[1])) { /* "G2" */
        word[1] = *r->text++, word[2] = 0;
        return add(r, word, LP_WORD_IDENTITY);
    }
    if (!add_letters(r, word)) return false;
    r->follows_macro = !strcmp(word, "macro");
    if (is_after_slash && r->words->count == before + 1) mark_variants(r->words, before - 1, 2);
    return true;
}

/* A sign, which may change the kind of the words after it. */
static void take_sign(reading *r) {
    const char c = *r->text++;
    if (c == '(' || c == '[') r->bracket = c;
    if (c == ')' || c == ']') r->bracket = 0;
    if (c == '|') r->follows_bar = true;
    if (c == '+') r->follows_plus = true;
}

bool lp_split_words(const char *name, lp_words *words) {
    reading r = {words, name, 0, false, false, false, 0};
    bool fits = true, done = false;
    words->count = words->makers = 0;
    while (*r.text && fits && !done) {
        const size_t code = is_letter(*r.text) || is_digit(*r.text) ? code_at(&r) : 0;
        if (code)
            fits = take_code(&r, code);
        else if (is_digit(*r.text))
            fits = take_number(&r);
        else if (is_letter(*r.text))
            fits = take_word(&r, &done);
        else
            take_sign(&r);
    }
    find_versions(words);
    return fits;
}

/* Words that names have or have not, as one likes; of the lenses of one maker, or (NULL) of any. */
static const struct optional {
    const char *word, *maker;
    lp_word_kind kind;
} optional[] = {
    {"asph", NULL, LP_WORD_OPTIONAL},        {"aspherical", NULL, LP_WORD_OPTIONAL},
    {"ed", NULL, LP_WORD_OPTIONAL},          {"if", NULL, LP_WORD_OPTIONAL},
    {"ld", NULL, LP_WORD_OPTIONAL},          {"zoom", NULL, LP_WORD_OPTIONAL},
    {"art", NULL, LP_WORD_OPTIONAL},         {"dual", "apple", LP_WORD_OPTIONAL},
    {"triple", "apple", LP_WORD_OPTIONAL},   {"fx", "nikon", LP_WORD_OPTIONAL},
    {"zuiko", "olympus", LP_WORD_OPTIONAL},  {"digital", "olympus", LP_WORD_OPTIONAL},
    {"pro", "olympus", LP_WORD_OPTIONAL},    {"is", "olympus", LP_WORD_OPTIONAL},
    {"g", "panasonic", LP_WORD_OPTIONAL},    {"x", "panasonic", LP_WORD_OPTIONAL},
    {"hd", "panasonic", LP_WORD_OPTIONAL},   {"vario", "panasonic", LP_WORD_OPTIONAL},
    {"mega", "panasonic", LP_WORD_OPTIONAL}, {"power", "panasonic", LP_WORD_OPTIONAL},
    {"ois", "panasonic", LP_WORD_OPTIONAL},  {"vario", "leica", LP_WORD_OPTIONAL},
    {"power", "leica", LP_WORD_OPTIONAL},    {"ois", "leica", LP_WORD_OPTIONAL},
    {"al", "pentax", LP_WORD_OPTIONAL},      {"af", "tamron", LP_WORD_OPTIONAL},
    {"sp", "tamron", LP_WORD_OPTIONAL},      {"xr", "tamron", LP_WORD_OPTIONAL},
    {"model", "tamron", LP_WORD_OPTIONAL},   {"t", "zeiss", LP_WORD_OPTIONAL},
    {"t", "sony", LP_WORD_OPTIONAL},         {"summilux", NULL, LP_WORD_DESIGN},
    {"summicron", NULL, LP_WORD_DESIGN},     {"summarit", NULL, LP_WORD_DESIGN},
    {"elmarit", NULL, LP_WORD_DESIGN},       {"elmar", NULL, LP_WORD_DESIGN},
    {"noctilux", NULL, LP_WORD_DESIGN},      {"nocticron", NULL, LP_WORD_DESIGN},
    {"planar", NULL, LP_WORD_DESIGN},        {"sonnar", NULL, LP_WORD_DESIGN},
    {"distagon", NULL, LP_WORD_DESIGN},      {"tessar", NULL, LP_WORD_DESIGN},
    {"biogon", NULL, LP_WORD_DESIGN},
};

static lp_word_kind kind_of(const char *word, const char *const *makers, uint32_t count) {
    for (size_t i = 0; i < sizeof optional / sizeof *optional; i++) {
        if (strcmp(word, optional[i].word)) continue;
        if (!optional[i].maker || is_one_of(optional[i].maker, makers, count)) return optional[i].kind;
    }
    return LP_WORD_IDENTITY;
}

void lp_weigh_words(lp_words *words, const char *const *makers, uint32_t count) {
    for (uint32_t i = 0; i < words->count; i++)
        if (words->word[i].kind == LP_WORD_IDENTITY) words->word[i].kind = kind_of(words->word[i].text, makers, count);
}
