/* SPDX-License-Identifier: MIT */
/* Facets by doubles alone: see same_facet.h. */
#include "query/last/same_facet_versions.h"

/* --- proofs --- */

static inline double steepest_at(const pir_body *body, uint32_t vertex, pir_vec3 n) {
    const pir_polytope *p = body->polytope;
    double most = -HUGE_VAL;
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1]; h++) {
        double slope = pir_vec_dot(n, p->direction[h]);
        most = slope > most ? slope : most;
    }
    return most;
}

/* How far `at` is from the nearest side of a body's facet with normal n; negative outside. */
static double within_facet(const pir_body *body, uint32_t facet, pir_vec3 n, pir_vec3 at) {
    const pir_polytope *p = body->polytope;
    double least = HUGE_VAL;
    for (uint32_t i = p->loop_start[facet]; i < p->loop_start[facet + 1]; i++) {
        uint32_t half = p->loop[i];
        pir_vec3 in = pir_vec_cross(n, p->direction[half]);
        double s = pir_vec_dot(in, pir_vec_sub(at, body->vertex[p->origin[half]]));
        least = s < least ? s : least;
    }
    return least;
}

#define SAME_TARGET
#include "query/last/same_facet_body.h"

/* What the touch of a facet depends on besides: its corner of P, turned, and the direction of an edge of P, turned. */
struct of_p {
    pir_vec3 corner, along;
};

/*
 * The point of Q where y is attained by two edges that cross. The edge of Q is taken from its vertex of lower number,
 * whichever way its halfedge leads.
 */
static inline pir_vec3 crossing(const pir_frame *frame, const pir_facet *facet, pir_vec3 y, const struct of_p *p) {
    const pir_polytope *q = frame->q.polytope;
    uint32_t half = q->edge_half[facet->faces.q.index];
    pir_vec3 from = frame->q.vertex[q->origin[half]], d = pir_vec_sub(frame->q.vertex[q->target[half]], from);
    double part = pir_touch_part(pir_vec_sub(y, pir_vec_add(p->corner, from)), d, pir_vec_cross(p->along, facet->n));
    return pir_touch_along(from, d, part);
}

/* The foot of x on a plane with normal n. */
static inline pir_vec3 foot(const pir_placement *placement, pir_vec3 n, double slack) {
    return pir_vec_add(placement->x, pir_vec_scale(n, slack));
}

/*
 * The steepest of the halfedges from the origin of one, but that itself. They are taken from the one after it, all
 * around: two loops over what lies before and behind it would end at different lengths from frame to frame.
 */
static inline double steepest_beside(const pir_polytope *p, uint32_t half, pir_vec3 n) {
    const uint32_t *ring = &p->ring_start[p->origin[half]], start = ring[0], end = ring[1];
    double most = -HUGE_VAL;
    for (uint32_t h = half, left = end - start - 1; left > 0; left--) {
        h = h + 1 < end ? h + 1 : start;
        double slope = pir_vec_dot(n, p->direction[h]);
        most = slope > most ? slope : most;
    }
    return most;
}

static pir_same prove_ee(const pir_frame *frame, const pir_placement *placement, pir_same_facet *same) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t edge = same->facet.piece.first, half = p->edge_half[edge], other = same->facet.piece.second;
    pir_vec3 d = q->direction[other], e = pir_mat_apply(&frame->r, p->direction[half]), n = pir_vec_cross(d, e);
    double square = pir_vec_dot(n, n), err = 1 / sqrt(square);
    if (square < 4 * PIR_SIN_REFINED * PIR_SIN_REFINED)
        return PIR_SAME_IN_DOUBT;
    uint32_t a = p->origin[half], b = q->origin[other];
    pir_same exposed = all_fall(steepest_beside(q, other, n));
    if (exposed == PIR_SAME_PROVEN)
        exposed = all_fall(steepest_beside(p, half, pir_mat_apply_transposed(&frame->r, n)));
    if (exposed != PIR_SAME_PROVEN)
        return exposed;
    n = pir_vec_scale(n, err);
    const struct of_p of_p = {pir_mat_apply(&frame->r, frame->p.vertex[a]), e};
    pir_vec3 corner = pir_vec_add(of_p.corner, frame->q.vertex[b]);
    // how far the foot is from the sides along d, at either end of P's edge, and from those along e
    pir_vec3 by_d = pir_vec_cross(n, d), by_e = pir_vec_cross(e, n), w = pir_vec_sub(placement->x, corner);
    pir_vec3 along_p = pir_mat_apply(&frame->r, pir_vec_sub(frame->p.vertex[p->target[half]], frame->p.vertex[a]));
    pir_vec3 along_q = pir_vec_sub(frame->q.vertex[q->target[other]], frame->q.vertex[b]);
    double in_p = pir_vec_dot(by_d, w), in_q = pir_vec_dot(by_e, w);
    double left_p = pir_vec_dot(by_d, along_p) - in_p, left_q = pir_vec_dot(by_e, along_q) - in_q;
    const double h = pir_vec_dot(n, corner);
    const bool end_p = left_p < in_p, end_q = left_q < in_q;
    in_p = end_p ? left_p : in_p;
    in_q = end_q ? left_q : in_q;
    same->side = in_q < in_p ? 2 + (uint32_t)end_q : (uint32_t)end_p;
    set_facet(same, (pir_witness){{PIR_FEATURE_EDGE, edge}, {PIR_FEATURE_EDGE, q->edge[other]}}, a, b,
              (struct unit_plane){n, err, h});
    pir_same is = measure(placement, in_p < in_q ? in_p : in_q, h - pir_vec_dot(n, placement->x), same);
    if (is == PIR_SAME_PROVEN)
        same->touch.point_q = crossing(frame, &same->facet, foot(placement, n, same->slack), &of_p);
    return is;
}

pir_same pir_same_facet_prove(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                              pir_same_facet *ret_same) {
    if (frame->p.polytope->artificial || frame->q.polytope->artificial)
        return PIR_SAME_IN_DOUBT;
    return prove(frame, placement, piece, ret_same);
}

pir_same_prover *pir_same_facet_version(unsigned index) {
    if (index == 0)
        return pir_same_facet_prove;
#if PIR_HAVE_X86_SAME
    if (index == 1 && __builtin_cpu_supports("avx2"))
        return pir_same_facet_prove_avx2;
#endif
    return NULL;
}

pir_same_prover *pir_same_facet_best(void) {
    unsigned index = 0;
    while (pir_same_facet_version(index + 1))
        index++;
    return pir_same_facet_version(index);
}

/* --- what touches --- */

void pir_same_facet_set_slack(const pir_frame *frame, const pir_placement *placement, double slack,
                              pir_same_facet *same) {
    const pir_facet *facet = &same->facet;
    const pir_polytope *p = frame->p.polytope;
    const pir_vec3 y = foot(placement, facet->n, slack);
    same->slack = slack;
    if (facet->piece.kind == PIR_FACET_FV) {
        same->touch.point_q = frame->q.vertex[facet->b];
        return;
    }
    struct of_p of_p = {pir_mat_apply(&frame->r, frame->p.vertex[facet->a]), {0, 0, 0}};
    if (facet->piece.kind == PIR_FACET_VF) {
        same->touch.point_q = pir_vec_sub(y, of_p.corner);
        return;
    }
    of_p.along = pir_mat_apply(&frame->r, p->direction[p->edge_half[facet->piece.first]]);
    same->touch.point_q = crossing(frame, facet, y, &of_p);
}
