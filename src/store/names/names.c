#include "store/names/names.h"

#include <stddef.h>
#include <string.h>

/* Spellings of makers in EXIF and in names of lenses (own observation), squeezed; longer ones first where one begins
 * with another. */
static const struct spelling {
    const char *text, *maker;
} spellings[] = {
    {"canoninc", "canon"},
    {"canon", "canon"},
    {"nikoncorporation", "nikon"},
    {"nikkor", "nikon"},
    {"nikon", "nikon"},
    {"sony", "sony"},
    {"olympusimagingcorp", "olympus"},
    {"olympusopticalco,ltd", "olympus"},
    {"olympuscorporation", "olympus"},
    {"olympus", "olympus"},
    {"omdigitalsolutions", "olympus"},
    {"omsystem", "olympus"},
    {"fujifilmcorporation", "fujifilm"},
    {"fujiphotofilmco,ltd", "fujifilm"},
    {"fujifilm", "fujifilm"},
    {"fujinon", "fujifilm"},
    {"fuji", "fujifilm"},
    {"pentaxricohimaging", "pentax"},
    {"pentaxcorporation", "pentax"},
    {"ricohimagingcompany,ltd", "pentax"},
    {"asahioptical", "pentax"},
    {"pentax", "pentax"},
    {"ricoh", "ricoh"},
    {"panasonic", "panasonic"},
    {"lumix", "panasonic"},
    {"leicacameraag", "leica"},
    {"leica", "leica"},
    {"samsungtechwin", "samsung"},
    {"samsungelectronics", "samsung"},
    {"samsung", "samsung"},
    {"eastmankodakcompany", "kodak"},
    {"kodak", "kodak"},
    {"konicaminoltacamera,inc", "minolta"},
    {"konicaminolta", "minolta"},
    {"minolta", "minolta"},
    {"carlzeiss", "zeiss"},
    {"zeiss", "zeiss"},
    {"casiocomputerco,ltd", "casio"},
    {"casio", "casio"},
    {"hasselblad", "hasselblad"},
    {"sigma", "sigma"},
    {"tamron", "tamron"},
    {"tokina", "tokina"},
    {"samyang", "samyang"},
    {"rokinon", "samyang"},
    {"voigtlander", "voigtlander"},
    {"laowa", "laowa"},
    {"venus", "laowa"},
    {"viltrox", "viltrox"},
    {"apple", "apple"},
    {"google", "google"},
    {"huawei", "huawei"},
    {"xiaomi", "xiaomi"},
};
#define SPELLINGS (sizeof spellings / sizeof *spellings)

/* One camera under three names, without its maker: Europe, America, Japan. */
static const char *const cameras[][LP_CAMERA_NAMES] = {
    {"eos300ddigital", "eosdigitalrebel", "eoskissdigital"},
    {"eos350ddigital", "eosdigitalrebelxt", "eoskissdigitaln"},
    {"eos400ddigital", "eosdigitalrebelxti", "eoskissdigitalx"},
    {"eos450d", "eosdigitalrebelxsi", "eoskissx2"},
    {"eos500d", "eosrebelt1i", "eoskissx3"},
    {"eos550d", "eosrebelt2i", "eoskissx4"},
    {"eos600d", "eosrebelt3i", "eoskissx5"},
    {"eos650d", "eosrebelt4i", "eoskissx6i"},
    {"eos700d", "eosrebelt5i", "eoskissx7i"},
    {"eos750d", "eosrebelt6i", "eoskissx8i"},
    {"eos800d", "eosrebelt7i", "eoskissx9i"},
    {"eos100d", "eosrebelsl1", "eoskissx7"},
    {"eos200d", "eosrebelsl2", "eoskissx9"},
    {"eos1000d", "eosdigitalrebelxs", "eoskissf"},
    {"eos1100d", "eosrebelt3", "eoskissx50"},
    {"eos1200d", "eosrebelt5", "eoskissx70"},
    {"eos1300d", "eosrebelt6", "eoskissx80"},
};

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

void lp_squeeze(const char *name, char *text) {
    uint32_t n = 0;
    for (; *name && n + 1 < LP_NAME_BYTES; name++)
        if (!strchr(" -/.()", *name)) text[n++] = lower(*name);
    text[n] = 0;
}

static const struct spelling *spelling_in_front(const char *squeezed) {
    for (size_t i = 0; i < SPELLINGS; i++)
        if (!strncmp(squeezed, spellings[i].text, strlen(spellings[i].text))) return &spellings[i];
    return NULL;
}

const char *lp_maker_of(const char *word) {
    for (size_t i = 0; i < SPELLINGS; i++)
        if (*word == *spellings[i].text && !strcmp(word, spellings[i].text)) return spellings[i].maker;
    return NULL;
}

