/* SPDX-License-Identifier: MIT */
/* Facets by doubles alone: see same_facet.h. */
#include "query/last/same_facet.h"

/*
 * The foot's distance from a side is known to PIR_SIDE_ERRORS of the errors that it is compared with in touch.c. This
 * many hold as well that a side's unit vector is off.
 */
#define MARGIN_ERRORS 16

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

/*
 * Whether all edges from the origin of a halfedge, but its own, certainly fall along n, and how steeply at least. n and
 * PIR_SLOPE_BOUND are those of a unit normal, both times one factor: the sine of two edges' angle.
 */
static inline pir_same all_fall(const pir_polytope *p, uint32_t half, pir_vec3 n, double *ret_falls) {
    double most = steepest_beside(p, half, n);
    *ret_falls = -PIR_SLOPE_BOUND - most;
    return most < -PIR_SLOPE_BOUND ? PIR_SAME_PROVEN : most > PIR_SLOPE_BOUND ? PIR_SAME_NOT : PIR_SAME_IN_DOUBT;
}

/* The vertex uphill from *vertex of which that holds. */
static inline pir_same find_top(const pir_polytope *p, pir_vec3 n, uint32_t *vertex, double *ret_falls) {
    for (uint32_t left = p->vertex_count; left > 0; left--) {
        double most = -HUGE_VAL;
        uint32_t best = 0;
        for (uint32_t h = p->ring_start[*vertex]; h < p->ring_start[*vertex + 1]; h++) {
            double slope = pir_vec_dot(n, p->direction[h]);
            best = slope > most ? h : best;
            most = slope > most ? slope : most;
        }
        *ret_falls = -PIR_SLOPE_BOUND - most;
        if (most < -PIR_SLOPE_BOUND)
            return PIR_SAME_PROVEN;
        if (!(most > PIR_SLOPE_BOUND))
            return PIR_SAME_IN_DOUBT;
        *vertex = p->target[best];
    }
    return PIR_SAME_IN_DOUBT;
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

static inline void set_touch(const pir_frame *frame, const pir_placement *placement, int kind, const struct of_p *p,
                             pir_same_facet *same) {
    const pir_facet *facet = &same->facet;
    pir_vec3 y = pir_vec_add(placement->x, pir_vec_scale(facet->n, same->slack));
    if (kind == PIR_FACET_FV)
        same->touch.point_q = frame->q.vertex[facet->b];
    else if (kind == PIR_FACET_VF)
        same->touch.point_q = pir_vec_sub(y, p->corner);
    else
        same->touch.point_q = crossing(frame, facet, y, p);
}

void pir_same_facet_set_slack(const pir_frame *frame, const pir_placement *placement, double slack,
                              pir_same_facet *same) {
    const pir_facet *facet = &same->facet;
    const pir_polytope *p = frame->p.polytope;
    struct of_p of_p = {{0, 0, 0}, {0, 0, 0}};
    same->slack = slack;
    if (facet->piece.kind != PIR_FACET_FV)
        of_p.corner = pir_mat_apply(&frame->r, frame->p.vertex[facet->a]);
    if (facet->piece.kind == PIR_FACET_EE)
        of_p.along = pir_mat_apply(&frame->r, p->direction[p->edge_half[facet->piece.first]]);
    set_touch(frame, placement, facet->piece.kind, &of_p, same);
}

/*
 * Sets slack and margin, and tells whether the foot is inside of the rim and x clearly on a side: then the touch is set
 * too.
 */
static inline pir_same measure(const pir_frame *frame, const pir_placement *placement, double within, int kind,
                               const struct of_p *p, pir_same_facet *same) {
    const pir_facet *facet = &same->facet;
    double error = placement->error * facet->err, off = MARGIN_ERRORS * error;
    same->slack = facet->h - pir_vec_dot(facet->n, placement->x);
    same->margin = within - off;
    if (within < -off)
        return PIR_SAME_NOT;
    bool clear = fabs(same->slack) > PIR_NEXT_TO_NOTHING * placement->reach && fabs(same->slack) > 2 * error;
    if (!(within > off) || !clear)
        return within > off ? PIR_SAME_NEAR : PIR_SAME_IN_DOUBT;
    set_touch(frame, placement, kind, p, same);
    return PIR_SAME_PROVEN;
}

/*
 * How far R may turn while edges that fall by `falls` along a unit normal do: of a facet that moves by the angle
 * itself. The normal of two edges that cross at a sine moves by 2 / sine times that at most, and P's edges by it as
 * well; there `falls` is that times the sine.
 */
static double turn_of_facet(double falls) {
    return falls * (1 - 0x1p-20) - 0x1p-40;
}

static double turn_of_edges(double falls, double sine) {
    return turn_of_facet(falls / (2 + sine));
}

/* A plane of D: its normal, how wrong that is, and its height, as in pir_facet. */
struct unit_plane {
    pir_vec3 n;
    double err, h;
};

/* Sets the facet, and what would touch there: loading the faces anew would wait for their parts to be stored. */
static inline void set_facet(pir_same_facet *same, pir_witness faces, uint32_t a, uint32_t b, struct unit_plane plane) {
    pir_facet *facet = &same->facet;
    facet->faces = faces;
    same->touch.witness = faces;
    facet->a = a;
    facet->b = b;
    facet->n = plane.n;
    facet->err = plane.err;
    facet->h = plane.h;
}

static pir_same prove_fv(const pir_frame *frame, const pir_placement *placement, const pir_same_known *known,
                         pir_same_facet *same) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t f = same->facet.piece.first, b = same->facet.piece.second, corner;
    pir_vec3 n = pir_mat_apply(&frame->r, p->normal[f]);
    double within;
    if (known) {
        within = known->margin;
        corner = known->corner;
    } else {
        double falls;
        pir_same exposed = find_top(q, n, &b, &falls);
        if (exposed != PIR_SAME_PROVEN)
            return exposed;
        pir_vec3 at = pir_mat_apply_transposed(&frame->r, pir_vec_sub(placement->x, frame->q.vertex[b]));
        within = within_facet(&frame->p, f, p->normal[f], at);
        corner = p->origin[p->loop[p->loop_start[f]]];
        same->falls = turn_of_facet(falls);
    }
    same->facet.piece.second = b;
    set_facet(same, (pir_witness){{PIR_FEATURE_FACET, f}, {PIR_FEATURE_VERTEX, b}}, corner, b,
              (struct unit_plane){n, 1, frame->p.offset[f] + pir_vec_dot(n, frame->q.vertex[b])});
    return measure(frame, placement, within, PIR_FACET_FV, NULL, same);
}

