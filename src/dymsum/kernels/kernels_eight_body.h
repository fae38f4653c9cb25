/* SPDX-License-Identifier: MIT */
/*
 * The text that the kernels for AVX2 and AVX-512 share: a block of eight floats at a time. The file that includes this
 * says for which processor by TARGET, and defines see_block(). It compares by EQUAL(a, b), of integers SAME(a, b), and
 * AT_LEAST(a, b): masks of the lanes in which a = b, a ≥ b. By list_lanes(lanes, number, ret) it lists those of eight
 * numbers whose lanes are in a mask.
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

/* Running extremes over the blocks, lane by lane. */
struct ring_extremes {
    __m256 highest, least, ahead, behind;
};

/* Checks one block; gives the masks of its sides that were touched, and that the facet is past. */
TARGET static inline void see_block(const pir_ring *ring, const struct turned *t, const pir_step *step,
                                    struct ring_extremes *seen, uint32_t *ret_touched, uint32_t *ret_above);

/*
 * Checks a facet in the cell whose ring fills `blocks` blocks, most often one. Returns the greatest values of s, lane
 * by lane.
 */
TARGET static inline __m256 check(const pir_ring *ring, uint32_t blocks, const pir_step *step, const float turned[8],
                                  pir_check *ret_check) {
    const struct turned t = spread(turned);
    struct ring_extremes seen = {_mm256_set1_ps(-HUGE_VALF), _mm256_set1_ps(4), _mm256_set1_ps(PIR_FARTHEST_PREDICTION),
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
                         pir_cell_probe *ret_probe) {
    uint32_t blocks;
    const pir_ring *ring = pir_rings_of(facets, cell, &blocks);
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

TARGET static inline void check_in(const pir_ring *ring, uint32_t blocks, const pir_step *step, const float turned[8],
                                   pir_check *ret_check) {
    check(ring, blocks, step, turned, ret_check);
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
        __m128 d = _mm_loadu_ps(&p->edge_arc[arcs->edge[k]].x);
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

/* --- what a region's sweep finds --- */

struct sight {
    __m256 x, y, z, cosine, sine, slack;
};

TARGET static inline struct sight spread_sight(const pir_sight *sight) {
    return (struct sight){_mm256_set1_ps(sight->x),      _mm256_set1_ps(sight->y),    _mm256_set1_ps(sight->z),
                          _mm256_set1_ps(sight->cosine), _mm256_set1_ps(sight->sine), _mm256_set1_ps(sight->slack)};
}

TARGET static inline __m256i numbers_at(const uint32_t *number) {
    return _mm256_loadu_si256((const __m256i *)(const void *)number);
}

/* The cosines of eight vectors, x, y, z, to what is in sight. */
TARGET static inline __m256 cosines(const float *row, const struct sight *t) {
    return dot(_mm256_loadu_ps(row), _mm256_loadu_ps(row + PIR_LANES), _mm256_loadu_ps(row + 2 * PIR_LANES), t->x, t->y,
               t->z);
}

TARGET static uint32_t list_caps(const pir_caps *caps, const pir_sight *sight, uint32_t *ret_which) {
    const struct sight t = spread_sight(sight);
    const __m256 zero = _mm256_setzero_ps(), sign = _mm256_set1_ps(-0.0f);
    __m256i number = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    uint32_t found = 0;
    for (uint32_t b = 0; b * PIR_LANES < caps->count; b++) {
        uint32_t k = b * PIR_LANES;
        __m256 c = _mm256_loadu_ps(caps->cosine + k), s = _mm256_loadu_ps(caps->sine + k);
        __m256 near = dot(_mm256_loadu_ps(caps->x + k), _mm256_loadu_ps(caps->y + k), _mm256_loadu_ps(caps->z + k), t.x,
                          t.y, t.z);
        __m256 beyond = _mm256_sub_ps(near, _mm256_sub_ps(_mm256_mul_ps(t.cosine, c), _mm256_mul_ps(t.sine, s)));
        __m256 past = _mm256_xor_ps(sign, _mm256_add_ps(_mm256_mul_ps(t.sine, c), _mm256_mul_ps(t.cosine, s)));
        // a reach beyond π includes all
        uint32_t lanes = AT_LEAST(_mm256_add_ps(_mm256_max_ps(beyond, past), t.slack), zero);
        found += list_lanes(lanes & pir_lanes_used(caps->count, b), number, ret_which + found);
        number = _mm256_add_epi32(number, _mm256_set1_epi32(PIR_LANES));
    }
    return found;
}

TARGET static uint32_t list_points(const pir_clustered *points, const pir_sight *sight, uint32_t *ret_item) {
    const struct sight t = spread_sight(sight);
    uint32_t found = 0;
    for (uint32_t j = 0; j < points->clusters; j++) {
        uint32_t k = points->cluster[j];
        __m256 near = cosines(points->row + (size_t)k * PIR_POINT_ROWS * PIR_LANES, &t);
        __m256 by = _mm256_add_ps(_mm256_sub_ps(near, t.cosine), t.slack);
        uint32_t lanes = AT_LEAST(by, _mm256_setzero_ps()) & pir_lanes_used(points->count, k);
        found += list_lanes(lanes, numbers_at(points->item + (size_t)k * PIR_LANES), ret_item + found);
    }
    return found;
}

TARGET static uint32_t list_arcs(const pir_clustered *arcs, const pir_sight *sight, uint32_t *at, uint32_t *ret_item) {
    const struct sight t = spread_sight(sight);
    const __m256 sign = _mm256_set1_ps(-0.0f), least = _mm256_xor_ps(sign, t.slack);
    uint32_t found = 0, j = *at;
    for (; j < arcs->clusters; j++) {
        uint32_t k = arcs->cluster[j], used = pir_lanes_used(arcs->count, k);
        const float *row = arcs->row + (size_t)k * PIR_ARC_ROWS * PIR_LANES;
        __m256 x = cosines(row + PIR_ARC_FROM * PIR_LANES, &t), y = cosines(row + PIR_ARC_TO * PIR_LANES, &t);
        __m256 d = cosines(row + PIR_ARC_ALONG * PIR_LANES, &t), c = _mm256_loadu_ps(row + PIR_ARC_COSINE * PIR_LANES);
        __m256 one = _mm256_sub_ps(x, _mm256_mul_ps(c, y)), other = _mm256_sub_ps(y, _mm256_mul_ps(c, x));
        __m256 beside = _mm256_sub_ps(t.sine, _mm256_andnot_ps(sign, d));
        __m256 passing = _mm256_min_ps(_mm256_min_ps(one, other), beside);
        __m256 by = _mm256_max_ps(_mm256_sub_ps(_mm256_max_ps(x, y), t.cosine), passing);
        if (AT_LEAST(t.slack, _mm256_andnot_ps(sign, by)) & used)
            break;
        found +=
            list_lanes(AT_LEAST(by, least) & used, numbers_at(arcs->item + (size_t)k * PIR_LANES), ret_item + found);
    }
    *at = j;
    return found;
}

/* --- where descents start --- */

/* The normals of eight facets, component by component. */
TARGET static inline void gather_normals(const float *normal, const uint32_t *facet, __m256 ret_component[3]) {
    __m256 row[4];
    for (int k = 0; k < 4; k++)
        row[k] = _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(normal + (size_t)4 * facet[k])),
                                      _mm_loadu_ps(normal + (size_t)4 * facet[k + 4]), 1);
    __m256 a = _mm256_unpacklo_ps(row[0], row[1]), b = _mm256_unpacklo_ps(row[2], row[3]);
    __m256 c = _mm256_unpackhi_ps(row[0], row[1]), d = _mm256_unpackhi_ps(row[2], row[3]);
    ret_component[0] = _mm256_shuffle_ps(a, b, 0x44);
    ret_component[1] = _mm256_shuffle_ps(a, b, 0xEE);
    ret_component[2] = _mm256_shuffle_ps(c, d, 0x44);
}

/* The coordinates, from 0, of the squares that x is in, from −1 to 1. */
TARGET static inline __m256i along(__m256 x, uint32_t side) {
    __m256 at = _mm256_mul_ps(_mm256_add_ps(x, _mm256_set1_ps(1)), _mm256_set1_ps(0.5f * (float)side));
    return _mm256_min_epi32(_mm256_cvttps_epi32(at), _mm256_set1_epi32((int)side - 1));
}

/* The squares of eight unit vectors. */
TARGET static inline __m256i squares_of(uint32_t side, __m256 x, __m256 y, __m256 z) {
    const __m256 sign = _mm256_set1_ps(-0.0f), one = _mm256_set1_ps(1);
    __m256 size =
        _mm256_add_ps(_mm256_add_ps(_mm256_andnot_ps(sign, x), _mm256_andnot_ps(sign, y)), _mm256_andnot_ps(sign, z));
    __m256 scale = _mm256_div_ps(one, size), u = _mm256_mul_ps(x, scale), v = _mm256_mul_ps(y, scale);
    __m256 over_u = _mm256_sub_ps(one, _mm256_andnot_ps(sign, v)),
           over_v = _mm256_sub_ps(one, _mm256_andnot_ps(sign, u));
    over_u = _mm256_or_ps(_mm256_andnot_ps(sign, over_u), _mm256_and_ps(sign, u));
    over_v = _mm256_or_ps(_mm256_andnot_ps(sign, over_v), _mm256_and_ps(sign, v));
    __m256 below = _mm256_cmp_ps(z, _mm256_setzero_ps(), _CMP_LT_OQ);
    __m256i i = along(_mm256_blendv_ps(u, over_u, below), side), j = along(_mm256_blendv_ps(v, over_v, below), side);
    return _mm256_add_epi32(_mm256_mullo_epi32(j, _mm256_set1_epi32((int)side)), i);
}

TARGET static void find_starts(const pir_facets *facets, const pir_starts *starts, const uint32_t *facet,
                               uint32_t count, uint32_t *ret_from) {
    __m256 turn[3][3];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            turn[k][i] = _mm256_set1_ps(facets->turn[k][i]);
    for (uint32_t first = 0; first < count; first += PIR_LANES) {
        uint32_t used = count - first < PIR_LANES ? count - first : PIR_LANES, square[PIR_LANES], number[PIR_LANES];
        for (uint32_t i = 0; i < PIR_LANES; i++)
            number[i] = facet[first + (i < used ? i : 0)];
        __m256 n[3], turned[3];
        gather_normals(facets->normal, number, n);
        for (int i = 0; i < 3; i++)
            turned[i] = dot(turn[0][i], turn[1][i], turn[2][i], n[0], n[1], n[2]);
        _mm256_storeu_si256((__m256i *)(void *)square, squares_of(starts->side, turned[0], turned[1], turned[2]));
        for (uint32_t i = 0; i < used; i++)
            ret_from[first + i] = starts->cell[square[i]];
    }
}
