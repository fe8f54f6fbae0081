#include "photo/registration/nearest_features.hpp"

#include <algorithm>

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define LENSPROF_NEAREST_VECTORS
#include <cpuid.h>
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

#ifdef LENSPROF_NEAREST_VECTORS

constexpr int elements = descriptor_length / 2;  // of two numbers, which one instruction multiplies and adds
constexpr int groups_at_once = 2;

// Groups of `lanes` rows, element by element; rows of zeros at the end, whose products are below all that matter.
std::vector<int32_t> in_groups(const int16_t *b, int count, int lanes) {
    const int rows = lanes * groups_at_once;
    std::vector<int32_t> packed(static_cast<size_t>((count + rows - 1) / rows * rows * elements));
    for (int j = 0; j < count; j++) {
        int32_t *const group = &packed[static_cast<size_t>(j / lanes * lanes * elements + j % lanes)];
        for (int e = 0; e < elements; e++)
            __builtin_memcpy(&group[e * lanes], &b[j * descriptor_length + 2 * e], sizeof(int32_t));
    }
    return packed;
}

// The two largest products of a row in every lane, and the group of the largest.
template <int lanes>
struct InLanes {
    alignas(64) int32_t best[lanes], next[lanes], group[lanes];

    void add_to(NearestFeatures &nearest) const {
        for (int lane = 0; lane < lanes; lane++) {
            take_product(best[lane], group[lane] * lanes + lane, nearest);
            nearest.next = std::max(nearest.next, next[lane]);
        }
    }
};

// Products of `rows_at_once` rows with two groups in registers.
struct Avx2 {
    static constexpr int lanes = 8, rows_at_once = 4;

    __attribute__((target("avx2"))) static void find(const int32_t (*rows)[elements],
                                                     const std::vector<int32_t> &packed, InLanes<lanes> *found) {
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
            _mm256_store_si256(reinterpret_cast<__m256i *>(found[r].best), best[r]);
            _mm256_store_si256(reinterpret_cast<__m256i *>(found[r].next), next[r]);
            _mm256_store_si256(reinterpret_cast<__m256i *>(found[r].group), group_of_best[r]);
        }
    }
};

// The same, with one instruction that multiplies, adds and accumulates.
#ifdef LENSPROF_EVEX512  // clang 18 to 20: registers of 512 bits are an option of their own
#define AVX512 "avx512f,avx512vnni,evex512"
#else
#define AVX512 "avx512f,avx512vnni"
#endif
struct Avx512 {
    static constexpr int lanes = 16, rows_at_once = 8;
    static constexpr __mmask16 all = 0xffff;

    __attribute__((target(AVX512))) static void find(const int32_t (*rows)[elements],
                                                     const std::vector<int32_t> &packed, InLanes<lanes> *found) {
        __m512i best[rows_at_once], next[rows_at_once], group_of_best[rows_at_once];
        for (int r = 0; r < rows_at_once; r++) best[r] = next[r] = group_of_best[r] = _mm512_set1_epi32(-1);
        const int groups = static_cast<int>(packed.size()) / (lanes * elements);
        for (int g = 0; g < groups; g += groups_at_once) {
            const int32_t *const group = &packed[static_cast<size_t>(g * lanes * elements)];
            __m512i sum[rows_at_once][groups_at_once];
            for (auto &of_row : sum) of_row[0] = of_row[1] = _mm512_setzero_si512();
            for (int e = 0; e < elements; e++) {
                const __m512i first = _mm512_loadu_si512(group + e * lanes),
                              second = _mm512_loadu_si512(group + (elements + e) * lanes);
                for (int r = 0; r < rows_at_once; r++) {
                    const __m512i element = _mm512_set1_epi32(rows[r][e]);
                    sum[r][0] = _mm512_dpwssd_epi32(sum[r][0], element, first);
                    sum[r][1] = _mm512_dpwssd_epi32(sum[r][1], element, second);
                }
            }
            for (int r = 0; r < rows_at_once; r++)
                for (int part = 0; part < groups_at_once; part++) {
                    const __m512i product = sum[r][part];
                    const __mmask16 is_better = _mm512_cmpgt_epi32_mask(product, best[r]);
                    next[r] = _mm512_maskz_max_epi32(all, next[r], _mm512_maskz_min_epi32(all, best[r], product));
                    best[r] = _mm512_maskz_max_epi32(all, best[r], product);
                    group_of_best[r] = _mm512_mask_set1_epi32(group_of_best[r], is_better, g + part);
                }
        }
        for (int r = 0; r < rows_at_once; r++) {
            _mm512_store_si512(found[r].best, best[r]);
            _mm512_store_si512(found[r].next, next[r]);
            _mm512_store_si512(found[r].group, group_of_best[r]);
        }
    }
};

template <class Processor>
std::vector<NearestFeatures> nearest_by(const int16_t *a, int count_a, const int16_t *b, int count_b) {
    constexpr int rows_at_once = Processor::rows_at_once;
    const std::vector<int32_t> packed = in_groups(b, count_b, Processor::lanes);
    std::vector<NearestFeatures> nearest(static_cast<size_t>(count_a));
    int32_t rows[rows_at_once][elements];
    InLanes<Processor::lanes> found[rows_at_once];
    for (int i = 0; i < count_a; i += rows_at_once) {
        for (int r = 0; r < rows_at_once; r++)
            __builtin_memcpy(rows[r], &a[std::min(i + r, count_a - 1) * descriptor_length], sizeof(rows[r]));
        Processor::find(rows, packed, found);
        for (int r = 0; r < rows_at_once && i + r < count_a; r++) found[r].add_to(nearest[static_cast<size_t>(i + r)]);
    }
    return nearest;
}

#endif

std::vector<NearestFeatures> nearest_plainly(const int16_t *a, int count_a, const int16_t *b, int count_b) {
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

#ifdef LENSPROF_NEAREST_VECTORS
// Whether processor and operating system have AVX2, or AVX-512 with VNNI. As in core: the compilers' own query needs a
// library that not every one has.
bool has_vectors(bool wide) {
    constexpr uint32_t osxsave = 1u << 27, avx2 = 1u << 5, avx512f = 1u << 16, vnni = 1u << 11;
    uint32_t a, b, c, d, low, high;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & osxsave)) return false;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    const uint32_t state = wide ? 0xe6 : 0x06;  // of the registers that the system saves
    if ((low & state) != state || !__get_cpuid_count(7, 0, &a, &b, &c, &d)) return false;
    return wide ? (b & avx512f) && (c & vnni) : (b & avx2) != 0;
}
#endif

}  // namespace

std::vector<NearestKernel> nearest_kernels() {
    std::vector<NearestKernel> kernels;
#ifdef LENSPROF_NEAREST_VECTORS
    if (has_vectors(true)) kernels.push_back({"avx512vnni", nearest_by<Avx512>});
    if (has_vectors(false)) kernels.push_back({"avx2", nearest_by<Avx2>});
#endif
    kernels.push_back({"plain", nearest_plainly});
    return kernels;
}

std::vector<NearestFeatures> nearest_features(const int16_t *a, int count_a, const int16_t *b, int count_b) {
    return nearest_kernels().front().find(a, count_a, b, count_b);
}

}  // namespace lensprof
