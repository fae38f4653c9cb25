/* SPDX-License-Identifier: MIT */
/*
 * Outlines of single facets of three or four corners, and where their corners are, by AVX2. First a vector holds what
 * one corner is along each of the three axes, then what one coordinate of all corners is. Every operation is that of
 * the plain version, never fused, so the bits are the same.
 */
#define PIR_LANES_AVX2 1
#include "base/lane_text.h"
#include "query/contact/single.h"

/* --- where corners are --- */

/* The corners, the fourth of three being the first again, and the lines along the sides that begin there. */
struct four {
    pir_lane u, v, along_u, along_v, at, clear;
};

/* The numbers of the corner after each. */
PIR_LANES_INLINE pir_lane next(pir_lane x, bool has_four) {
    return has_four ? _mm256_permute4x64_pd(x, 0x39) : _mm256_permute4x64_pd(x, 0x49);
}

PIR_LANES_INLINE struct four with_lines(pir_lane u, pir_lane v, bool has_four, double snap) {
    const pir_lane along_u = next(u, has_four) - u, along_v = next(v, has_four) - v;
    return (struct four){u,
                         v,
                         along_u,
                         along_v,
                         along_u * v - along_v * u,
                         PIR_CLIP_CLEAR * snap * (pir_size(along_u) + pir_size(along_v))};
}

/* The lower halves of four numbers. */
PIR_LANES_TARGET static inline __m128i halves(__m256i x) {
    __m128 low = _mm_castsi128_ps(_mm256_castsi256_si128(x)), high = _mm_castsi128_ps(_mm256_extracti128_si256(x, 1));
    return _mm_castps_si128(_mm_shuffle_ps(low, high, 0x88));
}

