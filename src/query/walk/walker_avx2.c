/* SPDX-License-Identifier: MIT */
/* Walks by AVX2. Every operation is that of the plain version, never fused, so the bits are the same. */
#include "query/walk/walker.h"

#if PIR_HAVE_X86_WALK

#include "query/frame/fours_avx2.h"

PIR_AVX2 static inline double steepest_at(const pir_body *body, uint32_t vertex, pir_vec3 n) {
    return pir_ring_most(body->around, vertex, pir_four_of(n));
}

/* The sides are across the facet's own normal, which is n. */
PIR_AVX2 static inline double within_facet(const pir_body *body, uint32_t facet, pir_vec3 n, pir_vec3 at) {
    (void)n;
    return pir_sides_least(body->around, facet, pir_four_of(at));
}

/* Of all halfedges from the origin of one, but that itself. */
PIR_AVX2 static inline double steepest_beside(const pir_body *body, uint32_t half, pir_vec3 n) {
    const pir_polytope *p = body->polytope;
    return pir_ring_most_but(body->around, p->origin[half], half - p->ring_start[p->origin[half]], pir_four_of(n));
}

/* The first of four that is the least of them, and below another number; that number where none is. */
struct first {
    uint32_t place;
    double least;
};

PIR_AVX2 static inline struct first take(struct first first, __m256d four, uint32_t from) {
    const double least = pir_four_least(four);
    const uint32_t at = (uint32_t)_mm256_movemask_pd(_mm256_cmp_pd(four, _mm256_set1_pd(least), _CMP_EQ_OQ));
    return least < first.least ? (struct first){from + (uint32_t)__builtin_ctz(at | 16), least} : first;
}

PIR_AVX2 static inline uint32_t leave_cell(const pir_body *body, uint32_t vertex, pir_vec3 n, pir_vec3 m) {
    const uint32_t blocks = body->around->ring_blocks, start = body->polytope->ring_start[vertex];
    const pir_fours *ring = &body->around->rings[vertex * blocks];
    const pir_four of_n = pir_four_of(n), of_m = pir_four_of(m);
    const __m256d none = _mm256_set1_pd(HUGE_VAL);
    struct first first = {UINT32_MAX, HUGE_VAL};
    for (uint32_t k = 0; k < blocks; k++) {
        const pir_four d = pir_four_at(&ring[k]);
        const __m256d from = pir_four_dot(d, of_n), to = pir_four_dot(d, of_m);
        const __m256d part = _mm256_div_pd(from, _mm256_sub_pd(from, to));
        const __m256d leaves = _mm256_cmp_pd(to, _mm256_setzero_pd(), _CMP_GT_OQ);
        first = take(first, _mm256_blendv_pd(none, part, leaves), start + 4 * k);
    }
    return first.place;
}

PIR_AVX2 static inline uint32_t farthest_beyond(const pir_body *body, uint32_t facet, pir_vec3 at) {
    const uint32_t blocks = body->around->side_blocks, start = body->polytope->loop_start[facet];
    const pir_sides *sides = &body->around->sides[facet * blocks];
    const pir_four of_at = pir_four_of(at);
    const __m256d none = _mm256_set1_pd(HUGE_VAL);
    struct first first = {start, HUGE_VAL};
    for (uint32_t k = 0; k < blocks; k++) {
        __m256d within = pir_four_dot(pir_four_at(&sides[k].in), pir_four_sub(of_at, pir_four_at(&sides[k].from)));
        // what is no number is taken for the second operand
        first = take(first, _mm256_min_pd(within, none), start + 4 * k);
    }
    return first.place;
}

/* Most climbs end where they begin. */
PIR_AVX2 static inline uint32_t climb(const pir_body *body, pir_vec3 n, uint32_t from) {
    bool is_top = body->around && !(pir_ring_most(body->around, from, pir_four_of(n)) > PIR_LEAST_SLOPE);
    return is_top ? from : pir_climb(body->polytope, n, from);
}

#define WALK_TARGET     PIR_AVX2
#define WALK_CAN(frame) ((frame)->p.around && (frame)->q.around)
#define WALK_ELSE       pir_walker_version(0)
#define WALK_NAME       pir_walker_avx2
#include "query/walk/walker_body.h"

#else
typedef int pir_no_avx2_walk; // a file holds at least a declaration
#endif
