/* SPDX-License-Identifier: MIT */
/*
 * Vectors of doubles, for loops that are one text for several processors. A file that defines PIR_LANES_AVX2 before it
 * includes this compiles its text for AVX2, four doubles at a time; another one for any processor, two at a time. Every
 * operation is one of plain doubles lane by lane, never fused, so that all versions of a text have the same bits.
 */
#ifndef PIR_BASE_LANE_TEXT_H
#define PIR_BASE_LANE_TEXT_H

#include <math.h>
#include <stdint.h>

#include "base/vec.h"

#if PIR_LANES_AVX2
#include <immintrin.h>
#define PIR_LANES_TARGET __attribute__((target("avx2")))
#define PIR_WIDTH        4
#define PIR_LANES_OF(x)  x##_avx2
#define PIR_LANES_NAME   "AVX2"
#else
#define PIR_LANES_TARGET
#define PIR_WIDTH       2
#define PIR_LANES_OF(x) x##_plain
#define PIR_LANES_NAME  "plain"
#endif

/* Small functions on lanes. */
#define PIR_LANES_INLINE PIR_LANES_TARGET static inline __attribute__((always_inline))

/* A vector of doubles: the compiler's own, loaded from and stored to any address. */
typedef double pir_lane __attribute__((vector_size(8 * PIR_WIDTH), aligned(8), may_alias));

/* As many integers: places, and what comparing gives. */
typedef int64_t pir_lane_bits __attribute__((vector_size(8 * PIR_WIDTH)));

/* Bytes, and numbers of 32 bits, as many as the doubles have room for. */
typedef uint8_t pir_byte_lanes __attribute__((vector_size(8 * PIR_WIDTH), aligned(1), may_alias));
typedef uint32_t pir_number_lanes __attribute__((vector_size(8 * PIR_WIDTH), aligned(4), may_alias));

PIR_LANES_INLINE pir_lane pir_load(const double *from) {
    return *(const pir_lane *)from;
}

PIR_LANES_INLINE void pir_store(double *to, pir_lane v) {
    *(pir_lane *)to = v;
}

/* One number in all lanes. */
PIR_LANES_INLINE pir_lane pir_all(double x) {
#if PIR_LANES_AVX2
    return _mm256_set1_pd(x);
#else
    return (pir_lane){x, x};
#endif
}

PIR_LANES_INLINE pir_lane pir_size(pir_lane a) {
    return (pir_lane)((pir_lane_bits)a & INT64_MAX);
}

/* a where all bits of a place are set, b where none is. */
PIR_LANES_INLINE pir_lane pir_choose(pir_lane_bits where, pir_lane a, pir_lane b) {
    return (pir_lane)(((pir_lane_bits)a & where) | ((pir_lane_bits)b & ~where));
}

/* The lesser and the greater of a and b in every lane, b where they are not ordered. */
PIR_LANES_INLINE pir_lane pir_lesser_lanes(pir_lane a, pir_lane b) {
#if PIR_LANES_AVX2
    return _mm256_min_pd(a, b);
#else
    return pir_choose(a < b, a, b);
#endif
}

PIR_LANES_INLINE pir_lane pir_greater_lanes(pir_lane a, pir_lane b) {
#if PIR_LANES_AVX2
    return _mm256_max_pd(a, b);
#else
    return pir_choose(a > b, a, b);
#endif
}

PIR_LANES_INLINE pir_lane pir_roots(pir_lane a) {
#if PIR_LANES_AVX2
    return _mm256_sqrt_pd(a);
#else
    for (int k = 0; k < PIR_WIDTH; k++)
        a[k] = sqrt(a[k]);
    return a;
#endif
}

/* The places of which all bits are set: a bit each. */
PIR_LANES_INLINE uint32_t pir_where(pir_lane_bits where) {
#if PIR_LANES_AVX2
    return (uint32_t)_mm256_movemask_pd((__m256d)where);
#else
    uint32_t bits = 0;
    for (int k = 0; k < PIR_WIDTH; k++)
        bits |= (uint32_t)(where[k] & 1) << k;
    return bits;
#endif
}

