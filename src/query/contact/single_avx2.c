/* SPDX-License-Identifier: MIT */
/*
 * Outlines of single facets of three or four corners, and where their corners are, by AVX2. First a vector holds what
 * one corner is along each of the three axes, then what one coordinate of all corners is. Every operation is that of
 * the plain version, never fused, so the bits are the same.
 */
#include "query/contact/single.h"

#if PIR_HAVE_X86_SINGLES

#include "base/vec_avx2.h"

/* --- where corners are --- */

/* The corners, the fourth of three being the first again, and the lines along the sides that begin there. */
struct four {
    __m256d u, v, along_u, along_v, at, clear;
};

PIR_AVX2 static inline __m256d magnitude(__m256d x) {
    return _mm256_andnot_pd(_mm256_set1_pd(-0.0), x);
}

/* The numbers of the corner after each. */
PIR_AVX2 static inline __m256d next(__m256d x, bool has_four) {
    return has_four ? _mm256_permute4x64_pd(x, 0x39) : _mm256_permute4x64_pd(x, 0x49);
}

PIR_AVX2 static inline struct four with_lines(__m256d u, __m256d v, bool has_four, double snap) {
    struct four four = {.u = u, .v = v};
    four.along_u = _mm256_sub_pd(next(u, has_four), u);
    four.along_v = _mm256_sub_pd(next(v, has_four), v);
    four.at = _mm256_sub_pd(_mm256_mul_pd(four.along_u, v), _mm256_mul_pd(four.along_v, u));
    four.clear = _mm256_mul_pd(_mm256_set1_pd(PIR_CLIP_CLEAR * snap),
                               _mm256_add_pd(magnitude(four.along_u), magnitude(four.along_v)));
    return four;
}

/* How far points are inside of lines, times the lengths of the sides. */
PIR_AVX2 static inline __m256d inside_of(__m256d along_u, __m256d along_v, __m256d at, __m256d u, __m256d v) {
    return _mm256_sub_pd(_mm256_sub_pd(_mm256_mul_pd(along_u, v), _mm256_mul_pd(along_v, u)), at);
}

/* The lower halves of four numbers. */
PIR_AVX2 static inline __m128i halves(__m256i x) {
    __m128 low = _mm_castsi128_ps(_mm256_castsi256_si128(x)), high = _mm_castsi128_ps(_mm256_extracti128_si256(x, 1));
    return _mm_castps_si128(_mm_shuffle_ps(low, high, 0x88));
}

/* Sets which sides cross, from sets of sides of Q per corner and side of P. False where more do than can. */
PIR_AVX2 static inline bool set_crossings(__m128i outside, __m128i beyond, uint32_t p, uint32_t q,
                                          pir_clip_places *places) {
    const __m128i one = _mm_set1_epi32(1), none = _mm_setzero_si128();
    __m128i end = p == 4 ? _mm_shuffle_epi32(outside, 0x39) : _mm_shuffle_epi32(outside, 0x49);
    __m128i first = _mm_sll_epi32(_mm_and_si128(beyond, one), _mm_cvtsi32_si128((int)q - 1));
    __m128i after = _mm_or_si128(_mm_srli_epi32(beyond, 1), first);
    __m128i crossed = _mm_and_si128(_mm_xor_si128(beyond, after), _mm_xor_si128(outside, end));
    __m128i enters = _mm_and_si128(crossed, outside), leaves = _mm_and_si128(crossed, end);
    __m128i more = _mm_or_si128(_mm_and_si128(enters, _mm_sub_epi32(enters, one)),
                                _mm_and_si128(leaves, _mm_sub_epi32(leaves, one)));
    const uint32_t all = (1u << p) - 1;
    _mm_storeu_si128((__m128i *)places->outside, outside);
    _mm_storeu_si128((__m128i *)places->crossed, crossed);
    places->entering = all & ~(uint32_t)_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(enters, none)));
    places->leaving = all & ~(uint32_t)_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(leaves, none)));
    return _mm_testz_si128(more, more);
}