/* Sets which sides cross, from sets of sides of Q per corner and side of P. False where more do than can. */
PIR_LANES_TARGET static inline bool set_crossings(__m128i outside, __m128i beyond, uint32_t p, uint32_t q,
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

/* As pir_clip_place. How far points are inside of lines is times the lengths of the sides. */
PIR_LANES_INLINE bool place_four(const struct four *of_p, uint32_t p, const struct four *of_q, uint32_t q,
                                 pir_clip_places *places) {
    const struct four side = *of_q;
    pir_lane_bits clear = ~(pir_lane_bits){0}, outside = {0}, beyond = {0}, bit = (pir_lane_bits){0} + 1;
    for (uint32_t j = 0; j < q; j++, bit += bit) {
        pir_lane inside = side.along_u[j] * of_p->v - side.along_v[j] * of_p->u - side.at[j];
        pir_lane within = of_p->along_u * side.v[j] - of_p->along_v * side.u[j] - of_p->at;
        pir_store(places->inside[j], inside);
        clear &= (pir_size(inside) > pir_all(side.clear[j])) & (pir_size(within) > of_p->clear);
        outside |= (inside < (pir_lane){0}) & bit;
        beyond |= (within < (pir_lane){0}) & bit;
    }
    places->all_beyond = (uint32_t)(beyond[0] | beyond[1] | beyond[2] | beyond[3]);
    return set_crossings(halves((__m256i)outside), halves((__m256i)beyond), p, q, places) && pir_where(clear) == 15;
}

/* --- outlines and planes --- */

/* Dot products with one vector. */
PIR_LANES_INLINE pir_lane along(pir_lane3 four, pir_vec3 d) {
    return pir_lane3_dot(four, pir_lane3_all(d));
}

PIR_LANES_INLINE pir_lane3 to_body(const pir_patch *patch, pir_lane3 d) {
    if (patch->r) {
        const double(*m)[3] = patch->r->m;
        d = (pir_lane3){along(d, (pir_vec3){m[0][0], m[1][0], m[2][0]}),
                        along(d, (pir_vec3){m[0][1], m[1][1], m[2][1]}),
                        along(d, (pir_vec3){m[0][2], m[1][2], m[2][2]})};
    }
    return (pir_lane3){d.x * patch->sign, d.y * patch->sign, d.z * patch->sign};
}

/* A vertex along the axes, put as corner i of the outline. */
PIR_LANES_INLINE pir_lane put_corner(const pir_patch *patch, uint32_t i, uint32_t v, pir_lane3 body, pir_lane at) {
    pir_lane x = along(body, patch->vertex[v]) + at;
    pir_corner *corner = &patch->corner[i];
    _mm_storeu_pd(&corner->u, _mm256_castpd256_pd128(x));
    corner->p = v;
    return x;
}

/* Sets outline and plane, as pir_patch_set_single. */
PIR_LANES_INLINE struct four set_single(pir_patch *patch, uint32_t facet, pir_lane3 axes) {
    const pir_polytope *p = patch->polytope;
    const pir_lane3 body = to_body(patch, axes);
    const uint32_t *loop = p->loop + p->loop_start[facet], count = p->loop_start[facet + 1] - p->loop_start[facet];
    const pir_lane at = along(axes, patch->at), normal = along(body, p->normal[facet]);
    const pir_lane a = put_corner(patch, 0, p->origin[loop[0]], body, at);
    const pir_lane b = put_corner(patch, 1, p->origin[loop[1]], body, at);
    const pir_lane c = put_corner(patch, 2, p->origin[loop[2]], body, at);
    const pir_lane d = count == 4 ? put_corner(patch, 3, p->origin[loop[3]], body, at) : a;
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

PIR_LANES_TARGET static bool place(pir_patch *p, const pir_single *of_p, pir_patch *q, const pir_single *of_q,
                                   const pir_vec3 axis[3], pir_clip_places *places) {
    const uint32_t *start_p = p->polytope->loop_start + of_p->facet, *start_q = q->polytope->loop_start + of_q->facet;
    if (start_p[1] - start_p[0] > 4 || start_q[1] - start_q[0] > 4)
        return pir_single_plain.place(p, of_p, q, of_q, axis, places);
    const pir_lane3 axes = {{axis[0].x, axis[1].x, axis[2].x, 0},
                            {axis[0].y, axis[1].y, axis[2].y, 0},
                            {axis[0].z, axis[1].z, axis[2].z, 0}};
    const struct four four_p = set_single(p, of_p->facet, axes), four_q = set_single(q, of_q->facet, axes);
    return place_four(&four_p, p->outline.count, &four_q, q->outline.count, places);
}

/* --- around vertices --- */

/*
 * The edges and facets around a vertex, four at once by AVX2. Every operation is that of the plain version, never
 * fused, so the bits are the same. Which edge or facet counts is a guess, and how many there are nearly one: no branch
 * asks for either where a vertex has no more than eight.
 */
PIR_LANES_INLINE pir_lane along_four(const pir_vec3 *a, const pir_vec3 *b, const pir_vec3 *c, const pir_vec3 *d,
                                     pir_lane3 m) {
    const double *const at[4] = {&a->x, &b->x, &c->x, &d->x};
    return pir_lane3_dot(m, pir_lane3_gather(at));
}

/* The set of those of four edges that fall or rise along m by at most a sine. */
PIR_LANES_INLINE uint32_t flat_among(const pir_vec3 *d, pir_lane3 m, double sine) {
    return pir_where(pir_size(along_four(d, d + 1, d + 2, d + 3, m)) <= pir_all(sine));
}

/* Half a number each for the edges at both ends of one: more than eight are too many. */
#define HALF 16
#define MOST 8

static inline uint32_t ones(uint32_t count) {
    return (1u << count) - 1;
}

PIR_LANES_TARGET static bool is_sharp(const pir_polytope *p, pir_feature feature, pir_vec3 m, double sine) {
    if (p->artificial)
        return pir_single_plain.is_sharp(p, feature, m, sine);
    const bool is_edge = feature.kind == PIR_FEATURE_EDGE;
    // all edges of a vertex are looked at, and none at its other end
    const uint32_t half = is_edge ? p->edge_half[feature.index] : p->ring_start[feature.index], twin = p->twin[half];
    const uint32_t *of_origin = p->ring_start + p->origin[half], *of_target = p->ring_start + p->target[half];
    const uint32_t origin = of_origin[0], origins = of_origin[1] - origin, target = of_target[0],
                   targets = of_target[1] - target;
    if ((origins > MOST) | (targets > MOST))
        return pir_single_plain.is_sharp(p, feature, m, sine);
    const pir_lane3 all = pir_lane3_all(m);
    const pir_vec3 *direction = p->direction;
    const uint32_t flat =
        flat_among(direction + origin, all, sine) | flat_among(direction + origin + 4, all, sine) << 4 |
        flat_among(direction + target, all, sine) << HALF | flat_among(direction + target + 4, all, sine) << (HALF + 4);
    const uint32_t beside = (ones(origins) & ~(1u << (half - origin))) | (ones(targets) & ~(1u << (twin - target)))
                                                                             << HALF;
    return (flat & (is_edge ? beside : ones(origins))) == 0;
}

/* The cosines of the facets left of four halfedges with a direction. */
PIR_LANES_INLINE pir_lane cosines(const pir_polytope *p, uint32_t half, pir_lane3 out) {
    const uint32_t *left = p->left + half;
    return along_four(&p->normal[left[0]], &p->normal[left[1]], &p->normal[left[2]], &p->normal[left[3]], out);
}

PIR_LANES_TARGET static pir_foremost foremost(const pir_polytope *p, uint32_t v, pir_vec3 out, double sine) {
    // ones, then zeros, from 8 - count on
    static const uint64_t steps[16] = {UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX,
                                       UINT64_MAX, UINT64_MAX, UINT64_MAX, UINT64_MAX};
    const uint32_t start = p->ring_start[v], count = p->ring_start[v + 1] - start;
    if (count > MOST)
        return pir_single_plain.foremost(p, v, out, sine);
    const pir_lane3 all = pir_lane3_all(out);
    const pir_lane least = pir_all(PIR_LEAST_COSINE);
    const double *mask = (const double *)steps + 8 - count;
    const pir_vec3 *direction = p->direction + start;
    const uint32_t flat = flat_among(direction, all, sine) | flat_among(direction + 4, all, sine) << 4;
    const pir_lane low = _mm256_blendv_pd(least, cosines(p, start, all), pir_load(mask)),
                   high = _mm256_blendv_pd(least, cosines(p, start + 4, all), pir_load(mask + 4));
    const double cosine = pir_greatest_of(pir_greater_lanes(low, high));
    const uint32_t first = pir_where(low == pir_all(cosine)) | pir_where(high == pir_all(cosine)) << 4;
    const bool is_some = (cosine > PIR_LEAST_COSINE) & ((flat & ones(count)) == 0);
    return (pir_foremost){is_some ? start + (uint32_t)__builtin_ctz(first) : UINT32_MAX, cosine};
}

const pir_single_version pir_single_avx2 = {is_sharp, foremost, place};