PIR_LANES_INLINE uint32_t pir_numbers_where(pir_number_lanes where) {
#if PIR_LANES_AVX2
    return (uint32_t)_mm256_movemask_ps((__m256)where);
#else
    uint32_t bits = 0;
    for (int k = 0; k < 2 * PIR_WIDTH; k++)
        bits |= (where[k] & 1) << k;
    return bits;
#endif
}

PIR_LANES_INLINE uint32_t pir_bytes_where(pir_byte_lanes where) {
#if PIR_LANES_AVX2
    return (uint32_t)_mm256_movemask_epi8((__m256i)where);
#else
    uint32_t bits = 0;
    for (int k = 0; k < 8 * PIR_WIDTH; k++)
        bits |= (uint32_t)(where[k] & 1) << k;
    return bits;
#endif
}

/* Where bytes below 32 are members of a set, which has a bit for each. */
PIR_LANES_INLINE pir_byte_lanes pir_bytes_in(uint32_t set, pir_byte_lanes bytes) {
#if PIR_LANES_AVX2
    // of each its byte of the set, and in that its bit
    const __m256i bits = _mm256_set1_epi64x((long long)0x8040201008040201), low = _mm256_set1_epi8(7);
    const __m256i bit = _mm256_shuffle_epi8(bits, _mm256_and_si256((__m256i)bytes, low));
    const __m256i place = _mm256_and_si256(_mm256_srli_epi16((__m256i)bytes, 3), low);
    const __m256i byte = _mm256_shuffle_epi8(_mm256_set1_epi32((int)set), place);
    return (pir_byte_lanes)_mm256_cmpeq_epi8(_mm256_and_si256(byte, bit), bit);
#else
    for (int k = 0; k < 8 * PIR_WIDTH; k++)
        bytes[k] = (uint8_t)(0 - (set >> bytes[k] & 1));
    return bytes;
#endif
}

/* The least and the greatest of all lanes. */
PIR_LANES_INLINE double pir_least_of(pir_lane v) {
#if PIR_LANES_AVX2
    const __m128d two = _mm_min_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
    return _mm_cvtsd_f64(_mm_min_sd(two, _mm_unpackhi_pd(two, two)));
#else
    return v[1] < v[0] ? v[1] : v[0];
#endif
}

PIR_LANES_INLINE double pir_greatest_of(pir_lane v) {
#if PIR_LANES_AVX2
    const __m128d two = _mm_max_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
    return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
#else
    return v[1] > v[0] ? v[1] : v[0];
#endif
}

/* --- vectors of three, a coordinate of several in lanes --- */

typedef struct pir_lane3 {
    pir_lane x, y, z;
} pir_lane3;

/* One vector several times. */
PIR_LANES_INLINE pir_lane3 pir_lane3_all(pir_vec3 v) {
    return (pir_lane3){pir_all(v.x), pir_all(v.y), pir_all(v.z)};
}

PIR_LANES_INLINE pir_lane3 pir_lane3_sub(pir_lane3 a, pir_lane3 b) {
    return (pir_lane3){a.x - b.x, a.y - b.y, a.z - b.z};
}

PIR_LANES_INLINE pir_lane3 pir_lane3_cross(pir_lane3 a, pir_lane3 b) {
    return (pir_lane3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

PIR_LANES_INLINE pir_lane pir_lane3_dot(pir_lane3 a, pir_lane3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* The vectors that begin at several places; of each a fourth number is read. */
PIR_LANES_INLINE pir_lane3 pir_lane3_gather(const double *const at[PIR_WIDTH]) {
#if PIR_LANES_AVX2
    const __m256d a = pir_load(at[0]), b = pir_load(at[1]), c = pir_load(at[2]), d = pir_load(at[3]);
    const __m256d xz_ab = _mm256_unpacklo_pd(a, b), y_ab = _mm256_unpackhi_pd(a, b);
    const __m256d xz_cd = _mm256_unpacklo_pd(c, d), y_cd = _mm256_unpackhi_pd(c, d);
    return (pir_lane3){_mm256_permute2f128_pd(xz_ab, xz_cd, 0x20), _mm256_permute2f128_pd(y_ab, y_cd, 0x20),
                       _mm256_permute2f128_pd(xz_ab, xz_cd, 0x31)};
#else
    return (pir_lane3){{at[0][0], at[1][0]}, {at[0][1], at[1][1]}, {at[0][2], at[1][2]}};
#endif
}

#endif
