/* One lane: plain C. This header defines the meaning of the functions in the other lane headers. */
#ifndef LENSPROF_CORE_LANES_H
#define LENSPROF_CORE_LANES_H

#include <stdint.h>
#include <string.h>

#define LANES 1
#ifndef STRIP
#define STRIP 16 /* pixels that are processed together */
#endif

typedef float lane_f;
typedef int32_t lane_i;
typedef int lane_b;

static inline lane_f f_set(float v) { return v; }
static inline lane_f f_load(const float *p) { return *p; }
static inline void f_store(float *p, lane_f v) { *p = v; }
static inline lane_f f_add(lane_f a, lane_f b) { return a + b; }
static inline lane_f f_sub(lane_f a, lane_f b) { return a - b; }
static inline lane_f f_mul(lane_f a, lane_f b) { return a * b; }
static inline lane_f f_div(lane_f a, lane_f b) { return a / b; }
static inline lane_f f_max(lane_f a, lane_f b) { return a > b ? a : b; } /* b if a is NaN */
static inline lane_f f_min(lane_f a, lane_f b) { return a < b ? a : b; }
static inline lane_b f_less(lane_f a, lane_f b) { return a < b; }
static inline lane_b f_is_number(lane_f a) { return a == a; }
static inline lane_f f_pick(lane_b is, lane_f yes, lane_f no) { return is ? yes : no; }
static inline lane_i i_pick(lane_b is, lane_i yes, lane_i no) { return is ? yes : no; }

static inline lane_i i_set(int32_t v) { return v; }
static inline lane_i i_load(const int32_t *p) { return *p; }
static inline void i_store(int32_t *p, lane_i v) { *p = v; }
static inline lane_i i_add(lane_i a, lane_i b) { return a + b; }
static inline lane_i i_sub(lane_i a, lane_i b) { return a - b; }
static inline lane_i i_and(lane_i a, lane_i b) { return a & b; }
static inline lane_i i_min(lane_i a, lane_i b) { return a < b ? a : b; }
/* of unsigned numbers */
static inline lane_i i_least(lane_i a, lane_i b) { return (uint32_t)a < (uint32_t)b ? a : b; }
#define i_left(a, n) ((lane_i)((uint32_t)(a) << (n)))
#define i_right(a, n) ((lane_i)((uint32_t)(a) >> (n))) /* shifts in zeros */

static inline lane_f f_of_i(lane_i a) { return (float)a; }
static inline lane_i i_of_f(lane_f a) { return (int32_t)a; } /* towards 0; within int32 */
static inline lane_f f_of_bits(lane_i a) {
    lane_f f;
    memcpy(&f, &a, sizeof f);
    return f;
}
static inline lane_i i_of_bits(lane_f a) {
    lane_i i;
    memcpy(&i, &a, sizeof i);
    return i;
}

/* 0, 1, 2, ... */
static inline lane_i i_count(void) { return 0; }

static inline lane_i i_load_u8(const uint8_t *p) { return *p; }
static inline void i_store_u8(uint8_t *p, lane_i v) { *p = (uint8_t)v; }
static inline lane_i i_load_u16(const uint8_t *p) {
    uint16_t v;
    memcpy(&v, p, sizeof v);
    return v;
}
static inline void i_store_u16(uint8_t *p, lane_i v) {
    uint16_t u = (uint16_t)v;
    memcpy(p, &u, sizeof u);
}

static inline lane_f f_gather(const float *base, lane_i index) { return base[index]; }
/* base[index] and the element after it */
static inline void f_gather_pair(const float *base, lane_i index, lane_f *first, lane_f *second) {
    *first = base[index];
    *second = base[index + 1];
}

/* Of every place at[0], at[1], ...: base[place] and the element after it; the four elements from there. */
static inline void f_pairs(const float *base, const int32_t *at, lane_f *first, lane_f *second) {
    *first = base[*at];
    *second = base[*at + 1];
}
static inline void f_fours(const float *base, const int32_t *at, lane_f four[4]) {
    for (int i = 0; i < 4; i++) four[i] = base[*at + i];
}

/* a0 b0 c0 a1 b1 c1 ... */
static inline void f_store3(float *p, lane_f a, lane_f b, lane_f c) { p[0] = a, p[1] = b, p[2] = c; }

#define CAN_STREAM 0 /* cannot bypass the caches */

#endif