static pir_same prove_vf(const pir_frame *frame, const pir_placement *placement, const pir_same_known *known,
                         pir_same_facet *same) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t a = same->facet.piece.first, g = same->facet.piece.second, corner;
    pir_vec3 n = q->normal[g];
    struct of_p of_p;
    double within;
    if (known) {
        of_p.corner = pir_mat_apply(&frame->r, frame->p.vertex[a]);
        within = known->margin;
        corner = known->corner;
    } else {
        double falls;
        pir_same exposed = find_top(p, pir_mat_apply_transposed(&frame->r, n), &a, &falls);
        if (exposed != PIR_SAME_PROVEN)
            return exposed;
        of_p.corner = pir_mat_apply(&frame->r, frame->p.vertex[a]);
        within = within_facet(&frame->q, g, n, pir_vec_sub(placement->x, of_p.corner));
        corner = q->origin[q->loop[q->loop_start[g]]];
        same->falls = turn_of_facet(falls);
    }
    same->facet.piece.first = a;
    set_facet(same, (pir_witness){{PIR_FEATURE_VERTEX, a}, {PIR_FEATURE_FACET, g}}, a, corner,
              (struct unit_plane){n, 1, frame->q.offset[g] + pir_vec_dot(n, of_p.corner)});
    return measure(frame, placement, within, PIR_FACET_VF, &of_p, same);
}

static pir_same prove_ee(const pir_frame *frame, const pir_placement *placement, const pir_same_known *known,
                         pir_same_facet *same) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t edge = same->facet.piece.first, half = p->edge_half[edge], other = same->facet.piece.second;
    pir_vec3 d = q->direction[other], e = pir_mat_apply(&frame->r, p->direction[half]), n = pir_vec_cross(d, e);
    double square = pir_vec_dot(n, n), sine = sqrt(square), err = 1 / sine;
    if (square < 4 * PIR_SIN_REFINED * PIR_SIN_REFINED)
        return PIR_SAME_IN_DOUBT;
    uint32_t a = p->origin[half], b = q->origin[other];
    if (!known) {
        double falls_q, falls_p = 0;
        pir_same exposed = all_fall(q, other, n, &falls_q);
        if (exposed == PIR_SAME_PROVEN)
            exposed = all_fall(p, half, pir_mat_apply_transposed(&frame->r, n), &falls_p);
        if (exposed != PIR_SAME_PROVEN)
            return exposed;
        same->falls = turn_of_edges(falls_p < falls_q ? falls_p : falls_q, sine);
    }
    n = pir_vec_scale(n, err);
    const struct of_p of_p = {pir_mat_apply(&frame->r, frame->p.vertex[a]), e};
    pir_vec3 corner = pir_vec_add(of_p.corner, frame->q.vertex[b]);
    // how far the foot is from the sides along d, at either end of P's edge, and from those along e
    pir_vec3 by_d = pir_vec_cross(n, d), by_e = pir_vec_cross(e, n), w = pir_vec_sub(placement->x, corner);
    pir_vec3 along_p = pir_mat_apply(&frame->r, pir_vec_sub(frame->p.vertex[p->target[half]], frame->p.vertex[a]));
    pir_vec3 along_q = pir_vec_sub(frame->q.vertex[q->target[other]], frame->q.vertex[b]);
    double in_p = pir_vec_dot(by_d, w), in_q = pir_vec_dot(by_e, w);
    double left_p = pir_vec_dot(by_d, along_p) - in_p, left_q = pir_vec_dot(by_e, along_q) - in_q;
    in_p = in_p < left_p ? in_p : left_p;
    in_q = in_q < left_q ? in_q : left_q;
    set_facet(same, (pir_witness){{PIR_FEATURE_EDGE, edge}, {PIR_FEATURE_EDGE, q->edge[other]}}, a, b,
              (struct unit_plane){n, err, pir_vec_dot(n, corner)});
    return measure(frame, placement, in_p < in_q ? in_p : in_q, PIR_FACET_EE, &of_p, same);
}

pir_same pir_same_facet_prove(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                              const pir_same_known *known, pir_same_facet *ret_same) {
    if (frame->p.polytope->artificial || frame->q.polytope->artificial)
        return PIR_SAME_IN_DOUBT;
    ret_same->facet.piece = piece;
    ret_same->falls = 0;
    return piece.kind == PIR_FACET_FV   ? prove_fv(frame, placement, known, ret_same)
           : piece.kind == PIR_FACET_VF ? prove_vf(frame, placement, known, ret_same)
                                        : prove_ee(frame, placement, known, ret_same);
}
