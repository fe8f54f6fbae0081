/* Sixteen lanes: AVX-512 F, BW, DQ and VL. */
#ifndef LENSPROF_CORE_LANES_H
#define LENSPROF_CORE_LANES_H

#include <immintrin.h>
#include <stdint.h>

#include "core/kernels/places.h"

#define LANES 16
#define STRIP 128

typedef __m512 lane_f;
typedef __m512i lane_i;
typedef __mmask16 lane_b;

static inline lane_f f_set(float v) { return _mm512_set1_ps(v); }
static inline lane_f f_load(const float *p) { return _mm512_loadu_ps(p); }
static inline void f_store(float *p, lane_f v) { _mm512_storeu_ps(p, v); }
static inline lane_f f_add(lane_f a, lane_f b) { return _mm512_add_ps(a, b); }
static inline lane_f f_sub(lane_f a, lane_f b) { return _mm512_sub_ps(a, b); }
static inline lane_f f_mul(lane_f a, lane_f b) { return _mm512_mul_ps(a, b); }
static inline lane_f f_div(lane_f a, lane_f b) { return _mm512_div_ps(a, b); }
static inline lane_f f_max(lane_f a, lane_f b) { return _mm512_max_ps(a, b); }
static inline lane_f f_min(lane_f a, lane_f b) { return _mm512_min_ps(a, b); }
static inline lane_b f_less(lane_f a, lane_f b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
static inline lane_b f_less_equal(lane_f a, lane_f b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
static inline lane_b f_not_less(lane_f a, lane_f b) { return _mm512_cmp_ps_mask(a, b, _CMP_NLT_UQ); }
static inline lane_b f_not_less_equal(lane_f a, lane_f b) { return _mm512_cmp_ps_mask(a, b, _CMP_NLE_UQ); }
static inline lane_b f_is_number(lane_f a) { return _mm512_cmp_ps_mask(a, a, _CMP_EQ_OQ); }
static inline lane_f f_pick(lane_b is, lane_f yes, lane_f no) { return _mm512_mask_blend_ps(is, no, yes); }
static inline lane_i i_pick(lane_b is, lane_i yes, lane_i no) { return _mm512_mask_blend_epi32(is, no, yes); }

static inline lane_b b_or(lane_b a, lane_b b) { return (lane_b)(a | b); }
static inline lane_b b_and(lane_b a, lane_b b) { return (lane_b)(a & b); }
static inline int b_all(lane_b b) { return b == 0xffff; }

static inline lane_i i_set(int32_t v) { return _mm512_set1_epi32(v); }
static inline lane_i i_load(const int32_t *p) { return _mm512_loadu_si512(p); }
static inline void i_store(int32_t *p, lane_i v) { _mm512_storeu_si512(p, v); }
static inline lane_i i_add(lane_i a, lane_i b) { return _mm512_add_epi32(a, b); }
static inline lane_i i_sub(lane_i a, lane_i b) { return _mm512_sub_epi32(a, b); }
static inline lane_i i_and(lane_i a, lane_i b) { return _mm512_and_si512(a, b); }
static inline lane_i i_min(lane_i a, lane_i b) { return _mm512_min_epi32(a, b); }
static inline lane_i i_least(lane_i a, lane_i b) { return _mm512_min_epu32(a, b); }
#define i_left(a, n) _mm512_slli_epi32((a), (n))
#define i_right(a, n) _mm512_srli_epi32((a), (n))

static inline lane_f f_of_i(lane_i a) { return _mm512_cvtepi32_ps(a); }
static inline lane_i i_of_f(lane_f a) { return _mm512_cvttps_epi32(a); }
static inline lane_f f_of_bits(lane_i a) { return _mm512_castsi512_ps(a); }
static inline lane_i i_of_bits(lane_f a) { return _mm512_castps_si512(a); }
static inline lane_i i_count(void) { return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15); }

static inline lane_i i_load_u8(const uint8_t *p) {
    return _mm512_cvtepu8_epi32(_mm_loadu_si128((const __m128i *)(const void *)p));
}
static inline lane_i i_load_u16(const uint8_t *p) {
    return _mm512_cvtepu16_epi32(_mm256_loadu_si256((const __m256i *)(const void *)p));
}
static inline void i_store_u8(uint8_t *p, lane_i v) { _mm_storeu_si128((__m128i *)(void *)p, _mm512_cvtepi32_epi8(v)); }
static inline void i_store_u16(uint8_t *p, lane_i v) {
    _mm256_storeu_si256((__m256i *)(void *)p, _mm512_cvtepi32_epi16(v));
}

/* All lanes, hidden from the compiler: it would otherwise omit the zeros that gathers write into, and each gather
 * would wait for the previous contents of its register. */
static inline __mmask16 all_lanes(void) {
    __mmask16 all = 0xffff;
    __asm__("" : "+Yk"(all));
    return all;
}
static inline lane_f f_gather(const float *base, lane_i index) {
    return _mm512_mask_i32gather_ps(_mm512_setzero_ps(), all_lanes(), index, base, 4);
}
static inline void f_gather_pair(const float *base, lane_i index, lane_f *first, lane_f *second) {
    __m512 low = _mm512_castpd_ps(
        _mm512_mask_i32gather_pd(_mm512_setzero_pd(), (__mmask8)all_lanes(), _mm512_castsi512_si256(index), base, 4));
    __m512 high = _mm512_castpd_ps(_mm512_mask_i32gather_pd(_mm512_setzero_pd(), (__mmask8)all_lanes(),
                                                            _mm512_extracti64x4_epi64(index, 1), base, 4));
    const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    *first = _mm512_permutex2var_ps(low, even, high);
    *second = _mm512_permutex2var_ps(low, _mm512_add_epi32(even, _mm512_set1_epi32(1)), high);
}

static inline __m512 join(__m128 a, __m128 b, __m128 c, __m128 d) {
    const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(a), b, 1);
    const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(c), d, 1);
    return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
}
static inline void f_pairs(const float *base, const int32_t *at, lane_f *first, lane_f *second) {
#ifdef FAST_GATHERS
    f_gather_pair(base, i_load(at), first, second);
#else
    const __m512 a =
        join(two_pairs(base, at), two_pairs(base, at + 4), two_pairs(base, at + 8), two_pairs(base, at + 12));
    const __m512 b =
        join(two_pairs(base, at + 2), two_pairs(base, at + 6), two_pairs(base, at + 10), two_pairs(base, at + 14));
    *first = _mm512_shuffle_ps(a, b, 0x88);
    *second = _mm512_shuffle_ps(a, b, 0xdd);
#endif
}
static inline void f_fours(const float *base, const int32_t *at, lane_f four[4]) {
    __m512 row[4];
    for (int i = 0; i < 4; i += 2) {
        const two_places p = places_at(at + i), q = places_at(at + 4 + i), r = places_at(at + 8 + i),
                         t = places_at(at + 12 + i);
        row[i] = join(_mm_loadu_ps(base + p.a), _mm_loadu_ps(base + q.a), _mm_loadu_ps(base + r.a),
                      _mm_loadu_ps(base + t.a));
        row[i + 1] = join(_mm_loadu_ps(base + p.b), _mm_loadu_ps(base + q.b), _mm_loadu_ps(base + r.b),
                          _mm_loadu_ps(base + t.b));
    }
    const __m512 ab = _mm512_unpacklo_ps(row[0], row[1]), cd = _mm512_unpacklo_ps(row[2], row[3]);
    const __m512 ab_high = _mm512_unpackhi_ps(row[0], row[1]), cd_high = _mm512_unpackhi_ps(row[2], row[3]);
    four[0] = _mm512_shuffle_ps(ab, cd, 0x44);
    four[1] = _mm512_shuffle_ps(ab, cd, 0xee);
    four[2] = _mm512_shuffle_ps(ab_high, cd_high, 0x44);
    four[3] = _mm512_shuffle_ps(ab_high, cd_high, 0xee);
}

