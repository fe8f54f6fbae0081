/* Which kernel this processor runs best. */
#include "core/plan.h"

#if defined(__x86_64__) && defined(LENSPROF_KERNELS)
#include <cpuid.h>

/* What the operating system saves of the vector registers (XCR0). */
static uint32_t saved_state(void) {
    uint32_t low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

/* Intel's processors with AVX-512 and arithmetic in half precision: Sapphire Rapids and later. Microcode against leaks
 * (Gather Data Sampling) slows down the gathers of earlier ones, and those of AMD Zen 4 take twice as long as loads. */
static int has_fast_gathers(void) {
    const uint32_t avx512_fp16 = 1u << 23;
    uint32_t a, b, c, d;
    return __get_cpuid(0, &a, &b, &c, &d) && b == signature_INTEL_ebx && __get_cpuid_count(7, 0, &a, &b, &c, &d)
           && (d & avx512_fp16);
}

static uint32_t most_lanes(void) {
    enum {
        SSE41 = 1 << 19,
        OSXSAVE = 1 << 27,
        AVX2 = 1 << 5
    };
    const uint32_t avx512 = 1u << 16 | 1u << 17 | 1u << 30 | 1u << 31; /* F, DQ, BW, VL */
    uint32_t a, b, c, d;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & SSE41)) return 1;
    if (!(c & OSXSAVE)) return 4;
    const uint32_t state = saved_state();
    if ((state & 6) != 6 || !__get_cpuid_count(7, 0, &a, &b, &c, &d) || !(b & AVX2)) return 4;
    return (b & avx512) == avx512 && (state & 0xe0) == 0xe0 ? 16 : 8;
}

lp_row_kernel *lp_row_best(uint32_t lanes) {
    uint32_t max_lanes = most_lanes();
    if (lanes && lanes < max_lanes) max_lanes = lanes;
    if (!lanes && max_lanes == 16 && has_fast_gathers()) return lp_row_gathers;
    return max_lanes >= 16  ? lp_row_avx512
           : max_lanes >= 8 ? lp_row_avx2
           : max_lanes >= 4 ? lp_row_sse41
                            : lp_row_scalar;
}
#elif defined(__aarch64__) && defined(LENSPROF_KERNELS)
lp_row_kernel *lp_row_best(uint32_t lanes) { return lanes == 0 || lanes >= 4 ? lp_row_neon : lp_row_scalar; }
#else
lp_row_kernel *lp_row_best(uint32_t lanes) {
    (void)lanes;
    return lp_row_scalar;
}
#endif
