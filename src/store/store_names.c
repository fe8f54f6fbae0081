#include "store_names.h"

#include <string.h>

/* Squeezed; longer ones first where one begins with another. */
static const char *const makers[] = {"canon",    "nikon",   "nikkor",  "sony",      "sigma",     "tamron",  "tokina",
                                     "samyang",  "rokinon", "pentax",  "olympus",   "panasonic", "leica",   "fujifilm",
                                     "carlzeiss", "zeiss",  "minolta", "voigtlander", "laowa",   "viltrox", "ricoh"};

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

void lp_squeeze(const char *name, char *text)
{
    uint32_t n = 0;
    for (; *name && n + 1 < LP_NAME_BYTES; name++)
        if (!strchr(" -/.()", *name)) text[n++] = lower(*name);
    text[n] = 0;
}

/* Behind a maker's name in front, or the whole. */
static const char *without_maker(const char *squeezed)
{
    for (uint32_t i = 0; i < sizeof makers / sizeof *makers; i++) {
        const size_t length = strlen(makers[i]);
        if (!strncmp(squeezed, makers[i], length) && squeezed[length]) return squeezed + length;
    }
    return squeezed;
}

static int is_same_but_for_case(const char *a, const char *b)
{
    while (*a == ' ') a++;
    while (*b == ' ') b++;
    while (*a && lower(*a) == lower(*b)) a++, b++;
    return strspn(a, " ") == strlen(a) && strspn(b, " ") == strlen(b);
}

double lp_name_score(const char *a, const char *b)
{
    char x[LP_NAME_BYTES], y[LP_NAME_BYTES];
    if (is_same_but_for_case(a, b)) return 1.0;
    lp_squeeze(a, x);
    lp_squeeze(b, y);
    if (!strcmp(x, y)) return 0.9;
    return !strcmp(without_maker(x), without_maker(y)) ? 0.8 : 0.0;
}

static void add(lp_names *names, const char *front, const char *name)
{
    char whole[LP_NAME_BYTES];
    const size_t first = strlen(front), second = strlen(name);
    if (!second || first + second >= sizeof whole) return;
    memcpy(whole, front, first);
    memcpy(whole + first, name, second + 1);
    for (uint32_t i = 0; i < names->count; i++)
        if (!strcmp(names->name[i], whole)) return;
    strcpy(names->name[names->count++], whole);
}

void lp_name_variants(const char *lens, const char *camera_maker, lp_names *names)
{
    char own[LP_NAME_BYTES], maker[LP_NAME_BYTES];
    names->count = 0;
    lp_squeeze(lens, own);
    lp_squeeze(camera_maker, maker);
    const char *bare = without_maker(own);
    for (uint32_t i = 0; i < sizeof makers / sizeof *makers; i++) /* "NIKON CORPORATION" */
        if (!strncmp(maker, makers[i], strlen(makers[i]))) strcpy(maker, makers[i]);
    add(names, "", own);
    add(names, "", bare);
    if (bare == own) add(names, maker, own);
}