/* As pir_clip_place. */
PIR_AVX2 static inline bool place_four(const struct four *of_p, uint32_t p, const struct four *of_q, uint32_t q,
                                       pir_clip_places *places) {
    double side[6][4];
    _mm256_storeu_pd(side[0], of_q->along_u);
    _mm256_storeu_pd(side[1], of_q->along_v);
    _mm256_storeu_pd(side[2], of_q->at);
    _mm256_storeu_pd(side[3], of_q->clear);
    _mm256_storeu_pd(side[4], of_q->u);
    _mm256_storeu_pd(side[5], of_q->v);
    const __m256d zero = _mm256_setzero_pd();
    __m256d clear = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
    __m256i outside = _mm256_setzero_si256(), beyond = outside, bit = _mm256_set1_epi64x(1);
    for (uint32_t j = 0; j < q; j++) {
        __m256d inside = inside_of(_mm256_set1_pd(side[0][j]), _mm256_set1_pd(side[1][j]), _mm256_set1_pd(side[2][j]),
                                   of_p->u, of_p->v);
        __m256d within =
            inside_of(of_p->along_u, of_p->along_v, of_p->at, _mm256_set1_pd(side[4][j]), _mm256_set1_pd(side[5][j]));
        _mm256_storeu_pd(places->inside[j], inside);
        clear = _mm256_and_pd(clear, _mm256_cmp_pd(magnitude(inside), _mm256_set1_pd(side[3][j]), _CMP_GT_OQ));
        clear = _mm256_and_pd(clear, _mm256_cmp_pd(magnitude(within), of_p->clear, _CMP_GT_OQ));
        __m256i is_outside = _mm256_castpd_si256(_mm256_cmp_pd(inside, zero, _CMP_LT_OQ));
        __m256i is_beyond = _mm256_castpd_si256(_mm256_cmp_pd(within, zero, _CMP_LT_OQ));
        outside = _mm256_or_si256(outside, _mm256_and_si256(is_outside, bit));
        beyond = _mm256_or_si256(beyond, _mm256_and_si256(is_beyond, bit));
        bit = _mm256_add_epi64(bit, bit);
    }
    __m128i some = _mm_or_si128(_mm256_castsi256_si128(beyond), _mm256_extracti128_si256(beyond, 1));
    some = _mm_or_si128(some, _mm_unpackhi_epi64(some, some));
    places->all_beyond = (uint32_t)_mm_cvtsi128_si32(some);
    return set_crossings(halves(outside), halves(beyond), p, q, places) && _mm256_movemask_pd(clear) == 15;
}

/* --- outlines and planes --- */

PIR_AVX2 static inline pir_four three_of(const pir_vec3 axis[3]) {
    return (pir_four){_mm256_set_pd(0, axis[2].x, axis[1].x, axis[0].x),
                      _mm256_set_pd(0, axis[2].y, axis[1].y, axis[0].y),
                      _mm256_set_pd(0, axis[2].z, axis[1].z, axis[0].z)};
}

/* Dot products with one vector. */
PIR_AVX2 static inline __m256d along(pir_four four, pir_vec3 d) {
    return pir_four_dot(four, pir_four_of(d));
}

PIR_AVX2 static inline pir_four to_body(const pir_patch *patch, pir_four d) {
    if (patch->r) {
        const double(*m)[3] = patch->r->m;
        d = (pir_four){along(d, (pir_vec3){m[0][0], m[1][0], m[2][0]}), along(d, (pir_vec3){m[0][1], m[1][1], m[2][1]}),
                       along(d, (pir_vec3){m[0][2], m[1][2], m[2][2]})};
    }
    __m256d sign = _mm256_set1_pd(patch->sign);
    return (pir_four){_mm256_mul_pd(d.x, sign), _mm256_mul_pd(d.y, sign), _mm256_mul_pd(d.z, sign)};
}

