/* Eight lanes: AVX2. */
#ifndef LENSPROF_CORE_LANES_H
#define LENSPROF_CORE_LANES_H

#include <immintrin.h>
#include <stdint.h>

#include "core/kernels/places.h"

#define LANES 8
#define STRIP 256

typedef __m256 lane_f;
typedef __m256i lane_i;
typedef __m256 lane_b;

static inline lane_f f_set(float v) { return _mm256_set1_ps(v); }
static inline lane_f f_load(const float *p) { return _mm256_loadu_ps(p); }
static inline void f_store(float *p, lane_f v) { _mm256_storeu_ps(p, v); }
static inline lane_f f_add(lane_f a, lane_f b) { return _mm256_add_ps(a, b); }
static inline lane_f f_sub(lane_f a, lane_f b) { return _mm256_sub_ps(a, b); }
static inline lane_f f_mul(lane_f a, lane_f b) { return _mm256_mul_ps(a, b); }
static inline lane_f f_div(lane_f a, lane_f b) { return _mm256_div_ps(a, b); }
static inline lane_f f_max(lane_f a, lane_f b) { return _mm256_max_ps(a, b); }
static inline lane_f f_min(lane_f a, lane_f b) { return _mm256_min_ps(a, b); }
static inline lane_b f_less(lane_f a, lane_f b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
static inline lane_b f_less_equal(lane_f a, lane_f b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
static inline lane_b f_not_less(lane_f a, lane_f b) { return _mm256_cmp_ps(a, b, _CMP_NLT_UQ); }
static inline lane_b f_not_less_equal(lane_f a, lane_f b) { return _mm256_cmp_ps(a, b, _CMP_NLE_UQ); }
static inline lane_b f_is_number(lane_f a) { return _mm256_cmp_ps(a, a, _CMP_EQ_OQ); }
static inline lane_f f_pick(lane_b is, lane_f yes, lane_f no) { return _mm256_blendv_ps(no, yes, is); }
static inline lane_i i_pick(lane_b is, lane_i yes, lane_i no) {
    return _mm256_blendv_epi8(no, yes, _mm256_castps_si256(is));
}

static inline lane_b b_or(lane_b a, lane_b b) { return _mm256_or_ps(a, b); }
static inline lane_b b_and(lane_b a, lane_b b) { return _mm256_and_ps(a, b); }
static inline int b_all(lane_b b) { return _mm256_movemask_ps(b) == 0xff; }

static inline lane_i i_set(int32_t v) { return _mm256_set1_epi32(v); }
static inline lane_i i_load(const int32_t *p) { return _mm256_loadu_si256((const __m256i *)(const void *)p); }
static inline void i_store(int32_t *p, lane_i v) { _mm256_storeu_si256((__m256i *)(void *)p, v); }
static inline lane_i i_add(lane_i a, lane_i b) { return _mm256_add_epi32(a, b); }
static inline lane_i i_sub(lane_i a, lane_i b) { return _mm256_sub_epi32(a, b); }
static inline lane_i i_and(lane_i a, lane_i b) { return _mm256_and_si256(a, b); }
static inline lane_i i_min(lane_i a, lane_i b) { return _mm256_min_epi32(a, b); }
static inline lane_i i_least(lane_i a, lane_i b) { return _mm256_min_epu32(a, b); }
#define i_left(a, n) _mm256_slli_epi32((a), (n))
#define i_right(a, n) _mm256_srli_epi32((a), (n))

static inline lane_f f_of_i(lane_i a) { return _mm256_cvtepi32_ps(a); }
static inline lane_i i_of_f(lane_f a) { return _mm256_cvttps_epi32(a); }
static inline lane_f f_of_bits(lane_i a) { return _mm256_castsi256_ps(a); }
static inline lane_i i_of_bits(lane_f a) { return _mm256_castps_si256(a); }
static inline lane_i i_count(void) { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }

static inline lane_i i_load_u8(const uint8_t *p) {
    return _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(const void *)p));
}
static inline lane_i i_load_u16(const uint8_t *p) {
    return _mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)(const void *)p));
}
static inline __m128i to_u16(lane_i v) {
    return _mm_packus_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
}
static inline void i_store_u8(uint8_t *p, lane_i v) {
    __m128i words = to_u16(v);
    _mm_storel_epi64((__m128i *)(void *)p, _mm_packus_epi16(words, words));
}
static inline void i_store_u16(uint8_t *p, lane_i v) { _mm_storeu_si128((__m128i *)(void *)p, to_u16(v)); }

/* All lanes, hidden from the compiler: it would otherwise omit the zeros that gathers write into, and each gather
 * would wait for the previous contents of its register. */
