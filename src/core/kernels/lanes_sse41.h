/* Four lanes: SSE4.1. */
#ifndef LENSPROF_CORE_LANES_H
#define LENSPROF_CORE_LANES_H

#include <smmintrin.h>
#include <stdint.h>
#include <string.h>

#define LANES 4
#define STRIP 256

typedef __m128 lane_f;
typedef __m128i lane_i;
typedef __m128 lane_b;

static inline lane_f f_set(float v) { return _mm_set1_ps(v); }
static inline lane_f f_load(const float *p) { return _mm_loadu_ps(p); }
static inline void f_store(float *p, lane_f v) { _mm_storeu_ps(p, v); }
static inline lane_f f_add(lane_f a, lane_f b) { return _mm_add_ps(a, b); }
static inline lane_f f_sub(lane_f a, lane_f b) { return _mm_sub_ps(a, b); }
static inline lane_f f_mul(lane_f a, lane_f b) { return _mm_mul_ps(a, b); }
static inline lane_f f_div(lane_f a, lane_f b) { return _mm_div_ps(a, b); }
static inline lane_f f_max(lane_f a, lane_f b) { return _mm_max_ps(a, b); }
static inline lane_f f_min(lane_f a, lane_f b) { return _mm_min_ps(a, b); }
static inline lane_b f_less(lane_f a, lane_f b) { return _mm_cmplt_ps(a, b); }
static inline lane_b f_is_number(lane_f a) { return _mm_cmpeq_ps(a, a); }
static inline lane_f f_pick(lane_b is, lane_f yes, lane_f no) { return _mm_blendv_ps(no, yes, is); }
static inline lane_i i_pick(lane_b is, lane_i yes, lane_i no) { return _mm_blendv_epi8(no, yes, _mm_castps_si128(is)); }

static inline lane_i i_set(int32_t v) { return _mm_set1_epi32(v); }
static inline lane_i i_load(const int32_t *p) { return _mm_loadu_si128((const __m128i *)(const void *)p); }
static inline void i_store(int32_t *p, lane_i v) { _mm_storeu_si128((__m128i *)(void *)p, v); }
static inline lane_i i_add(lane_i a, lane_i b) { return _mm_add_epi32(a, b); }
static inline lane_i i_sub(lane_i a, lane_i b) { return _mm_sub_epi32(a, b); }
static inline lane_i i_and(lane_i a, lane_i b) { return _mm_and_si128(a, b); }
static inline lane_i i_min(lane_i a, lane_i b) { return _mm_min_epi32(a, b); }
static inline lane_i i_least(lane_i a, lane_i b) { return _mm_min_epu32(a, b); }
#define i_left(a, n) _mm_slli_epi32((a), (n))
#define i_right(a, n) _mm_srli_epi32((a), (n))

static inline lane_f f_of_i(lane_i a) { return _mm_cvtepi32_ps(a); }
static inline lane_i i_of_f(lane_f a) { return _mm_cvttps_epi32(a); }
static inline lane_f f_of_bits(lane_i a) { return _mm_castsi128_ps(a); }
static inline lane_i i_of_bits(lane_f a) { return _mm_castps_si128(a); }
static inline lane_i i_count(void) { return _mm_setr_epi32(0, 1, 2, 3); }

static inline lane_i i_load_u8(const uint8_t *p) {
    int32_t four;
    memcpy(&four, p, sizeof four);
    return _mm_cvtepu8_epi32(_mm_cvtsi32_si128(four));
}
static inline lane_i i_load_u16(const uint8_t *p) {
    return _mm_cvtepu16_epi32(_mm_loadl_epi64((const __m128i *)(const void *)p));
}
static inline void i_store_u8(uint8_t *p, lane_i v) {
    __m128i words = _mm_packus_epi32(v, v);
    int32_t four = _mm_cvtsi128_si32(_mm_packus_epi16(words, words));
    memcpy(p, &four, sizeof four);
}
static inline void i_store_u16(uint8_t *p, lane_i v) { _mm_storel_epi64((__m128i *)(void *)p, _mm_packus_epi32(v, v)); }

