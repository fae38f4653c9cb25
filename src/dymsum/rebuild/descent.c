/* SPDX-License-Identifier: MIT */
/*
 * Gradient descent on the Gaussian map (Behar and Lien, section 4.2): from a vertex to the one farthest along a normal.
 *
 * Each step takes an edge whose sign is positive, so the perturbed support rises strictly and the walk ends. On a
 * convex polytope a vertex without a rising edge is the farthest. Among rising edges the steepest is taken, by floats:
 * that choice affects only speed. Where floats are not certain the ring is compared by doubles, and exactly where those
 * are not.
 */
#include "dymsum/rebuild/descent.h"

#include "dymsum/pairing/predicates.h"

/* A facet of P (of_p) or of Q, its normal rotated to the other operand's frame, and the motion of that. */
struct descent {
    const pir_facets *facets;
    const pir_polytope *other;
    uint32_t facet;
    bool of_p;
    pir_vec3 turned, motion;
};

/* The neighbour of v along the steepest edge that rises; or v when none does, with how long that holds. */
static uint32_t step_by_doubles(pir_tracked *tracked, const struct descent *descent, uint32_t v,
                                pir_expiry *ret_expiry) {
    const pir_polytope *other = descent->other;
    uint32_t best = v;
    double most = 0;
    *ret_expiry = pir_expiry_never();
    for (uint32_t h = other->ring_start[v]; h < other->ring_start[v + 1]; h++) {
        double s;
        int sign = descent->of_p ? pir_sign_facet_half(&tracked->pairing, descent->facet, descent->turned, h, &s)
                                 : pir_sign_facet_half_back(&tracked->pairing, descent->facet, descent->turned, h, &s);
        pir_expiry_take_sign(ret_expiry, s, pir_vec_dot(descent->motion, other->direction[h]));
        if (sign > 0 && (best == v || s > most)) {
            best = other->target[h];
            most = s;
        }
    }
    return best;
}

static uint32_t descend(pir_tracked *tracked, const struct descent *descent, uint32_t from, pir_expiry *ret_expiry) {
    const pir_polytope *other = descent->other;
    float turned[8];
    pir_pack_turned(descent->turned, descent->motion, turned);
    for (;;) {
        pir_cell_probe seen;
        tracked->kernels->probe(descent->facets, &tracked->step, from, turned, &seen);
        tracked->pairing.signs.by_filter += other->ring_start[from + 1] - other->ring_start[from];
        uint32_t next = other->half_count == 0 ? from : other->target[other->ring_start[from] + seen.which];
        if (seen.highest < -PIR_FLOAT_BOUND) {
            *ret_expiry = (pir_expiry){seen.check.margin, seen.check.ahead, -seen.check.behind};
            return from;
        }
        if (seen.highest <= PIR_FLOAT_BOUND)
            next = step_by_doubles(tracked, descent, from, ret_expiry);
        if (next == from)
            return from;
        from = next;
    }
}

uint32_t pir_descend_fv(pir_tracked *tracked, uint32_t f, pir_vec3 rotated, uint32_t from, pir_expiry *ret_expiry) {
    const struct descent descent = {
        &tracked->p_facets, tracked->pairing.q, f, true, rotated, pir_motion_of(tracked, rotated)};
    return descend(tracked, &descent, from, ret_expiry);
}

uint32_t pir_descend_vf(pir_tracked *tracked, uint32_t g, uint32_t from, pir_expiry *ret_expiry) {
    pir_vec3 turned_back = pir_turned_back_normal(&tracked->pairing, g);
    const struct descent descent = {
        &tracked->q_facets, tracked->pairing.p, g, false, turned_back, pir_motion_back(tracked, turned_back)};
    return descend(tracked, &descent, from, ret_expiry);
}
