/* SPDX-License-Identifier: MIT */
/* Proofs of a facet by AVX2. Every operation is that of the plain version, never fused, so the bits are the same. */
#include "query/last/same_facet_versions.h"

#if PIR_HAVE_X86_SAME

#include "query/frame/fours_avx2.h"

PIR_AVX2 static inline double steepest_at(const pir_body *body, uint32_t vertex, pir_vec3 n) {
    return pir_ring_most(body->around, vertex, pir_four_of(n));
}

/* The sides are across the facet's own normal, which is n. */
PIR_AVX2 static inline double within_facet(const pir_body *body, uint32_t facet, pir_vec3 n, pir_vec3 at) {
    (void)n;
    return pir_sides_least(body->around, facet, pir_four_of(at));
}

#define SAME_TARGET PIR_AVX2
#include "query/last/same_facet_body.h"

/* An edge of P and a halfedge of Q, and where they begin. */
struct two_edges {
    uint32_t edge, half, other, a, b;
};

/* Whether all edges beside both fall along n, the cross product of the two. */
PIR_AVX2 static inline pir_same all_beside_fall(const pir_frame *frame, const struct two_edges *of, __m256d n) {
    uint32_t place_p = of->half - frame->p.polytope->ring_start[of->a];
    uint32_t place_q = of->other - frame->q.polytope->ring_start[of->b];
    double most_q = pir_ring_most_but(frame->q.around, of->b, place_q, pir_three_spread(n));
    pir_same fall = all_fall(most_q);
    if (fall != PIR_SAME_PROVEN)
        return fall;
    pir_vec3 along;
    pir_three_put(&along, n);
    const pir_four back = pir_four_of(pir_mat_apply_transposed(&frame->r, along));
    return all_fall(pir_ring_most_but(frame->p.around, of->a, place_p, back));
}

/* Where y is attained by two edges that cross, as `crossing`; `across` is e × n, and `corner` that of P. */
PIR_AVX2 static inline __m256d crossing_at(const pir_body *q, uint32_t edge, __m256d y, __m256d corner,
                                           __m256d across) {
    const pir_polytope *of_q = q->polytope;
    const uint32_t half = of_q->edge_half[edge];
    const __m256d from = pir_three_at(&q->vertex[of_q->origin[half]]);
    const __m256d d = _mm256_sub_pd(pir_three_at(&q->vertex[of_q->target[half]]), from);
    const __m256d to = _mm256_sub_pd(y, _mm256_add_pd(corner, from));
    const __m128d parts = pir_three_two_sums(_mm256_mul_pd(to, across), _mm256_mul_pd(d, across));
    const __m128d part = _mm_div_sd(parts, _mm_unpackhi_pd(parts, parts));
    const __m128d held = _mm_min_sd(_mm_max_sd(part, _mm_setzero_pd()), _mm_set_sd(1));
    return _mm256_add_pd(from, _mm256_mul_pd(d, _mm256_broadcastsd_pd(held)));
}

PIR_AVX2 static pir_same prove_ee(const pir_frame *frame, const pir_placement *placement, pir_same_facet *same) {
    const pir_body *body_p = &frame->p, *body_q = &frame->q;
    const pir_polytope *p = body_p->polytope, *q = body_q->polytope;
    pir_facet *facet = &same->facet;
    struct two_edges of = {.edge = facet->piece.first, .other = facet->piece.second};
    of.half = p->edge_half[of.edge];
    of.a = p->origin[of.half];
    of.b = q->origin[of.other];
    const pir_four r = pir_three_columns(&frame->r);
    const __m256d d = pir_three_at(&q->direction[of.other]), d_turned = pir_three_turned(d);
    const __m256d e = pir_three_apply(r, pir_four_of(p->direction[of.half])), e_turned = pir_three_turned(e);
    const __m256d across = pir_three_cross(d, d_turned, e, e_turned);
    const __m256d squares = _mm256_mul_pd(across, across);
    const double square = _mm_cvtsd_f64(pir_three_two_sums(squares, squares)), err = 1 / sqrt(square);
    if (square < 4 * PIR_SIN_REFINED * PIR_SIN_REFINED)
        return PIR_SAME_IN_DOUBT;
    pir_same exposed = all_beside_fall(frame, &of, across);
    if (exposed != PIR_SAME_PROVEN)
        return exposed;
    const __m256d n = _mm256_mul_pd(across, _mm256_set1_pd(err)), n_turned = pir_three_turned(n);
    const __m256d corner_p = pir_three_apply(r, pir_four_of(body_p->vertex[of.a]));
    const __m256d from_q = pir_three_at(&body_q->vertex[of.b]), corner = _mm256_add_pd(corner_p, from_q);
    const __m256d x = pir_three_at(&placement->x), w = _mm256_sub_pd(x, corner);
    // how far the foot is from the sides along d, at either end of P's edge, and from those along e
    const __m256d by_d = pir_three_cross(n, n_turned, d, d_turned), by_e = pir_three_cross(e, e_turned, n, n_turned);
    const pir_vec3 edge_p = pir_vec_sub(body_p->vertex[p->target[of.half]], body_p->vertex[of.a]);
    const __m256d along_p = pir_three_apply(r, pir_four_of(edge_p));
    const __m256d along_q = _mm256_sub_pd(pir_three_at(&body_q->vertex[q->target[of.other]]), from_q);
    const __m256d in = pir_three_sums(_mm256_mul_pd(by_d, w), _mm256_mul_pd(by_e, w), _mm256_mul_pd(by_d, along_p),
                                      _mm256_mul_pd(by_e, along_q));
    const __m128d first = _mm256_castpd256_pd128(in), left = _mm_sub_pd(_mm256_extractf128_pd(in, 1), first);
    const __m128d inner = _mm_min_pd(first, left),
                  heights = pir_three_two_sums(_mm256_mul_pd(n, corner), _mm256_mul_pd(n, x));
    const double within = _mm_cvtsd_f64(_mm_min_sd(inner, _mm_unpackhi_pd(inner, inner)));
    const uint32_t ends = (uint32_t)_mm_movemask_pd(_mm_cmplt_pd(left, first));
    const bool by_e_least = _mm_comilt_sd(_mm_unpackhi_pd(inner, inner), inner);
    same->side = by_e_least ? 2 + (ends >> 1) : (ends & 1);
    pir_vec3 normal;
    pir_three_put(&normal, n);
    set_facet(same, (pir_witness){{PIR_FEATURE_EDGE, of.edge}, {PIR_FEATURE_EDGE, q->edge[of.other]}}, of.a, of.b,
              (struct unit_plane){normal, err, _mm_cvtsd_f64(heights)});
    const double slack = _mm_cvtsd_f64(_mm_sub_sd(heights, _mm_unpackhi_pd(heights, heights)));
    pir_same is = measure(placement, within, slack, same);
    if (is == PIR_SAME_PROVEN) {
        const __m256d y = _mm256_add_pd(x, _mm256_mul_pd(n, _mm256_set1_pd(slack)));
        pir_three_put(&same->touch.point_q, crossing_at(body_q, q->edge[of.other], y, corner_p, by_e));
    }
    return is;
}

PIR_AVX2 pir_same pir_same_facet_prove_avx2(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                                            pir_same_facet *ret_same) {
    if (!frame->p.around || !frame->q.around)
        return pir_same_facet_prove(frame, placement, piece, ret_same);
    return prove(frame, placement, piece, ret_same);
}

#else
typedef int pir_no_avx2_same; // a file holds at least a declaration
#endif
