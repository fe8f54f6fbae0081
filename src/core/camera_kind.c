/* The kind of camera that a profile's key names. Its typical response applies while the camera's own is unknown. */
#include <lensprof/profile.h>

/* Compares texts, ignoring the case of ASCII letters. */
static int lower(char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : (unsigned char)c; }

static int is_letter(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }

static int is_digit(char c) { return c >= '0' && c <= '9'; }

static int begins(const char *text, const char *word) {
    while (*word && lower(*text) == *word) text++, word++;
    return !*word;
}

/* Whether a text contains a word or words of a list as whole words: not adjacent to another letter. */
static int has_word(const char *text, const char *const *words, size_t count) {
    for (size_t w = 0; w < count; w++)
        for (const char *start = text; *start; start++) {
            if ((start > text && is_letter(start[-1])) || !begins(start, words[w])) continue;
            const char *end = start;
            for (const char *c = words[w]; *c; c++) end++;
            if (!is_letter(end[-1]) || !is_letter(*end)) return 1;
        }
    return 0;
}

#define HAS_WORD(text, words) has_word(text, words, sizeof(words) / sizeof *(words))

static const char *const phone_makers[] = {"apple",        "google",
                                           "huawei",       "honor",
                                           "xiaomi",       "redmi",
                                           "poco",         "oneplus",
                                           "oppo",         "vivo",
                                           "realme",       "htc",
                                           "motorola",     "lg",
                                           "lge",          "nokia",
                                           "hmd",          "zte",
                                           "nubia",        "meizu",
                                           "asus",         "lenovo",
                                           "tcl",          "alcatel",
                                           "wiko",         "infinix",
                                           "tecno",        "nothing",
                                           "blackberry",   "sony ericsson",
                                           "sonyericsson", "fairphone",
                                           "microsoft",    "research in motion"};

/* In a model's or lens's name. */
static const char *const phone_words[] = {"iphone",      "ipad",      "ipod",        "pixel",
                                          "xperia",      "lumia",     "back camera", "front camera",
                                          "rear camera", "back dual", "back triple", "rear main"};

static const char *const scanner_words[] = {"scanner",    "coolscan",  "noritsu",  "opticfilm",
                                            "perfection", "primefilm", "canoscan", "imacon"};

static int is_samsung_phone(const char *model) {
    static const char *const prefixes[] = {"sm-", "gt-", "sgh-", "sch-", "sph-", "shv-", "shw-", "sc-"};
    for (size_t i = 0; i < sizeof prefixes / sizeof *prefixes; i++)
        if (begins(model, prefixes[i])) return 1;
    return begins(model, "galaxy") && !begins(model, "galaxy nx") && !begins(model, "galaxy camera");
}

/* Sony's phones are XQ-CT72, SO-01K, SOV36, or a letter and four digits from C6903 to J9210. */
static int is_sony_phone(const char *model) {
    if (begins(model, "xq-") || begins(model, "so-") || begins(model, "sov") || begins(model, "sog")) return 1;
    return lower(model[0]) >= 'c' && lower(model[0]) <= 'j' && is_digit(model[1]) && is_digit(model[2])
           && is_digit(model[3]) && is_digit(model[4]);
}

static int is_phone(const lensprof_profile_key *key) {
    static const char *const samsung[] = {"samsung"}, *const sony[] = {"sony"}, *const quicktake[] = {"quicktake"};
    const char *maker = key->camera_maker, *model = key->camera_model;
    if (HAS_WORD(model, phone_words) || HAS_WORD(key->lens, phone_words)) return 1;
    if (HAS_WORD(maker, phone_makers) || (!*maker && HAS_WORD(model, phone_makers))) return !HAS_WORD(model, quicktake);
    const char *number = model; /* models may begin with the maker's name */
    if (begins(model, "samsung ")) number += sizeof "samsung " - 1;
    if (begins(model, "sony ")) number += sizeof "sony " - 1;
    if (HAS_WORD(maker, samsung) || begins(model, "samsung ")) return is_samsung_phone(number);
    if (HAS_WORD(maker, sony) || begins(model, "sony ")) return is_sony_phone(number);
    return 0;
}

uint32_t lensprof_camera_kind_of(const lensprof_profile_key *key) {
    if (!key) return LENSPROF_CAMERA_ANY;
    if (key->processing == LENSPROF_PROCESSING_RAW) return LENSPROF_CAMERA_LINEAR;
    if (HAS_WORD(key->camera_maker, scanner_words) || HAS_WORD(key->camera_model, scanner_words))
        return LENSPROF_CAMERA_ANY; /* the medium that was scanned is unknown */
    if (is_phone(key)) return LENSPROF_CAMERA_PHONE;
    return *key->camera_maker || *key->camera_model ? LENSPROF_CAMERA_STILL : LENSPROF_CAMERA_ANY;
}
