/* SPDX-License-Identifier: MIT */
/*
 * The text of a walker. WALK_TARGET names the processor, WALK_NAME the walker, and WALK_CAN(frame) tells whether it can
 * walk on two bodies; those on which it cannot are left to WALK_ELSE. Before it stands what the processor has for
 *
 *   - steepest_at, the steepest of the edges of a vertex along n;
 *   - steepest_beside, the steepest of the edges beside a halfedge at its origin;
 *   - within_facet, how far a point is from the nearest side of a body's facet, negative outside;
 *   - leave_cell, the edge of a vertex through which a way leaves its cell;
 *   - farthest_beyond, the side of a facet that a point is farthest beyond;
 *   - climb, the vertex that a climb from another ends at.
 *
 * Operations are taken in one order and never fused, so all versions have the same bits.
 */

/* --- proofs --- */

/*
 * The foot's distance from a side is known to PIR_SIDE_ERRORS of the errors that it is compared with in touch.c. This
 * many hold as well that a side's unit vector is off.
 */
#define MARGIN_ERRORS 16

/*
 * Whether edges of which the steepest rises by `most` certainly fall along n. n and PIR_SLOPE_BOUND are those of a unit
 * normal, or both times one factor: the sine of two edges' angle.
 */
WALK_TARGET static inline pir_same all_fall(double most) {
    return most < -PIR_SLOPE_BOUND ? PIR_SAME_PROVEN : most > PIR_SLOPE_BOUND ? PIR_SAME_NOT : PIR_SAME_IN_DOUBT;
}

/* The halfedge from a vertex that is the steepest along n: the first of its kind. */
static uint32_t steepest_half(const pir_polytope *p, uint32_t vertex, pir_vec3 n) {
    uint32_t best = p->ring_start[vertex];
    double most = -HUGE_VAL;
    for (uint32_t h = best; h < p->ring_start[vertex + 1]; h++) {
        double slope = pir_vec_dot(n, p->direction[h]);
        best = slope > most ? h : best;
        most = slope > most ? slope : most;
    }
    return best;
}

/* The vertex uphill from *vertex of which all edges fall. */
WALK_TARGET static inline pir_same find_top(const pir_body *body, pir_vec3 n, uint32_t *vertex) {
    const pir_polytope *p = body->polytope;
    for (uint32_t steps = p->vertex_count; steps > 0; steps--) {
        pir_same fall = all_fall(steepest_at(body, *vertex, n));
        if (fall != PIR_SAME_NOT)
            return fall;
        *vertex = p->target[steepest_half(p, *vertex, n)];
    }
    return PIR_SAME_IN_DOUBT;
}

/* Sets slack and margin, and tells whether the foot is inside of the rim and x clearly on a side. */
WALK_TARGET static inline pir_same measure(const pir_placement *placement, double within, double slack,
                                           pir_same_facet *same) {
    const double error = placement->error * same->facet.err, off = MARGIN_ERRORS * error, size = fabs(slack);
    const double nothing = PIR_NEXT_TO_NOTHING * placement->reach, least = nothing > 2 * error ? nothing : 2 * error;
    same->slack = slack;
    same->margin = within - off;
    // most often both hold
    if ((within > off) & (size > least))
        return PIR_SAME_PROVEN;
    return within > off ? PIR_SAME_NEAR : within < -off ? PIR_SAME_BESIDE : PIR_SAME_IN_DOUBT;
}

/* A plane of D: its normal, how wrong that is, and its height, as in pir_facet. */
struct unit_plane {
    pir_vec3 n;
    double err, h;
};

/* Sets the facet, and what would touch there: loading the faces anew would wait for their parts to be stored. */
WALK_TARGET static inline void set_facet(pir_same_facet *same, pir_witness faces, uint32_t a, uint32_t b,
                                         struct unit_plane plane) {
    pir_facet *facet = &same->facet;
    facet->faces = faces;
    same->touch.witness = faces;
    facet->a = a;
    facet->b = b;
    facet->n = plane.n;
    facet->err = plane.err;
    facet->h = plane.h;
}

