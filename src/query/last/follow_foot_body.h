/* SPDX-License-Identifier: MIT */
/*
 * The text of going from facet to facet after the foot of x. FOOT_TARGET names the processor, FOOT_PROVE its prover.
 * What stands before it is what the processor has for
 *
 *   - leave_cell, the edge of a vertex through which a way leaves its cell;
 *   - farthest_beyond, the side of a facet that a point is farthest beyond.
 *
 * Operations are taken in one order and never fused, so all versions have the same bits.
 */

/* A way over more facets than this takes longer than a search; from step to step there are few. */
#define MOST_FACETS 8

/* The arc of an edge towards its end at a facet: from that on its left to that on its right, or back. */
struct arc {
    uint32_t edge, facet;
    bool forward;
};

/* The facet at the end of an arc of P, or at the first edge across it, from n on in the cell of vertex b. */
FOOT_TARGET static pir_piece along_p(const pir_frame *frame, struct arc arc, uint32_t b, pir_vec3 n) {
    const pir_polytope *q = frame->q.polytope;
    pir_vec3 m = pir_mat_apply(&frame->r, frame->p.polytope->normal[arc.facet]);
    uint32_t half = leave_cell(&frame->q, b, n, m);
    if (half == UINT32_MAX)
        return (pir_piece){PIR_FACET_FV, arc.facet, b};
    // the arc rises along the halfedge, and turns counter-clockwise about its own edge
    return (pir_piece){PIR_FACET_EE, arc.edge, arc.forward ? half : q->twin[half]};
}

/* The same of an arc of Q in the cell of vertex a; n is in the frame. */
FOOT_TARGET static pir_piece along_q(const pir_frame *frame, struct arc arc, uint32_t a, pir_vec3 n) {
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
FOOT_TARGET static pir_piece across(const pir_frame *frame, const pir_placement *placement,
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
FOOT_TARGET static pir_piece near_edges(const pir_frame *frame, pir_piece piece) {
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

FOOT_TARGET static inline pir_same follow(const pir_frame *frame, const pir_placement *placement, pir_same is,
                                          pir_same_facet *same) {
    pir_piece before = {PIR_NO_PIECE, 0, 0};
    for (uint32_t left = MOST_FACETS; left > 0 && is <= PIR_SAME_BESIDE; left--) {
        const pir_piece last = same->facet.piece,
                        next = is == PIR_SAME_BESIDE ? across(frame, placement, same) : near_edges(frame, last);
        // to and fro across an edge of D, which the nearest point is on
        if (next.kind == before.kind && next.first == before.first && next.second == before.second)
            break;
        is = FOOT_PROVE(frame, placement, next, same);
        before = last;
    }
    return is;
}