static inline __m256i all_lanes(void) {
    __m256i all = _mm256_set1_epi32(-1);
    __asm__("" : "+x"(all));
    return all;
}
static inline lane_f f_gather(const float *base, lane_i index) {
    return _mm256_mask_i32gather_ps(_mm256_setzero_ps(), base, index, _mm256_castsi256_ps(all_lanes()), 4);
}
static inline __m256d gather_pairs(const float *base, __m128i index) {
    return _mm256_mask_i32gather_pd(_mm256_setzero_pd(), (const double *)(const void *)base, index,
                                    _mm256_castsi256_pd(all_lanes()), 4);
}
static inline void f_gather_pair(const float *base, lane_i index, lane_f *first, lane_f *second) {
    __m256 low = _mm256_castpd_ps(gather_pairs(base, _mm256_castsi256_si128(index)));
    __m256 high = _mm256_castpd_ps(gather_pairs(base, _mm256_extracti128_si256(index, 1)));
    __m256d a = _mm256_castps_pd(_mm256_shuffle_ps(low, high, 0x88));
    __m256d b = _mm256_castps_pd(_mm256_shuffle_ps(low, high, 0xdd));
    *first = _mm256_castpd_ps(_mm256_permute4x64_pd(a, 0xd8));
    *second = _mm256_castpd_ps(_mm256_permute4x64_pd(b, 0xd8));
}

static inline __m256 join(__m128 low, __m128 high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(low), high, 1);
}
static inline void f_pairs(const float *base, const int32_t *at, lane_f *first, lane_f *second) {
    const __m256 a = join(two_pairs(base, at), two_pairs(base, at + 4));
    const __m256 b = join(two_pairs(base, at + 2), two_pairs(base, at + 6));
    *first = _mm256_shuffle_ps(a, b, 0x88);
    *second = _mm256_shuffle_ps(a, b, 0xdd);
}
static inline void f_fours(const float *base, const int32_t *at, lane_f four[4]) {
    __m256 row[4];
    for (int i = 0; i < 4; i += 2) {
        const two_places p = places_at(at + i), q = places_at(at + 4 + i);
        row[i] = join(_mm_loadu_ps(base + p.a), _mm_loadu_ps(base + q.a));
        row[i + 1] = join(_mm_loadu_ps(base + p.b), _mm_loadu_ps(base + q.b));
    }
    const __m256 ab = _mm256_unpacklo_ps(row[0], row[1]), cd = _mm256_unpacklo_ps(row[2], row[3]);
    const __m256 ab_high = _mm256_unpackhi_ps(row[0], row[1]), cd_high = _mm256_unpackhi_ps(row[2], row[3]);
    four[0] = _mm256_shuffle_ps(ab, cd, 0x44);
    four[1] = _mm256_shuffle_ps(ab, cd, 0xee);
    four[2] = _mm256_shuffle_ps(ab_high, cd_high, 0x44);
    four[3] = _mm256_shuffle_ps(ab_high, cd_high, 0xee);
}

/* Numbers in registers, selected by the lowest four bits of an index. */
#define IN_TABLE 16
typedef struct lane_table {
    __m256 low, high;
} lane_table;
static inline lane_table table_load(const float *p) { return (lane_table){f_load(p), f_load(p + 8)}; }
static inline lane_f table_pick(lane_table t, lane_i i) {
    const __m256 is_high = _mm256_castsi256_ps(_mm256_slli_epi32(i, 28)); /* by its sign */
    return _mm256_blendv_ps(_mm256_permutevar8x32_ps(t.low, i), _mm256_permutevar8x32_ps(t.high, i), is_high);
}

static inline void f_store3(float *p, lane_f a, lane_f b, lane_f c) {
    __m256i first = _mm256_setr_epi32(0, 0, 0, 1, 1, 1, 2, 2), second = _mm256_setr_epi32(2, 3, 3, 3, 4, 4, 4, 5),
            third = _mm256_setr_epi32(5, 5, 6, 6, 6, 7, 7, 7);
    __m256 x = _mm256_blend_ps(_mm256_permutevar8x32_ps(a, first), _mm256_permutevar8x32_ps(b, first), 0x92);
    __m256 y = _mm256_blend_ps(_mm256_permutevar8x32_ps(a, second), _mm256_permutevar8x32_ps(b, second), 0x24);
    __m256 z = _mm256_blend_ps(_mm256_permutevar8x32_ps(a, third), _mm256_permutevar8x32_ps(b, third), 0x49);
    f_store(p, _mm256_blend_ps(x, _mm256_permutevar8x32_ps(c, first), 0x24));
    f_store(p + 8, _mm256_blend_ps(y, _mm256_permutevar8x32_ps(c, second), 0x49));
    f_store(p + 16, _mm256_blend_ps(z, _mm256_permutevar8x32_ps(c, third), 0x92));
}

/* A line of 64 bytes past the caches; `to` is aligned to it. */
#define CAN_STREAM 1
static inline void stream_line(uint8_t *to, const uint8_t *from) {
    for (int i = 0; i < 2; i++)
        _mm256_stream_si256((__m256i *)(void *)to + i, _mm256_loadu_si256((const __m256i *)(const void *)from + i));
}
static inline void end_stream(void) { _mm_sfence(); }

#endif