WALK_TARGET static inline pir_same prove_fv(const pir_frame *frame, const pir_placement *placement,
                                            pir_same_facet *same) {
    const pir_polytope *p = frame->p.polytope;
    uint32_t f = same->facet.piece.first, b = same->facet.piece.second;
    pir_vec3 n = pir_mat_apply(&frame->r, p->normal[f]);
    pir_same exposed = find_top(&frame->q, n, &b);
    if (exposed != PIR_SAME_PROVEN)
        return exposed;
    pir_vec3 at = pir_mat_apply_transposed(&frame->r, pir_vec_sub(placement->x, frame->q.vertex[b]));
    double within = within_facet(&frame->p, f, p->normal[f], at);
    const double h = frame->p.offset[f] + pir_vec_dot(n, frame->q.vertex[b]);
    same->facet.piece.second = b;
    same->touch.point_q = frame->q.vertex[b];
    set_facet(same, (pir_witness){{PIR_FEATURE_FACET, f}, {PIR_FEATURE_VERTEX, b}},
              p->origin[p->loop[p->loop_start[f]]], b, (struct unit_plane){n, 1, h});
    return measure(placement, within, h - pir_vec_dot(n, placement->x), same);
}

WALK_TARGET static inline pir_same prove_vf(const pir_frame *frame, const pir_placement *placement,
                                            pir_same_facet *same) {
    const pir_polytope *q = frame->q.polytope;
    uint32_t a = same->facet.piece.first, g = same->facet.piece.second;
    pir_vec3 n = q->normal[g];
    pir_same exposed = find_top(&frame->p, pir_mat_apply_transposed(&frame->r, n), &a);
    if (exposed != PIR_SAME_PROVEN)
        return exposed;
    pir_vec3 corner_p = pir_mat_apply(&frame->r, frame->p.vertex[a]);
    double within = within_facet(&frame->q, g, n, pir_vec_sub(placement->x, corner_p));
    const double h = frame->q.offset[g] + pir_vec_dot(n, corner_p), slack = h - pir_vec_dot(n, placement->x);
    same->facet.piece.first = a;
    same->touch.point_q = pir_vec_sub(pir_vec_add(placement->x, pir_vec_scale(n, slack)), corner_p);
    set_facet(same, (pir_witness){{PIR_FEATURE_VERTEX, a}, {PIR_FEATURE_FACET, g}}, a,
              q->origin[q->loop[q->loop_start[g]]], (struct unit_plane){n, 1, h});
    return measure(placement, within, slack, same);
}

/* The part of P in the touch of a facet: its corner there, and the direction of an edge there, both turned. */
struct of_p {
    pir_vec3 corner, along;
};

/*
 * The point of Q where y is attained by two edges that cross. The edge of Q is taken from its vertex of lower number,
 * whichever way its halfedge leads.
 */
WALK_TARGET static inline pir_vec3 crossing(const pir_frame *frame, const pir_facet *facet, pir_vec3 y,
                                            const struct of_p *p) {
    const pir_polytope *q = frame->q.polytope;
    uint32_t half = q->edge_half[facet->faces.q.index];
    pir_vec3 from = frame->q.vertex[q->origin[half]], d = pir_vec_sub(frame->q.vertex[q->target[half]], from);
    double part = pir_touch_part(pir_vec_sub(y, pir_vec_add(p->corner, from)), d, pir_vec_cross(p->along, facet->n));
    return pir_touch_along(from, d, part);
}

/* The foot of x on a plane with normal n. */
WALK_TARGET static inline pir_vec3 foot(const pir_placement *placement, pir_vec3 n, double slack) {
    return pir_vec_add(placement->x, pir_vec_scale(n, slack));
}

// out of line: inlined it slows the other two
WALK_TARGET __attribute__((noinline)) static pir_same prove_ee(const pir_frame *frame, const pir_placement *placement,
                                                               pir_same_facet *same) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t edge = same->facet.piece.first, half = p->edge_half[edge], other = same->facet.piece.second;
    pir_vec3 d = q->direction[other], e = pir_mat_apply(&frame->r, p->direction[half]), n = pir_vec_cross(d, e);
    double square = pir_vec_dot(n, n), err = 1 / sqrt(square);
    if (square < 4 * PIR_SIN_REFINED * PIR_SIN_REFINED)
        return PIR_SAME_IN_DOUBT;
    uint32_t a = p->origin[half], b = q->origin[other];
    pir_same exposed = all_fall(steepest_beside(&frame->q, other, n));
    if (exposed == PIR_SAME_PROVEN)
        exposed = all_fall(steepest_beside(&frame->p, half, pir_mat_apply_transposed(&frame->r, n)));
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

WALK_TARGET static inline pir_same prove(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                                         pir_same_facet *ret_same) {
    ret_same->facet.piece = piece;
    return piece.kind == PIR_FACET_FV   ? prove_fv(frame, placement, ret_same)
           : piece.kind == PIR_FACET_VF ? prove_vf(frame, placement, ret_same)
                                        : prove_ee(frame, placement, ret_same);
}

/* --- from facet to facet --- */

