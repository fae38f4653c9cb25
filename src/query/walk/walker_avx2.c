/* SPDX-License-Identifier: MIT */
/* Walks by AVX2. Every operation is that of the plain version, never fused, so the bits are the same. */
#define PIR_LANES_AVX2 1
#include "base/lane_text.h"
#include "query/walk/walker.h"

PIR_LANES_INLINE pir_lane3 four_at(const pir_fours *v) {
    return (pir_lane3){pir_load(v->x), pir_load(v->y), pir_load(v->z)};
}

/* How far `at` is within four sides. */
PIR_LANES_INLINE pir_lane within(const pir_sides *sides, pir_lane3 at) {
    return pir_lane3_dot(four_at(&sides->in), pir_lane3_sub(at, four_at(&sides->from)));
}

/*
 * The steepest of the edges of a vertex along n, but those of a set of bits. What is no number is taken for the second
 * operand of a comparison.
 */
PIR_LANES_INLINE double steepest_but(const pir_body *body, uint32_t vertex, pir_vec3 v, const uint64_t *but) {
    const uint32_t blocks = body->around->ring_blocks;
    const pir_fours *ring = &body->around->rings[vertex * blocks];
    const pir_lane3 n = pir_lane3_all(v);
    const pir_lane none = pir_all(-HUGE_VAL);
    pir_lane most = none;
    uint32_t k = 0;
    do {
        pir_lane slopes = pir_lane3_dot(n, four_at(&ring[k]));
        if (but)
            slopes = _mm256_blendv_pd(slopes, none, pir_load((const double *)but + 4 * k));
        most = pir_greater_lanes(slopes, most);
    } while (++k < blocks);
    return pir_greatest_of(most);
}

PIR_LANES_INLINE double steepest_at(const pir_body *body, uint32_t vertex, pir_vec3 n) {
    return steepest_but(body, vertex, n, NULL);
}

/* Of all halfedges from the origin of one, but that itself. */
PIR_LANES_INLINE double steepest_beside(const pir_body *body, uint32_t half, pir_vec3 n) {
    // read from 16 − i on it is a mask of place i
    static const uint64_t one[32] = {[16] = UINT64_MAX};
    const pir_polytope *p = body->polytope;
    return steepest_but(body, p->origin[half], n, &one[16 - (half - p->ring_start[p->origin[half]])]);
}

/* The sides are across the facet's own normal, which is n. */
PIR_LANES_INLINE double within_facet(const pir_body *body, uint32_t facet, pir_vec3 n, pir_vec3 at) {
    const uint32_t blocks = body->around->side_blocks;
    const pir_sides *sides = &body->around->sides[facet * blocks];
    pir_lane least = pir_all(HUGE_VAL);
    (void)n;
    uint32_t k = 0;
    do
        least = pir_lesser_lanes(within(&sides[k], pir_lane3_all(at)), least);
    while (++k < blocks);
    return pir_least_of(least);
}

/* The first of four that is the least of them, and below another number; that number where none is. */
struct first {
    uint32_t place;
    double least;
};

PIR_LANES_INLINE struct first take(struct first first, pir_lane four, uint32_t from) {
    const double least = pir_least_of(four);
    const uint32_t at = pir_where(four == pir_all(least));
    return least < first.least ? (struct first){from + (uint32_t)__builtin_ctz(at | 16), least} : first;
}

PIR_LANES_INLINE uint32_t leave_cell(const pir_body *body, uint32_t vertex, pir_vec3 n, pir_vec3 m) {
    const uint32_t blocks = body->around->ring_blocks, start = body->polytope->ring_start[vertex];
    const pir_fours *ring = &body->around->rings[vertex * blocks];
    struct first first = {UINT32_MAX, HUGE_VAL};
    for (uint32_t k = 0; k < blocks; k++) {
        const pir_lane3 d = four_at(&ring[k]);
        const pir_lane from = pir_lane3_dot(d, pir_lane3_all(n)), to = pir_lane3_dot(d, pir_lane3_all(m));
        const pir_lane part = pir_choose(to > (pir_lane){0}, from / (from - to), pir_all(HUGE_VAL));
        first = take(first, part, start + 4 * k);
    }
    return first.place;
}

PIR_LANES_INLINE uint32_t farthest_beyond(const pir_body *body, uint32_t facet, pir_vec3 at) {
    const uint32_t blocks = body->around->side_blocks, start = body->polytope->loop_start[facet];
    const pir_sides *sides = &body->around->sides[facet * blocks];
    struct first first = {start, HUGE_VAL};
    for (uint32_t k = 0; k < blocks; k++)
        first = take(first, pir_lesser_lanes(within(&sides[k], pir_lane3_all(at)), pir_all(HUGE_VAL)), start + 4 * k);
    return first.place;
}

/* Most climbs end where they begin. */
PIR_LANES_INLINE uint32_t climb(const pir_body *body, pir_vec3 n, uint32_t from) {
    bool is_top = body->around && !(steepest_at(body, from, n) > PIR_LEAST_SLOPE);
    return is_top ? from : pir_climb(body->polytope, n, from);
}

#define WALK_TARGET     PIR_LANES_TARGET
#define WALK_CAN(frame) ((frame)->p.around && (frame)->q.around)
#define WALK_ELSE       (&pir_walker_plain)
#define WALK_NAME       pir_walker_avx2
#include "query/walk/walker_body.h"
