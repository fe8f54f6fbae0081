/* Helpers for the tests of Hugin projects. */
#ifndef LENSPROF_TESTS_PTO_SUPPORT_H
#define LENSPROF_TESTS_PTO_SUPPORT_H

#include "support.h"

#include <lensprof/formats.h>

/* A project that uses every construct. Some tests depend on its line numbers. */
#define SAMPLE_PTO                                                                                                   \
    "# hugin project file\n"                                                                                         \
    "#hugin_ptoversion 2\n"                                                                                          \
    "p f2 w3000 h1500 v360  k0 E11.5 R0 S10,2990,5,1400 n\"TIFF_m c:LZW r:CROP\"\n"                                  \
    "m i0\n"                                                                                                         \
    "\n"                                                                                                             \
    "#-hugin  cropFactor=1.5\n"                                                                                      \
    "i w400 h300 f0 v55.5 Ra0.5 Rb-0.25 Rc0.125 Rd1e-2 Re-.5 Eev11.5 Er1.25 Eb0.75 r1.5 p-2.5 y10 TrX0.1 TrY0.2 "    \
    "TrZ-0.3 Tpy4 Tpp-5 j0 a0.01 b-0.02 c0.03 d4 e-5 g6 t-7 Va1 Vb-0.3 Vc0.1 Vd-0.05 Vx25 Vy-50  Vm5 "               \
    "n\"first picture.jpg\"\n"                                                                                       \
    "#-hugin  cropFactor=1.5 disabled\n"                                                                             \
    "i w400 h300 f0 v=0 Ra=0 Rb=0 Rc=0 Rd=0 Re=0 Eev12.5 Er=0 Eb1 r0 p0 y-20 TrX0 TrY0 TrZ0 Tpy0 Tpp0 j=0 "          \
    "a=0 b=0 c=0 d=0 e=0 g=0 t=0 Va=0 Vb=0 Vc=0 Vd=0 Vx=0 Vy=0 S20,380,30,290 Vm5 n\"second.jpg\"\n"                 \
    "i w500 h500 f3 v=1 Ra=1 Rb=1 Rc=1 Rd=1 Re=1 Eev=1 Er=1 Eb=1 r0 p0 y30 j0 a=1 b=1 c=1 Va=1 Vb=1 Vc=1 Vd=1 Vx=1 " \
    "Vy=1 C-10,490,0,500 Vm5 n\"third.jpg\"\n"                                                                       \
    "i w200 h100\n"                                                                                                  \
    "\n"                                                                                                             \
    "v Ra1 Vb2 Vc0\n"                                                                                                \
    "v Vx0\n"                                                                                                        \
    "v Eev2 Er1 Eb3 y1 TrX2 v0\n"                                                                                    \
    "v\n"                                                                                                            \
    "\n"                                                                                                             \
    "c n0 N1 x40.3 y38.7 X240.1 Y46.1 t0\n"                                                                          \
    "k i0 t0 p\"10 20 30 20 30 40 10 40\"\n"                                                                         \
    "k i2 t4 p\"100 100 200 100 150 200\"\n"                                                                         \
    "z unknown record\n"                                                                                             \
    "#hugin_optimizeReferenceImage 0\n"

static inline lensprof_pto *read_pto(const char *text) {
    lensprof_pto *pto = NULL;
    lensprof_error error;
    lensprof_status status = lensprof_pto_read(text, strlen(text), &pto, &error);
    if (status != LENSPROF_OK) print_error("%s\n", error.text);
    assert_ok(status);
    assert_string_equal(error.text, "");
    assert_non_null(pto);
    return pto;
}

static inline lensprof_pto_image image_of(const lensprof_pto *pto, uint32_t index) {
    lensprof_pto_image image;
    lensprof_pto_image_init(&image);
    assert_ok(lensprof_pto_get_image(pto, index, &image, NULL));
    return image;
}

/* The project as a string; the caller frees it. */
static inline char *write_pto(const lensprof_pto *pto) {
    size_t bytes = 0, again = 0;
    assert_ok(lensprof_pto_write(pto, NULL, 0, &bytes, NULL));
    char *text = malloc(bytes + 1);
    assert_ok(lensprof_pto_write(pto, text, bytes + 1, &again, NULL));
    assert_int_equal(again, bytes);
    assert_int_equal(text[bytes], '\0');
    return text;
}

/* Value of an item of the nth `i` line of a project text, or NULL; static storage. */
static inline const char *item_of(const char *text, int n, const char *name) {
    static char value[64];
    const char *line = text;
    while (line && n >= 0) {
        if (line[0] == 'i' && line[1] == ' ' && n-- == 0) break;
        line = strchr(line, '\n');
        if (line) line++;
    }
    assert_non_null(line);
    char key[16];
    snprintf(key, sizeof key, " %s", name);
    const char *end = line + strcspn(line, "\r\n"), *found = strstr(line, key);
    if (!found || found >= end) return NULL;
    found += strlen(key);
    snprintf(value, sizeof value, "%.*s", (int)strcspn(found, " \t\r\n"), found);
    return value;
}

#endif