/* A way over more facets than this takes longer than a search; from step to step there are few, after a jump more. */
#define MOST_FACETS 16

/* The foot is far from a facet when it is this far beyond its rim, relative to the reach. */
#define FAR_AWAY 0x1p-3

/* The arc of an edge towards its end at a facet: from that on its left to that on its right, or back. */
struct arc {
    uint32_t edge, facet;
    bool forward;
};

/* The facet at the end of an arc of P, or at the first edge across it, from n on in the cell of vertex b. */
WALK_TARGET static pir_piece along_p(const pir_frame *frame, struct arc arc, uint32_t b, pir_vec3 n) {
    const pir_polytope *q = frame->q.polytope;
    pir_vec3 m = pir_mat_apply(&frame->r, frame->p.polytope->normal[arc.facet]);
    uint32_t half = leave_cell(&frame->q, b, n, m);
    if (half == UINT32_MAX)
        return (pir_piece){PIR_FACET_FV, arc.facet, b};
    // the arc rises along the halfedge, and turns counter-clockwise about its own edge
    return (pir_piece){PIR_FACET_EE, arc.edge, arc.forward ? half : q->twin[half]};
}

/* The facet at the end of an arc of Q, or at the first edge across it, from n on, in the cell of vertex a of P. */
WALK_TARGET static pir_piece along_q(const pir_frame *frame, struct arc arc, uint32_t a, pir_vec3 n) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_vec3 m = pir_mat_apply_transposed(&frame->r, q->normal[arc.facet]);
    uint32_t half = leave_cell(&frame->p, a, pir_mat_apply_transposed(&frame->r, n), m);
    if (half == UINT32_MAX)
        return (pir_piece){PIR_FACET_VF, a, arc.facet};
    uint32_t edge = p->edge[half], other = q->edge_half[arc.edge];
    bool is_along = p->edge_half[edge] == half;
    return (pir_piece){PIR_FACET_EE, edge, arc.forward == is_along ? q->twin[other] : other};
}

/* The arc that leads across a side, by its place in the loops. */
static inline struct arc arc_across(const pir_polytope *p, uint32_t side) {
    return (struct arc){p->across[side].edge, p->across[side].facet, p->across[side].leaves};
}

/* The facet across the side of one that the foot is farthest beyond. */
WALK_TARGET static pir_piece across(const pir_frame *frame, const pir_placement *placement,
                                    const pir_same_facet *same) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    pir_piece piece = same->facet.piece;
    if (piece.kind == PIR_FACET_FV) {
        pir_vec3 at = pir_mat_apply_transposed(&frame->r, pir_vec_sub(placement->x, frame->q.vertex[piece.second]));
        struct arc arc = arc_across(p, farthest_beyond(&frame->p, piece.first, at));
        return along_p(frame, arc, piece.second, same->facet.n);
    }
    if (piece.kind == PIR_FACET_VF) {
        pir_vec3 at = pir_vec_sub(placement->x, pir_mat_apply(&frame->r, frame->p.vertex[piece.first]));
        struct arc arc = arc_across(q, farthest_beyond(&frame->q, piece.second, at));
        return along_q(frame, arc, piece.first, same->facet.n);
    }
    // a side along an edge is through an end of the other
    const uint32_t half = p->edge_half[piece.first], other = piece.second;
    const bool is_end = same->side & 1;
    if (same->side < 2) {
        uint32_t edge = q->edge[other], facet = is_end ? q->left[other] : pir_right(q, other);
        struct arc arc = {edge, facet, q->arc_ends[edge].to == facet};
        return along_q(frame, arc, is_end ? p->target[half] : p->origin[half], same->facet.n);
    }
    pir_arc_ends ends = p->arc_ends[piece.first];
    struct arc arc = {piece.first, is_end ? ends.to : ends.from, is_end};
    return along_p(frame, arc, is_end ? q->target[other] : q->origin[other], same->facet.n);
}

/* A facet near two edges whose arcs do not cross: at the end of one that is nearest to the other's plane. */
WALK_TARGET static pir_piece near_edges(const pir_frame *frame, pir_piece piece) {
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    const uint32_t half = p->edge_half[piece.first], other = piece.second;
    const pir_arc_ends of_p = p->arc_ends[piece.first], of_q = q->arc_ends[q->edge[other]];
    pir_vec3 d = pir_mat_apply_transposed(&frame->r, q->direction[other]);
    double from = pir_vec_dot(d, p->normal[of_p.from]), to = pir_vec_dot(d, p->normal[of_p.to]);
    if ((from > 0) == (to > 0)) {
        uint32_t f = fabs(from) < fabs(to) ? of_p.from : of_p.to;
        return (pir_piece){PIR_FACET_FV, f, q->origin[other]};
    }
    pir_vec3 e = pir_mat_apply(&frame->r, p->direction[half]);
    from = pir_vec_dot(e, q->normal[of_q.from]), to = pir_vec_dot(e, q->normal[of_q.to]);
    uint32_t g = fabs(from) < fabs(to) ? of_q.from : of_q.to;
    return (pir_piece){PIR_FACET_VF, p->origin[half], g};
}