/* A vertex along the axes, put as corner i of the outline. */
PIR_AVX2 static inline __m256d put_corner(const pir_patch *patch, uint32_t i, uint32_t v, pir_four body, __m256d at) {
    __m256d x = _mm256_add_pd(along(body, patch->vertex[v]), at);
    pir_corner *corner = &patch->corner[i];
    _mm_storeu_pd(&corner->u, _mm256_castpd256_pd128(x));
    corner->p = v;
    return x;
}

/* Sets outline and plane, as pir_patch_set_single. */
PIR_AVX2 static inline struct four set_single(pir_patch *patch, uint32_t facet, pir_four axes) {
    const pir_polytope *p = patch->polytope;
    const pir_four body = to_body(patch, axes);
    const uint32_t *loop = p->loop + p->loop_start[facet], count = p->loop_start[facet + 1] - p->loop_start[facet];
    const __m256d at = along(axes, patch->at), normal = along(body, p->normal[facet]);
    const __m256d a = put_corner(patch, 0, p->origin[loop[0]], body, at);
    const __m256d b = put_corner(patch, 1, p->origin[loop[1]], body, at);
    const __m256d c = put_corner(patch, 2, p->origin[loop[2]], body, at);
    const __m256d d = count == 4 ? put_corner(patch, 3, p->origin[loop[3]], body, at) : a;
    const __m128d by = _mm_div_sd(_mm_set_sd(-1), _mm256_extractf128_pd(normal, 1));
    const __m128d slopes = _mm_mul_pd(_mm_unpacklo_pd(by, by), _mm256_castpd256_pd128(normal));
    const __m128d parts = _mm_mul_pd(slopes, _mm256_castpd256_pd128(a));
    const __m128d from = _mm_sub_sd(_mm256_extractf128_pd(a, 1), parts);
    _mm_store_sd(&patch->height, _mm_sub_sd(from, _mm_unpackhi_pd(parts, parts)));
    _mm_store_sd(&patch->along_u, slopes);
    _mm_storeh_pd(&patch->along_v, slopes);
    patch->outline = (pir_outline){patch->corner, count};
    const __m256d even = _mm256_permute2f128_pd(a, c, 0x20), odd = _mm256_permute2f128_pd(b, d, 0x20);
    return with_lines(_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd), count == 4, patch->snap);
}

PIR_AVX2 bool pir_singles_place_avx2(pir_patch *p, const pir_single *of_p, pir_patch *q, const pir_single *of_q,
                                     const pir_vec3 axis[3], pir_clip_places *places) {
    const uint32_t *start_p = p->polytope->loop_start + of_p->facet, *start_q = q->polytope->loop_start + of_q->facet;
    if (start_p[1] - start_p[0] > 4 || start_q[1] - start_q[0] > 4)
        return pir_single_version_of(0)->place(p, of_p, q, of_q, axis, places);
    const pir_four axes = three_of(axis);
    const struct four four_p = set_single(p, of_p->facet, axes), four_q = set_single(q, of_q->facet, axes);
    return place_four(&four_p, p->outline.count, &four_q, q->outline.count, places);
}

/* --- around vertices --- */

/*
 * The edges and facets around a vertex, four at once by AVX2. Every operation is that of the plain version, never
 * fused, so the bits are the same. Which edge or facet counts is a guess, and how many there are nearly one: no branch
 * asks for either where a vertex has no more than eight.
 */
PIR_AVX2 static inline __m256d both(const double *low, const double *high) {
    return _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(low)), _mm_loadu_pd(high), 1);
}

/* The set of those of four edges that fall or rise along m by at most a sine. */
PIR_AVX2 static inline uint32_t flat_among(const pir_vec3 *direction, pir_four m, __m256d sine) {
    const double *d = &direction->x;
    const __m256d a = both(d, d + 6), b = both(d + 2, d + 8), c = both(d + 4, d + 10);
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
typedef int pir_no_avx2_single; // a file holds at least a declaration
#endif
