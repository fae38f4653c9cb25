/* SPDX-License-Identifier: MIT */
/*
 * The text that the kernels for AVX2 and AVX-512 share: a block of eight floats at a time. The file that includes this
 * says for which processor by TARGET, and defines see_block(). It compares by EQUAL(a, b), of integers SAME(a, b):
 * masks of the lanes in which a = b.
 */

#include "polytope/polytope.h"

/* (ux·x + uy·y) + uz·z, rounded as the scalar reference rounds. */
TARGET static inline __m256 dot(__m256 ux, __m256 uy, __m256 uz, __m256 x, __m256 y, __m256 z) {
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(ux, x), _mm256_mul_ps(uy, y)), _mm256_mul_ps(uz, z));
}

/* The least of the eight lanes of a, of b, and of c, in the first three lanes. */
TARGET static inline __m128 least_of_each(__m256 a, __m256 b, __m256 c) {
    __m128 a4 = _mm_min_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
    __m128 b4 = _mm_min_ps(_mm256_castps256_ps128(b), _mm256_extractf128_ps(b, 1));
    __m128 c4 = _mm_min_ps(_mm256_castps256_ps128(c), _mm256_extractf128_ps(c, 1));
    __m128 ab = _mm_min_ps(_mm_unpacklo_ps(a4, b4), _mm_unpackhi_ps(a4, b4));
    __m128 cc = _mm_min_ps(_mm_unpacklo_ps(c4, c4), _mm_unpackhi_ps(c4, c4));
    return _mm_min_ps(_mm_movelh_ps(ab, cc), _mm_movehl_ps(cc, ab));
}

TARGET static inline float greatest_of(__m256 v) {
    __m128 half = _mm_max_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
    half = _mm_max_ps(half, _mm_movehl_ps(half, half));
    return _mm_cvtss_f32(_mm_max_ss(half, _mm_shuffle_ps(half, half, 1)));
}

/* A facet's normal, rotated, and its motion, each component in all lanes. */
struct turned {
    __m256 x, y, z, dx, dy, dz;
};

TARGET static inline struct turned spread(const float turned[8]) {
    return (struct turned){_mm256_broadcast_ss(turned),     _mm256_broadcast_ss(turned + 1),
                           _mm256_broadcast_ss(turned + 2), _mm256_broadcast_ss(turned + 4),
                           _mm256_broadcast_ss(turned + 5), _mm256_broadcast_ss(turned + 6)};
}

/* What blocks have given so far, lane by lane. */
struct seen {
    __m256 highest, least, ahead, behind;
};

/* Checks one block; gives the masks of its sides that were touched, and that the facet is past. */
TARGET static inline void see_block(const pir_ring *ring, const struct turned *t, const pir_step *step,
                                    struct seen *seen, uint32_t *ret_touched, uint32_t *ret_above);

/*
 * Checks a facet in the cell whose ring fills `blocks` blocks, most often one. Returns the greatest values of s, lane
 * by lane.
 */
TARGET static inline __m256 check(const pir_ring *ring, uint32_t blocks, const pir_step *step, const float turned[8],
                                  pir_check *ret_check) {
    const struct turned t = spread(turned);
    struct seen seen = {_mm256_set1_ps(-HUGE_VALF), _mm256_set1_ps(4), _mm256_set1_ps(PIR_FARTHEST_PREDICTION),
                        _mm256_set1_ps(PIR_FARTHEST_PREDICTION)};
    uint64_t touched = 0, above = 0;
    for (uint32_t b = 0; b < blocks; b++) {
        uint32_t touched_here, above_here;
        see_block(ring + b, &t, step, &seen, &touched_here, &above_here);
        touched = b == 0 ? touched_here : pir_side_mask_add(touched, b, touched_here);
        above = b == 0 ? above_here : pir_side_mask_add(above, b, above_here);
    }
    __m128 spans = least_of_each(seen.least, seen.ahead, seen.behind);
    _mm_storeu_ps((float *)ret_check, _mm_sub_ps(spans, _mm_setr_ps(PIR_FLOAT_BOUND, 0, 0, 0)));
    ret_check->touched = touched;
    ret_check->above = above;
    return seen.highest;
}

TARGET static void probe(const pir_facets *facets, const pir_step *step, uint32_t cell, const float turned[8],
                         pir_probe *ret_probe) {
    uint32_t block = facets->ring_block[cell], blocks = facets->ring_block[cell + 1] - block;
    const pir_ring *ring = facets->ring + block;
    const struct turned t = spread(turned);
    float highest = greatest_of(check(ring, blocks, step, turned, &ret_probe->check));
    ret_probe->highest = highest + 0.0f;
    ret_probe->which = 0;
    for (uint32_t b = 0; b < blocks; b++, ring++) {
        __m256 s = dot(t.x, t.y, t.z, _mm256_loadu_ps(ring->x), _mm256_loadu_ps(ring->y), _mm256_loadu_ps(ring->z));
        uint32_t is = EQUAL(s, _mm256_set1_ps(highest));
        if (is) {
            ret_probe->which = b * PIR_LANES + (uint32_t)__builtin_ctz(is);
            break;
        }
    }
}

