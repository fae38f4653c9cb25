/* SPDX-License-Identifier: MIT */
/*
 * Gradient descent on the Gaussian map (Behar and Lien, section 4.2): from a vertex to the one farthest along a normal.
 *
 * Each step takes an edge whose sign is positive, so the perturbed support rises strictly and the walk ends; on a convex polytope a vertex
 * without a rising edge is the farthest. Among rising edges the steepest is taken, by doubles: that choice affects only speed.
 */
#include "dymsum/sum.h"

uint32_t pir_descend_fv(pir_sum *sum, uint32_t f, pir_vec3 rotated, uint32_t from, double *ret_margin) {
    const pir_polytope *q = sum->q;
    for (;;) {
        uint32_t best = from;
        double most = 0, margin = HUGE_VAL;
        for (uint32_t h = q->ring_start[from]; h < q->ring_start[from + 1]; h++) {
            double s;
            bool rises = pir_sign_facet_half(sum, f, rotated, h, &s) > 0;
            margin = fmin(margin, fabs(s));
            if (rises && (best == from || s > most))
                best = q->target[h], most = s;
        }
        if (best == from) {
            *ret_margin = margin - PIR_SIGN_BOUND;
            return from;
        }
        from = best;
    }
}

uint32_t pir_descend_vf(pir_sum *sum, uint32_t g, uint32_t from, double *ret_margin) {
    const pir_polytope *p = sum->p;
    pir_vec3 turned_back = pir_turned_back_normal(sum, g);
    for (;;) {
        uint32_t best = from;
        double most = 0, margin = HUGE_VAL;
        for (uint32_t h = p->ring_start[from]; h < p->ring_start[from + 1]; h++) {
            double s;
            bool rises = pir_sign_facet_half_back(sum, g, turned_back, h, &s) > 0;
            margin = fmin(margin, fabs(s));
            if (rises && (best == from || s > most))
                best = p->target[h], most = s;
        }
        if (best == from) {
            *ret_margin = margin - PIR_SIGN_BOUND;
            return from;
        }
        from = best;
    }
}
