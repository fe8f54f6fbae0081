/* The options of the demonstrations, and rows as text. */
#ifndef DEMO_H
#define DEMO_H

#include "board.h"
#include "data.h"

/* All but the profile. Exposures are whole stops: 2^ev is exact on every machine. */
static inline void set_options(lensprof_apply_options *options) {
    lensprof_apply_options_init(options);
    options->frame_width = FRAME_WIDTH;
    options->frame_height = FRAME_HEIGHT;
    options->source.white_balance[0] = 1.25;
    options->target.ev = 1.0;
    options->gain_cap = 4.0;
}

static inline void put_number(const char *before, uint32_t number) {
    char text[12], *p = text + sizeof text;
    for (*--p = '\0'; number || p == text + sizeof text - 1; number /= 10) *--p = (char)('0' + number % 10);
    put_text(before);
    put_text(p);
    put_text("\n");
}

/* "name: hexadecimal bytes" */
static inline void put_bytes(const char *name, const uint8_t *bytes, uint32_t count) {
    static const char digits[] = "0123456789abcdef";
    char text[3] = {0};
    put_text(name);
    put_text(": ");
    for (uint32_t i = 0; i < count; i++) {
        text[0] = digits[bytes[i] >> 4], text[1] = digits[bytes[i] & 15];
        put_text(text);
    }
    put_text("\n");
}

static inline void put_row(const char *name, const uint8_t *row) { put_bytes(name, row, 3 * STRIP_WIDTH); }

#endif