TARGET static inline void turn_facet(const pir_facets *facets, uint32_t f, float ret_turned[8]) {
    const float *n = facets->normal + (size_t)4 * f;
    __m256 t0 = _mm256_loadu_ps(facets->turn[0]), t1 = _mm256_loadu_ps(facets->turn[1]);
    __m256 t2 = _mm256_loadu_ps(facets->turn[2]);
    _mm256_storeu_ps(ret_turned, dot(t0, t1, t2, _mm256_set1_ps(n[0]), _mm256_set1_ps(n[1]), _mm256_set1_ps(n[2])));
}

TARGET static inline void check_in(const pir_facets *facets, const pir_step *step, uint32_t cell, const float turned[8],
                                   pir_check *ret_check) {
    uint32_t block = facets->ring_block[cell];
    check(facets->ring + block, facets->ring_block[cell + 1] - block, step, turned, ret_check);
}

TARGET static inline __m256 values(const pir_ring *ring, const float turned[8]) {
    return dot(_mm256_broadcast_ss(turned), _mm256_broadcast_ss(turned + 1), _mm256_broadcast_ss(turned + 2),
               _mm256_loadu_ps(ring->x), _mm256_loadu_ps(ring->y), _mm256_loadu_ps(ring->z));
}

TARGET static inline float steepest(const pir_ring *ring, uint32_t blocks, const float turned[8], uint32_t *ret_which) {
    // a point has no directions
    if (blocks == 0)
        return -HUGE_VALF;
    __m256 here = values(ring, turned);
    float highest = greatest_of(here);
    uint32_t which = (uint32_t)__builtin_ctz(EQUAL(here, _mm256_set1_ps(highest)));
    for (uint32_t b = 1; b < blocks; b++) {
        here = values(ring + b, turned);
        float most = greatest_of(here);
        if (most > highest) {
            highest = most;
            which = b * PIR_LANES + (uint32_t)__builtin_ctz(EQUAL(here, _mm256_set1_ps(most)));
        }
    }
    *ret_which = which;
    return highest;
}

TARGET static void find_sides(const pir_polytope *q, pir_arcs *arcs) {
    for (uint32_t k = 0; k < arcs->count; k++) {
        uint32_t start = q->ring_start[arcs->from[k]], end = q->ring_start[arcs->from[k] + 1], found = PIR_NO_SIDE;
        __m256i to = _mm256_set1_epi32((int)arcs->to[k]);
        for (uint32_t i = start; i < end; i += PIR_LANES) {
            // there are as many targets more behind the last
            uint32_t is = SAME(to, _mm256_loadu_si256((const __m256i *)(const void *)(q->target + i)));
            is &= (uint32_t)pir_side_mask(end - i);
            found = is ? i + (uint32_t)__builtin_ctz(is) : found;
        }
        pir_arcs_take_side(q, arcs, k, start, end, found);
    }
}

TARGET static void measure_sides(const pir_facets *facets, const pir_polytope *p, const pir_polytope *q,
                                 pir_arcs *arcs) {
    const __m128 t0 = _mm_loadu_ps(facets->turn[0]), t1 = _mm_loadu_ps(facets->turn[1]);
    const __m128 t2 = _mm_loadu_ps(facets->turn[2]);
    for (uint32_t k = 0; k < arcs->count; k++) {
        __m128 d = _mm256_cvtpd_ps(_mm256_loadu_pd(&p->direction[arcs->half[k]].x));
        __m128 x = _mm_mul_ps(t0, _mm_shuffle_ps(d, d, 0x00)), y = _mm_mul_ps(t1, _mm_shuffle_ps(d, d, 0x55));
        __m128 turned = _mm_add_ps(_mm_add_ps(x, y), _mm_mul_ps(t2, _mm_shuffle_ps(d, d, 0xAA)));
        __m128 right = _mm_mul_ps(turned, _mm_loadu_ps(q->normal4 + 4 * (size_t)arcs->right[k]));
        __m128 left = _mm_mul_ps(turned, _mm_loadu_ps(q->normal4 + 4 * (size_t)arcs->left[k]));
        __m128 sums = _mm_hadd_ps(right, left);
        _mm_storel_pi((__m64 *)(void *)arcs->value[k], _mm_hadd_ps(sums, sums));
    }
}

#define DESCEND_TARGET TARGET
#include "dymsum/kernels/descend_body.h"
#define REVIEW_TARGET TARGET
#include "dymsum/kernels/review_body.h"
