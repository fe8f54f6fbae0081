#include "photo/registration/nearest_features.hpp"

#include <algorithm>

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define LENSPROF_NEAREST_AVX2
#include <immintrin.h>
#endif

namespace lensprof {
namespace {

void take_product(int32_t product, int32_t number, NearestFeatures &nearest) {
    if (product > nearest.best || (product == nearest.best && number < nearest.number))
        nearest.next = nearest.best, nearest.best = product, nearest.number = number;
    else
        nearest.next = std::max(nearest.next, product);
}

#ifdef LENSPROF_NEAREST_AVX2

constexpr int lanes = 8, elements = descriptor_length / 2;  // of two numbers, which one instruction multiplies and adds
constexpr int rows_at_once = 4, groups_at_once = 2;

// Groups of `lanes` rows, element by element; rows of zeros at the end, whose products are below all that matter.
std::vector<int32_t> in_groups(const int16_t *b, int count) {
    constexpr int rows = lanes * groups_at_once;
    std::vector<int32_t> packed(static_cast<size_t>((count + rows - 1) / rows * rows * elements));
    for (int j = 0; j < count; j++) {
        int32_t *const group = &packed[static_cast<size_t>(j / lanes * lanes * elements + j % lanes)];
        for (int e = 0; e < elements; e++)
            __builtin_memcpy(&group[e * lanes], &b[j * descriptor_length + 2 * e], sizeof(int32_t));
    }
    return packed;
}

// Products of four rows with two groups in registers; per lane, the two largest so far.
__attribute__((target("avx2"))) void nearest_of_rows(const int32_t *const rows[rows_at_once],
                                                     const std::vector<int32_t> &packed, NearestFeatures *nearest) {
    __m256i best[rows_at_once], next[rows_at_once], group_of_best[rows_at_once];
    for (int r = 0; r < rows_at_once; r++) best[r] = next[r] = group_of_best[r] = _mm256_set1_epi32(-1);
    const int groups = static_cast<int>(packed.size()) / (lanes * elements);
    for (int g = 0; g < groups; g += groups_at_once) {
        const auto *group = reinterpret_cast<const __m256i *>(&packed[static_cast<size_t>(g * lanes * elements)]);
        __m256i sum[rows_at_once][groups_at_once];
        for (auto &of_row : sum) of_row[0] = of_row[1] = _mm256_setzero_si256();
        for (int e = 0; e < elements; e++) {
            const __m256i first = _mm256_loadu_si256(group + e), second = _mm256_loadu_si256(group + elements + e);
            for (int r = 0; r < rows_at_once; r++) {
                const __m256i element = _mm256_set1_epi32(rows[r][e]);
                sum[r][0] = _mm256_add_epi32(sum[r][0], _mm256_madd_epi16(element, first));
                sum[r][1] = _mm256_add_epi32(sum[r][1], _mm256_madd_epi16(element, second));
            }
        }
        for (int r = 0; r < rows_at_once; r++)
            for (int part = 0; part < groups_at_once; part++) {
                const __m256i product = sum[r][part], is_better = _mm256_cmpgt_epi32(product, best[r]);
                next[r] = _mm256_max_epi32(next[r], _mm256_min_epi32(best[r], product));
                best[r] = _mm256_max_epi32(best[r], product);
                group_of_best[r] = _mm256_blendv_epi8(group_of_best[r], _mm256_set1_epi32(g + part), is_better);
            }
    }
    for (int r = 0; r < rows_at_once; r++) {
        alignas(32) int32_t b[lanes], n[lanes], g[lanes];
        _mm256_store_si256(reinterpret_cast<__m256i *>(b), best[r]);
        _mm256_store_si256(reinterpret_cast<__m256i *>(n), next[r]);
        _mm256_store_si256(reinterpret_cast<__m256i *>(g), group_of_best[r]);
        for (int lane = 0; lane < lanes; lane++) {
            take_product(b[lane], g[lane] * lanes + lane, nearest[r]);
            nearest[r].next = std::max(nearest[r].next, n[lane]);
        }
    }
}

std::vector<NearestFeatures> nearest_by_lanes(const int16_t *a, int count_a, const int16_t *b, int count_b) {
    const std::vector<int32_t> packed = in_groups(b, count_b);
    std::vector<NearestFeatures> nearest(
        static_cast<size_t>((count_a + rows_at_once - 1) / rows_at_once * rows_at_once));
    for (int i = 0; i < count_a; i += rows_at_once) {
        int32_t copies[rows_at_once][elements];
        const int32_t *rows[rows_at_once];
        for (int r = 0; r < rows_at_once; r++) {
            __builtin_memcpy(copies[r], &a[std::min(i + r, count_a - 1) * descriptor_length], sizeof(copies[r]));
            rows[r] = copies[r];
        }
        nearest_of_rows(rows, packed, &nearest[static_cast<size_t>(i)]);
    }
    nearest.resize(static_cast<size_t>(count_a));
    return nearest;
}

#endif

}  // namespace

std::vector<NearestFeatures> nearest_features_plainly(const int16_t *a, int count_a, const int16_t *b, int count_b) {
    std::vector<NearestFeatures> nearest(static_cast<size_t>(count_a));
    for (int i = 0; i < count_a; i++)
        for (int j = 0; j < count_b; j++) {
            const int16_t *const x = a + i * descriptor_length, *const y = b + j * descriptor_length;
            int32_t product = 0;
            for (int k = 0; k < descriptor_length; k++) product += int32_t(x[k]) * int32_t(y[k]);
            take_product(product, j, nearest[static_cast<size_t>(i)]);
        }
    return nearest;
}

std::vector<NearestFeatures> nearest_features(const int16_t *a, int count_a, const int16_t *b, int count_b) {
#ifdef LENSPROF_NEAREST_AVX2
    if (__builtin_cpu_supports("avx2")) return nearest_by_lanes(a, count_a, b, count_b);
#endif
    return nearest_features_plainly(a, count_a, b, count_b);
}

}  // namespace lensprof
