/* SPDX-License-Identifier: MIT */
/*
 * The edges and facets around a vertex, four at once by AVX2. Every operation is that of the plain version, never
 * fused, so the bits are the same. Which edge or facet counts is a guess, and how many there are nearly one: no branch
 * asks for either where a vertex has no more than eight.
 */
#include "query/contact/single_versions.h"

#if PIR_HAVE_X86_SINGLES

#include "base/vec_avx2.h"

PIR_AVX2 static inline __m256d halves(const double *low, const double *high) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(low)), _mm_loadu_pd(high), 1);
}

/* The set of those of four edges that fall or rise along m by at most a sine. */
PIR_AVX2 static inline uint32_t flat_among(const pir_vec3 *direction, pir_four m, __m256d sine) {
    const double *d = &direction->x;
    const __m256d a = halves(d, d + 6), b = halves(d + 2, d + 8), c = halves(d + 4, d + 10);
    const __m256d slope = pir_four_dot(
        m, (pir_four){_mm256_shuffle_pd(a, b, 10), _mm256_shuffle_pd(a, c, 5), _mm256_shuffle_pd(b, c, 10)});
    const __m256d size = _mm256_andnot_pd(_mm256_set1_pd(-0.0), slope);
    return (uint32_t)_mm256_movemask_pd(_mm256_cmp_pd(size, sine, _CMP_LE_OQ));
}

/* Half a number each for the edges at both ends of one: more than eight are too many. */
#define HALF 16
#define MOST 8

static inline uint32_t ones(uint32_t count) {
    return (1u << count) - 1;
}

PIR_AVX2 bool pir_is_sharp_avx2(const pir_polytope *p, pir_feature feature, pir_vec3 m, double sine) {
    if (p->artificial)
        return pir_single_version_of(0)->is_sharp(p, feature, m, sine);
    const bool is_edge = feature.kind == PIR_FEATURE_EDGE;
    // all edges of a vertex are looked at, and none at its other end
    const uint32_t half = is_edge ? p->edge_half[feature.index] : p->ring_start[feature.index], twin = p->twin[half];
    const uint32_t *of_origin = p->ring_start + p->origin[half], *of_target = p->ring_start + p->target[half];
    const uint32_t origin = of_origin[0], origins = of_origin[1] - origin, target = of_target[0],
                   targets = of_target[1] - target;
    if ((origins > MOST) | (targets > MOST))
        return pir_single_version_of(0)->is_sharp(p, feature, m, sine);
    const pir_four all = pir_four_of(m);
    const __m256d sines = _mm256_set1_pd(sine);
    const pir_vec3 *direction = p->direction;
    const uint32_t flat = flat_among(direction + origin, all, sines) |
                          flat_among(direction + origin + 4, all, sines) << 4 |
                          flat_among(direction + target, all, sines) << HALF |
                          flat_among(direction + target + 4, all, sines) << (HALF + 4);
    const uint32_t beside = (ones(origins) & ~(1u << (half - origin))) | (ones(targets) & ~(1u << (twin - target)))
                                                                             << HALF;
    return (flat & (is_edge ? beside : ones(origins))) == 0;
}

/* The cosines of the facets left of four halfedges with a direction. */
PIR_AVX2 static inline __m256d cosines(const pir_polytope *p, uint32_t half, pir_four out) {
    const uint32_t *left = p->left + half;
    const __m256d a = _mm256_loadu_pd(&p->normal[left[0]].x), b = _mm256_loadu_pd(&p->normal[left[1]].x),
                  c = _mm256_loadu_pd(&p->normal[left[2]].x), d = _mm256_loadu_pd(&p->normal[left[3]].x);
    const __m256d xz_ab = _mm256_unpacklo_pd(a, b), xz_cd = _mm256_unpacklo_pd(c, d), y_ab = _mm256_unpackhi_pd(a, b),
                  y_cd = _mm256_unpackhi_pd(c, d);
    return pir_four_dot(out,
                        (pir_four){_mm256_permute2f128_pd(xz_ab, xz_cd, 0x20), _mm256_permute2f128_pd(y_ab, y_cd, 0x20),
                                   _mm256_permute2f128_pd(xz_ab, xz_cd, 0x31)});
}

PIR_AVX2 static inline __m256d greater(__m256d a, __m256d b) {
    return _mm256_max_pd(a, b);
}

PIR_AVX2 pir_foremost pir_foremost_avx2(const pir_polytope *p, uint32_t v, pir_vec3 out, double sine) {
    // ones, then zeros, from 8 - count on
    static const uint64_t some[16] = {UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX,
                                      UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX};
    const uint32_t start = p->ring_start[v], count = p->ring_start[v + 1] - start;
    if (count > MOST)
        return pir_single_version_of(0)->foremost(p, v, out, sine);
    const pir_four all = pir_four_of(out);
    const __m256d sines = _mm256_set1_pd(sine), least = _mm256_set1_pd(PIR_LEAST_COSINE);
    const double *mask = (const double *)some + 8 - count;
    const pir_vec3 *direction = p->direction + start;
    const uint32_t flat = flat_among(direction, all, sines) | flat_among(direction + 4, all, sines) << 4;
    const __m256d low = _mm256_blendv_pd(least, cosines(p, start, all), _mm256_loadu_pd(mask)),
                  high = _mm256_blendv_pd(least, cosines(p, start + 4, all), _mm256_loadu_pd(mask + 4));
    __m256d most = greater(low, high);
    most = greater(most, _mm256_permute2f128_pd(most, most, 1));
    most = greater(most, _mm256_permute_pd(most, 5));
    const uint32_t first = (uint32_t)_mm256_movemask_pd(_mm256_cmp_pd(low, most, _CMP_EQ_OQ)) |
                           (uint32_t)_mm256_movemask_pd(_mm256_cmp_pd(high, most, _CMP_EQ_OQ)) << 4;
    const double cosine = _mm256_cvtsd_f64(most);
    const bool is_some = (cosine > PIR_LEAST_COSINE) & ((flat & ones(count)) == 0);
    return (pir_foremost){is_some ? start + (uint32_t)__builtin_ctz(first) : UINT32_MAX, cosine};
}

#else
typedef int pir_no_avx2_ring; // a file holds at least a declaration
#endif