/* The steepest along n of a vertex's facets. *ret_most is how steep it is. */
static uint32_t steepest_facet(const pir_polytope *p, uint32_t vertex, pir_vec3 n, double *ret_most) {
    uint32_t best = p->left[p->ring_start[vertex]];
    *ret_most = -HUGE_VAL;
    for (uint32_t h = p->ring_start[vertex]; h < p->ring_start[vertex + 1]; h++) {
        const double along = pir_vec_dot(n, p->normal[p->left[h]]);
        best = along > *ret_most ? p->left[h] : best;
        *ret_most = along > *ret_most ? along : *ret_most;
    }
    return best;
}

/* A facet of either body at the vertex of D that is farthest towards x. */
WALK_TARGET static pir_piece towards(const pir_frame *frame, const pir_placement *placement) {
    const pir_vec3 n = pir_vec_scale(placement->x, 1 / sqrt(pir_vec_dot(placement->x, placement->x)));
    const pir_vec3 back = pir_mat_apply_transposed(&frame->r, n);
    const uint32_t a = climb(&frame->p, back, frame->p.landmarks[pir_landmark_of(back)]);
    const uint32_t b = climb(&frame->q, n, frame->q.landmarks[pir_landmark_of(n)]);
    double of_p, of_q;
    const uint32_t f = steepest_facet(frame->p.polytope, a, back, &of_p);
    const uint32_t g = steepest_facet(frame->q.polytope, b, n, &of_q);
    return of_p > of_q ? (pir_piece){PIR_FACET_FV, f, b} : (pir_piece){PIR_FACET_VF, a, g};
}

/* The next facet on the way, once by way of one towards x, where the foot is far away. */
WALK_TARGET static inline pir_piece next_on_way(const pir_frame *frame, const pir_placement *placement, pir_same is,
                                                pir_same_facet *same) {
    if (is != PIR_SAME_BESIDE)
        return near_edges(frame, same->facet.piece);
    if (!same->is_far && same->margin < -FAR_AWAY * placement->reach) {
        same->is_far = true;
        return towards(frame, placement);
    }
    return across(frame, placement, same);
}

WALK_TARGET static inline pir_same follow(const pir_frame *frame, const pir_placement *placement, pir_same is,
                                          pir_same_facet *same) {
    pir_piece before = {PIR_NO_PIECE, 0, 0};
    for (uint32_t steps = MOST_FACETS; steps > 0 && is <= PIR_SAME_BESIDE; steps--) {
        const pir_piece last = same->facet.piece, next = next_on_way(frame, placement, is, same);
        // to and fro across an edge of D, which the nearest point is on
        if (next.kind == before.kind && next.first == before.first && next.second == before.second)
            break;
        is = prove(frame, placement, next, same);
        before = last;
    }
    return is;
}

/* --- the walker --- */

WALK_TARGET static pir_same prove_piece(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                                        pir_same_facet *ret_same) {
    return WALK_CAN(frame) ? prove(frame, placement, piece, ret_same)
                           : WALK_ELSE->prove(frame, placement, piece, ret_same);
}

WALK_TARGET static pir_same follow_foot(const pir_frame *frame, const pir_placement *placement, pir_same is,
                                        pir_same_facet *same) {
    // the arcs of a polygon are half circles, and the straight way between their ends is none
    if (frame->p.polytope->dimension < 3 || frame->q.polytope->dimension < 3)
        return is;
    return WALK_CAN(frame) ? follow(frame, placement, is, same) : WALK_ELSE->follow(frame, placement, is, same);
}

WALK_TARGET static void find_supports(const pir_frame *frame, pir_vec3 n, uint32_t *a, uint32_t *b,
                                      pir_vec3 *ret_back) {
    *ret_back = pir_mat_apply_transposed(&frame->r, n);
    *a = climb(&frame->p, *ret_back, *a);
    *b = climb(&frame->q, n, *b);
}

WALK_TARGET static uint32_t find_support(const pir_body *body, pir_vec3 n, uint32_t from) {
    return climb(body, n, from);
}

const pir_walker WALK_NAME = {prove_piece, follow_foot, find_supports, find_support};