static inline lane_f f_gather(const float *base, lane_i index) {
    return _mm_setr_ps(base[_mm_extract_epi32(index, 0)], base[_mm_extract_epi32(index, 1)],
                       base[_mm_extract_epi32(index, 2)], base[_mm_extract_epi32(index, 3)]);
}
static inline void f_gather_pair(const float *base, lane_i index, lane_f *first, lane_f *second) {
    __m128 low = _mm_loadl_pi(_mm_setzero_ps(), (const __m64 *)(const void *)(base + _mm_extract_epi32(index, 0)));
    low = _mm_loadh_pi(low, (const __m64 *)(const void *)(base + _mm_extract_epi32(index, 1)));
    __m128 high = _mm_loadl_pi(_mm_setzero_ps(), (const __m64 *)(const void *)(base + _mm_extract_epi32(index, 2)));
    high = _mm_loadh_pi(high, (const __m64 *)(const void *)(base + _mm_extract_epi32(index, 3)));
    *first = _mm_shuffle_ps(low, high, 0x88);
    *second = _mm_shuffle_ps(low, high, 0xdd);
}

static inline __m128 two_pairs(const float *base, int32_t a, int32_t b) {
    const __m128 low = _mm_loadl_pi(_mm_setzero_ps(), (const __m64 *)(const void *)(base + a));
    return _mm_loadh_pi(low, (const __m64 *)(const void *)(base + b));
}
static inline void f_pairs(const float *base, const int32_t *at, lane_f *first, lane_f *second) {
    const __m128 low = two_pairs(base, at[0], at[1]), high = two_pairs(base, at[2], at[3]);
    *first = _mm_shuffle_ps(low, high, 0x88);
    *second = _mm_shuffle_ps(low, high, 0xdd);
}
static inline void f_fours(const float *base, const int32_t *at, lane_f four[4]) {
    for (int i = 0; i < 4; i++) four[i] = f_load(base + at[i]);
    _MM_TRANSPOSE4_PS(four[0], four[1], four[2], four[3]);
}

static inline void f_store3(float *p, lane_f a, lane_f b, lane_f c) {
    __m128 ab = _mm_unpacklo_ps(a, b), ab_high = _mm_unpackhi_ps(a, b);        /* a0 b0 a1 b1, a2 b2 a3 b3 */
    __m128 ca = _mm_shuffle_ps(c, a, _MM_SHUFFLE(1, 1, 0, 0));                 /* c0 c0 a1 a1 */
    __m128 bc = _mm_shuffle_ps(b, c, _MM_SHUFFLE(1, 1, 1, 1));                 /* b1 b1 c1 c1 */
    __m128 ca_high = _mm_shuffle_ps(c, a, _MM_SHUFFLE(3, 3, 2, 2));            /* c2 c2 a3 a3 */
    __m128 bc_high = _mm_shuffle_ps(b, c, _MM_SHUFFLE(3, 3, 3, 3));            /* b3 b3 c3 c3 */
    f_store(p, _mm_shuffle_ps(ab, ca, _MM_SHUFFLE(2, 0, 1, 0)));               /* a0 b0 c0 a1 */
    f_store(p + 4, _mm_shuffle_ps(bc, ab_high, _MM_SHUFFLE(1, 0, 2, 0)));      /* b1 c1 a2 b2 */
    f_store(p + 8, _mm_shuffle_ps(ca_high, bc_high, _MM_SHUFFLE(2, 0, 2, 0))); /* c2 a3 b3 c3 */
}

/* A line of 64 bytes past the caches; `to` is aligned to it. */
#define CAN_STREAM 1
static inline void stream_line(uint8_t *to, const uint8_t *from) {
    for (int i = 0; i < 4; i++)
        _mm_stream_si128((__m128i *)(void *)to + i, _mm_loadu_si128((const __m128i *)(const void *)from + i));
}
static inline void end_stream(void) { _mm_sfence(); }

#endif
