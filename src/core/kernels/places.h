/* Loads by two places in memory, of AVX2 and AVX-512. */
#ifndef LENSPROF_CORE_PLACES_H
#define LENSPROF_CORE_PLACES_H

#include <immintrin.h>
#include <stdint.h>
#include <string.h>

/* Loads of single elements are faster than gathers if the places are in memory, and one load reads two places. */
typedef struct two_places {
    uint64_t a, b;
} two_places;
static inline two_places places_at(const int32_t *at) {
    uint64_t both;
    memcpy(&both, at, sizeof both);
    return (two_places){(uint32_t)both, both >> 32};
}
static inline __m128 two_pairs(const float *base, const int32_t *at) {
    const two_places p = places_at(at);
    const __m128 low = _mm_loadl_pi(_mm_setzero_ps(), (const __m64 *)(const void *)(base + p.a));
    return _mm_loadh_pi(low, (const __m64 *)(const void *)(base + p.b));
}

#endif
