/* SPDX-License-Identifier: MIT */
/* From facet to facet by AVX2. Every operation is that of the plain version, never fused, so the bits are the same. */
#include "query/last/same_facet_versions.h"

#if PIR_HAVE_X86_SAME

#include "query/frame/fours_avx2.h"

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

#define FOOT_TARGET PIR_AVX2
#define FOOT_PROVE  pir_same_facet_prove_avx2
#include "query/last/follow_foot_body.h"

PIR_AVX2 pir_same pir_follow_foot_avx2(const pir_frame *frame, const pir_placement *placement, pir_same is,
                                       pir_same_facet *same) {
    if (!frame->p.around || !frame->q.around)
        return pir_follow_foot(frame, placement, is, same);
    return follow(frame, placement, is, same);
}

#else
typedef int pir_no_avx2_foot; // a file holds at least a declaration
#endif
