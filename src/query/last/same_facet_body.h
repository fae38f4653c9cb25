/* SPDX-License-Identifier: MIT */
/*
 * The text of proofs by doubles that a facet is one of D and holds the foot of x. SAME_TARGET names the processor.
 * What stands before and behind it is what the processor has for
 *
 *   - steepest_at, the steepest of the edges of a vertex along n;
 *   - within_facet, how far a point is from the nearest side of a body's facet, negative outside;
 *   - prove_ee, the proof of a facet of two edges.
 *
 * Operations are taken in one order and never fused, so all versions have the same bits.
 */

/*
 * The foot's distance from a side is known to PIR_SIDE_ERRORS of the errors that it is compared with in touch.c. This
 * many hold as well that a side's unit vector is off.
 */
#define MARGIN_ERRORS 16

/*
 * Whether edges of which the steepest rises by `most` certainly fall along n. n and PIR_SLOPE_BOUND are those of a unit
 * normal, or both times one factor: the sine of two edges' angle.
 */
SAME_TARGET static inline pir_same all_fall(double most) {
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
SAME_TARGET static inline pir_same find_top(const pir_body *body, pir_vec3 n, uint32_t *vertex) {
    const pir_polytope *p = body->polytope;
    for (uint32_t left = p->vertex_count; left > 0; left--) {
        pir_same fall = all_fall(steepest_at(body, *vertex, n));
        if (fall != PIR_SAME_NOT)
            return fall;
        *vertex = p->target[steepest_half(p, *vertex, n)];
    }
    return PIR_SAME_IN_DOUBT;
}

/* Sets slack and margin, and tells whether the foot is inside of the rim and x clearly on a side. */
SAME_TARGET static inline pir_same measure(const pir_placement *placement, double within, double slack,
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
SAME_TARGET static inline void set_facet(pir_same_facet *same, pir_witness faces, uint32_t a, uint32_t b,
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

SAME_TARGET static inline pir_same prove_fv(const pir_frame *frame, const pir_placement *placement,
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

SAME_TARGET static inline pir_same prove_vf(const pir_frame *frame, const pir_placement *placement,
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

SAME_TARGET static pir_same prove_ee(const pir_frame *frame, const pir_placement *placement, pir_same_facet *same);

SAME_TARGET static inline pir_same prove(const pir_frame *frame, const pir_placement *placement, pir_piece piece,
                                         pir_same_facet *ret_same) {
    ret_same->facet.piece = piece;
    return piece.kind == PIR_FACET_FV   ? prove_fv(frame, placement, ret_same)
           : piece.kind == PIR_FACET_VF ? prove_vf(frame, placement, ret_same)
                                        : prove_ee(frame, placement, ret_same);
}
