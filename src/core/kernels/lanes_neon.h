/* Four lanes: NEON of AArch64. */
#ifndef LENSPROF_CORE_LANES_H
#define LENSPROF_CORE_LANES_H

#include <arm_neon.h>
#include <stdint.h>
#include <string.h>

#define LANES 4
#define STRIP 256

typedef float32x4_t lane_f;
typedef int32x4_t lane_i;
typedef uint32x4_t lane_b;

static inline lane_f f_set(float v) { return vdupq_n_f32(v); }
static inline lane_f f_load(const float *p) { return vld1q_f32(p); }
static inline void f_store(float *p, lane_f v) { vst1q_f32(p, v); }
static inline lane_f f_add(lane_f a, lane_f b) { return vaddq_f32(a, b); }
static inline lane_f f_sub(lane_f a, lane_f b) { return vsubq_f32(a, b); }
static inline lane_f f_mul(lane_f a, lane_f b) { return vmulq_f32(a, b); }
static inline lane_f f_div(lane_f a, lane_f b) { return vdivq_f32(a, b); }
static inline lane_f f_max(lane_f a, lane_f b) { return vbslq_f32(vcgtq_f32(a, b), a, b); } /* b if a is NaN */
static inline lane_f f_min(lane_f a, lane_f b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
static inline lane_b f_less(lane_f a, lane_f b) { return vcltq_f32(a, b); }
static inline lane_b f_is_number(lane_f a) { return vceqq_f32(a, a); }
static inline lane_f f_pick(lane_b is, lane_f yes, lane_f no) { return vbslq_f32(is, yes, no); }
static inline lane_i i_pick(lane_b is, lane_i yes, lane_i no) { return vbslq_s32(is, yes, no); }

static inline lane_i i_set(int32_t v) { return vdupq_n_s32(v); }
static inline lane_i i_load(const int32_t *p) { return vld1q_s32(p); }
static inline void i_store(int32_t *p, lane_i v) { vst1q_s32(p, v); }
static inline lane_i i_add(lane_i a, lane_i b) { return vaddq_s32(a, b); }
static inline lane_i i_sub(lane_i a, lane_i b) { return vsubq_s32(a, b); }
static inline lane_i i_and(lane_i a, lane_i b) { return vandq_s32(a, b); }
static inline lane_i i_min(lane_i a, lane_i b) { return vminq_s32(a, b); }
static inline lane_i i_least(lane_i a, lane_i b) {
    return vreinterpretq_s32_u32(vminq_u32(vreinterpretq_u32_s32(a), vreinterpretq_u32_s32(b)));
}
#define i_left(a, n) vshlq_n_s32((a), (n))
#define i_right(a, n) vreinterpretq_s32_u32(vshrq_n_u32(vreinterpretq_u32_s32(a), (n)))

static inline lane_f f_of_i(lane_i a) { return vcvtq_f32_s32(a); }
static inline lane_i i_of_f(lane_f a) { return vcvtq_s32_f32(a); }
static inline lane_f f_of_bits(lane_i a) { return vreinterpretq_f32_s32(a); }
static inline lane_i i_of_bits(lane_f a) { return vreinterpretq_s32_f32(a); }
static inline lane_i i_count(void) {
    static const int32_t count[4] = {0, 1, 2, 3};
    return vld1q_s32(count);
}

static inline lane_i i_load_u8(const uint8_t *p) {
    uint32_t four;
    memcpy(&four, p, sizeof four);
    uint16x8_t words = vmovl_u8(vreinterpret_u8_u32(vdup_n_u32(four)));
    return vreinterpretq_s32_u32(vmovl_u16(vget_low_u16(words)));
}
static inline lane_i i_load_u16(const uint8_t *p) {
    uint8x8_t bytes = vld1_u8(p);
    return vreinterpretq_s32_u32(vmovl_u16(vreinterpret_u16_u8(bytes)));
}
static inline void i_store_u8(uint8_t *p, lane_i v) {
    uint16x4_t words = vmovn_u32(vreinterpretq_u32_s32(v));
    uint32_t four = vget_lane_u32(vreinterpret_u32_u8(vmovn_u16(vcombine_u16(words, words))), 0);
    memcpy(p, &four, sizeof four);
}
static inline void i_store_u16(uint8_t *p, lane_i v) {
    vst1_u8(p, vreinterpret_u8_u16(vmovn_u32(vreinterpretq_u32_s32(v))));
}

static inline lane_f f_gather(const float *base, lane_i index) {
    float32x4_t v = vdupq_n_f32(base[vgetq_lane_s32(index, 0)]);
    v = vsetq_lane_f32(base[vgetq_lane_s32(index, 1)], v, 1);
    v = vsetq_lane_f32(base[vgetq_lane_s32(index, 2)], v, 2);
    return vsetq_lane_f32(base[vgetq_lane_s32(index, 3)], v, 3);
}
static inline void f_gather_pair(const float *base, lane_i index, lane_f *first, lane_f *second) {
    float32x4_t low =
        vcombine_f32(vld1_f32(base + vgetq_lane_s32(index, 0)), vld1_f32(base + vgetq_lane_s32(index, 1)));
    float32x4_t high =
        vcombine_f32(vld1_f32(base + vgetq_lane_s32(index, 2)), vld1_f32(base + vgetq_lane_s32(index, 3)));
    *first = vuzp1q_f32(low, high);
    *second = vuzp2q_f32(low, high);
}

static inline void f_pairs(const float *base, const int32_t *at, lane_f *first, lane_f *second) {
    const float32x4_t low = vcombine_f32(vld1_f32(base + at[0]), vld1_f32(base + at[1]));
    const float32x4_t high = vcombine_f32(vld1_f32(base + at[2]), vld1_f32(base + at[3]));
    *first = vuzp1q_f32(low, high);
    *second = vuzp2q_f32(low, high);
}
static inline void f_fours(const float *base, const int32_t *at, lane_f four[4]) {
    const float32x4_t a = f_load(base + at[0]), b = f_load(base + at[1]), c = f_load(base + at[2]),
                      d = f_load(base + at[3]);
    const float32x4_t ab = vtrn1q_f32(a, b), ab_odd = vtrn2q_f32(a, b); /* a0 b0 a2 b2, a1 b1 a3 b3 */
    const float32x4_t cd = vtrn1q_f32(c, d), cd_odd = vtrn2q_f32(c, d);
    four[0] = vcombine_f32(vget_low_f32(ab), vget_low_f32(cd));
    four[1] = vcombine_f32(vget_low_f32(ab_odd), vget_low_f32(cd_odd));
    four[2] = vcombine_f32(vget_high_f32(ab), vget_high_f32(cd));
    four[3] = vcombine_f32(vget_high_f32(ab_odd), vget_high_f32(cd_odd));
}

static inline void f_store3(float *p, lane_f a, lane_f b, lane_f c) {
    float32x4x3_t all = {{a, b, c}};
    vst3q_f32(p, all);
}

#define CAN_STREAM 0 /* cannot bypass the caches */

#endif
