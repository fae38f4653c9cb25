/* SPDX-License-Identifier: MIT */
/*
 * Loops over what is around a vertex or a facet (around.h), by AVX2. Every operation is that of plain code, never
 * fused, so the bits are the same.
 */
#ifndef PIR_QUERY_FRAME_FOURS_AVX2_H
#define PIR_QUERY_FRAME_FOURS_AVX2_H

#include "base/vec_avx2.h"
#include "query/frame/frame.h"

/* --- one coordinate of four vectors in each register --- */

PIR_AVX2 static inline pir_four pir_four_at(const pir_fours *v) {
    return (pir_four){_mm256_loadu_pd(v->x), _mm256_loadu_pd(v->y), _mm256_loadu_pd(v->z)};
}

PIR_AVX2 static inline pir_four pir_four_sub(pir_four a, pir_four b) {
    return (pir_four){_mm256_sub_pd(a.x, b.x), _mm256_sub_pd(a.y, b.y), _mm256_sub_pd(a.z, b.z)};
}

/* The greatest and the least of four. */
PIR_AVX2 static inline double pir_four_most(__m256d v) {
    __m128d two = _mm_max_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
    return _mm_cvtsd_f64(_mm_max_sd(two, _mm_unpackhi_pd(two, two)));
}

PIR_AVX2 static inline double pir_four_least(__m256d v) {
    __m128d two = _mm_min_pd(_mm256_castpd256_pd128(v), _mm256_extractf128_pd(v, 1));
    return _mm_cvtsd_f64(_mm_min_sd(two, _mm_unpackhi_pd(two, two)));
}

/* --- around --- */

/* The steepest of the edges of a vertex along n. */
PIR_AVX2 static inline double pir_ring_most(const pir_around *around, uint32_t vertex, pir_four n) {
    const uint32_t blocks = around->ring_blocks;
    const pir_fours *ring = &around->rings[vertex * blocks];
    // what is no number is taken for the second operand
    __m256d most = _mm256_max_pd(pir_four_dot(n, pir_four_at(ring)), _mm256_set1_pd(-HUGE_VAL));
    for (uint32_t k = 1; k < blocks; k++)
        most = _mm256_max_pd(pir_four_dot(n, pir_four_at(&ring[k])), most);
    return pir_four_most(most);
}

/* Read from 16 − i on it is a mask of place i. */
static const uint64_t pir_one_of[32] = {[16] = UINT64_MAX};

/* The steepest of all edges of a vertex but the one in place `own`. */
PIR_AVX2 static inline double pir_ring_most_but(const pir_around *around, uint32_t vertex, uint32_t own, pir_four n) {
    const uint32_t blocks = around->ring_blocks;
    const pir_fours *ring = &around->rings[vertex * blocks];
    const __m256d none = _mm256_set1_pd(-HUGE_VAL);
    __m256d most = none;
    for (uint32_t k = 0; k < blocks; k++) {
        __m256d slopes = pir_four_dot(n, pir_four_at(&ring[k]));
        __m256d mask = _mm256_loadu_pd((const double *)&pir_one_of[16 - own + 4 * k]);
        most = _mm256_max_pd(_mm256_blendv_pd(slopes, none, mask), most);
    }
    return pir_four_most(most);
}

/* How far `at` is from the nearest side of a facet; negative outside. */
PIR_AVX2 static inline double pir_sides_least(const pir_around *around, uint32_t facet, pir_four at) {
    const uint32_t blocks = around->side_blocks;
    const pir_sides *sides = &around->sides[facet * blocks];
    __m256d first = pir_four_dot(pir_four_at(&sides->in), pir_four_sub(at, pir_four_at(&sides->from)));
    __m256d least = _mm256_min_pd(first, _mm256_set1_pd(HUGE_VAL));
    for (uint32_t k = 1; k < blocks; k++) {
        __m256d next = pir_four_dot(pir_four_at(&sides[k].in), pir_four_sub(at, pir_four_at(&sides[k].from)));
        least = _mm256_min_pd(next, least);
    }
    return pir_four_least(least);
}

#endif