/* Numbers in registers, selected by the lowest five bits of an index. */
#define IN_TABLE 32
typedef struct lane_table {
    __m512 low, high;
} lane_table;
static inline lane_table table_load(const float *p) { return (lane_table){f_load(p), f_load(p + 16)}; }
static inline lane_f table_pick(lane_table t, lane_i i) { return _mm512_permutex2var_ps(t.low, i, t.high); }

static inline void f_store3(float *p, lane_f a, lane_f b, lane_f c) {
    const __m512i first = _mm512_setr_epi32(0, 16, 0, 1, 17, 0, 2, 18, 0, 3, 19, 0, 4, 20, 0, 5),
                  second = _mm512_setr_epi32(21, 0, 6, 22, 0, 7, 23, 0, 8, 24, 0, 9, 25, 0, 10, 26),
                  third = _mm512_setr_epi32(0, 11, 27, 0, 12, 28, 0, 13, 29, 0, 14, 30, 0, 15, 31, 0);
    const __m512i c1 = _mm512_setr_epi32(0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0),
                  c2 = _mm512_setr_epi32(0, 5, 0, 0, 6, 0, 0, 7, 0, 0, 8, 0, 0, 9, 0, 0),
                  c3 = _mm512_setr_epi32(10, 0, 0, 11, 0, 0, 12, 0, 0, 13, 0, 0, 14, 0, 0, 15);
    f_store(p, _mm512_mask_permutexvar_ps(_mm512_permutex2var_ps(a, first, b), 0x4924, c1, c));
    f_store(p + 16, _mm512_mask_permutexvar_ps(_mm512_permutex2var_ps(a, second, b), 0x2492, c2, c));
    f_store(p + 32, _mm512_mask_permutexvar_ps(_mm512_permutex2var_ps(a, third, b), 0x9249, c3, c));
}

/* A line of 64 bytes past the caches; `to` is aligned to it. */
#ifdef FAST_GATHERS
#define CAN_STREAM 0
#else
#define CAN_STREAM 1
#endif
static inline void stream_line(uint8_t *to, const uint8_t *from) {
    _mm512_stream_si512((__m512i *)(void *)to, _mm512_loadu_si512(from));
}
static inline void end_stream(void) { _mm_sfence(); }

#endif