bool lp_makes_lenses_alone(const char *maker) {
    static const char *const alone[] = {"sigma", "tamron",      "tokina", "samyang",
                                        "zeiss", "voigtlander", "laowa",  "viltrox"};
    for (size_t i = 0; i < sizeof alone / sizeof *alone; i++)
        if (!strcmp(maker, alone[i])) return true;
    return false;
}

const char *lp_maker_in_front(const char *squeezed) {
    const struct spelling *found = spelling_in_front(squeezed);
    return found ? found->maker : NULL;
}

/* The text after leading makers' names ("Panasonic Lumix"), or the whole; *maker is the first of them, or NULL. */
static const char *without_maker(const char *squeezed, const char **maker) {
    const struct spelling *found;
    *maker = NULL;
    while ((found = spelling_in_front(squeezed)) && squeezed[strlen(found->text)]) {
        if (*maker && strcmp(*maker, found->maker)) break;
        *maker = found->maker;
        squeezed += strlen(found->text);
    }
    return squeezed;
}

const char *lp_without_maker(const char *squeezed) {
    const char *maker;
    return without_maker(squeezed, &maker);
}

static int is_same_but_for_case(const char *a, const char *b) {
    while (*a == ' ') a++;
    while (*b == ' ') b++;
    while (*a && lower(*a) == lower(*b)) a++, b++;
    return strspn(a, " ") == strlen(a) && strspn(b, " ") == strlen(b);
}

static int is_same_camera(const char *a, const char *b) {
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras; i++) {
        int has_a = 0, has_b = 0;
        for (int n = 0; n < 3; n++) has_a |= !strcmp(cameras[i][n], a), has_b |= !strcmp(cameras[i][n], b);
        if (has_a && has_b) return 1;
    }
    return 0;
}

double lp_name_score(const char *a, const char *b) {
    char x[LP_NAME_BYTES], y[LP_NAME_BYTES];
    const char *maker_x, *maker_y;
    if (is_same_but_for_case(a, b)) return 1.0;
    lp_squeeze(a, x);
    lp_squeeze(b, y);
    if (!strcmp(x, y)) return 0.9;
    const char *bare_x = without_maker(x, &maker_x), *bare_y = without_maker(y, &maker_y);
    if (maker_x && maker_y && strcmp(maker_x, maker_y)) return 0.0;
    return !strcmp(bare_x, bare_y) || is_same_camera(bare_x, bare_y) ? 0.8 : 0.0;
}

bool lp_is_standard(const char *lens) { return strstr(lens, "(Standard)") != NULL; }

int lp_is_same_maker(const char *a, const char *b) {
    char x[LP_NAME_BYTES], y[LP_NAME_BYTES];
    lp_squeeze(a, x);
    lp_squeeze(b, y);
    const struct spelling *of_x = spelling_in_front(x), *of_y = spelling_in_front(y);
    if (of_x && of_y) return !strcmp(of_x->maker, of_y->maker);
    return !strncmp(x, y, strlen(x) < strlen(y) ? strlen(x) : strlen(y));
}

uint32_t lp_camera_names(const char *squeezed, const char *names[LP_CAMERA_NAMES]) {
    uint32_t count = 0;
    for (size_t i = 0; i < sizeof cameras / sizeof *cameras && !count; i++)
        for (int index = 0; index < LP_CAMERA_NAMES; index++) {
            if (strcmp(cameras[i][index], squeezed)) continue;
            for (int n = 0; n < LP_CAMERA_NAMES; n++) names[count++] = cameras[i][n];
            break;
        }
    if (!count) names[count++] = squeezed;
    return count;
}

static void add(lp_names *names, const char *front, const char *name) {
    char combined[LP_NAME_BYTES];
    const size_t first = strlen(front), second = strlen(name);
    if (!second || first + second >= sizeof combined || names->count == LP_NAME_VARIANTS) return;
    memcpy(combined, front, first);
    memcpy(combined + first, name, second + 1);
    for (uint32_t i = 0; i < names->count; i++)
        if (!strcmp(names->name[i], combined)) return;
    strcpy(names->name[names->count++], combined);
}

void lp_name_variants(const char *lens, const char *camera_maker, lp_names *names) {
    char squeezed[LP_NAME_BYTES], camera[LP_NAME_BYTES];
    const char *maker;
    names->count = 0;
    lp_squeeze(lens, squeezed);
    lp_squeeze(camera_maker, camera);
    const char *bare = without_maker(squeezed, &maker);
    const struct spelling *of_camera = spelling_in_front(camera);
    add(names, "", squeezed);
    add(names, "", bare);
    if (!maker) add(names, of_camera ? of_camera->maker : camera, squeezed);
    if (!maker && of_camera) maker = of_camera->maker;
    if (maker) add(names, maker, squeezed); /* "Nikon Nikkor Z 50mm" */
    for (size_t i = 0; maker && i < SPELLINGS; i++)
        if (!strcmp(spellings[i].maker, maker)) add(names, spellings[i].text, bare);
}
