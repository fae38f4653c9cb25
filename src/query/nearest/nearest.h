/* SPDX-License-Identifier: MIT */
/*
 * The point of D nearest to x, for x outside, as the two faces of P and Q whose sum holds it, and the answer that
 * follows from the faces alone.
 *
 * A descent (nearest_vertex.h) ends at a simplex of vertices of D that depends on its start. The faces do not:
 * the direction n from the nearest point to x exposes one face of P and one of Q. Where doubles prove which, those
 * are taken. Otherwise integers find them (nearest.c). All numbers are then computed from the faces, so
 * that an answer is the same, bit for bit, however it was found.
 */
#ifndef PIR_QUERY_NEAREST_NEAREST_H
#define PIR_QUERY_NEAREST_NEAREST_H

#include "query/decide/touch.h"
#include "query/nearest/nearest_vertex.h"

typedef struct pir_nearest {
    double distance; /* in the frame */
    pir_vec3 normal;
    pir_touch touch;
} pir_nearest;

/*
 * The nearest point, where doubles and filtered signs prove that a corner or an edge of D, the sum of two features,
 * holds it. That proves as well that x is outside of D. False where there is no such proof.
 */
bool pir_nearest_prove(pir_exact *exact, const pir_placement *placement, pir_witness faces, pir_nearest *ret_nearest);

/*
 * The nearest point where it is the foot of x on a facet of D that separates; false where the foot is beside the
 * facet.
 */
bool pir_nearest_at_facet(pir_exact *exact, const pir_placement *placement, const pir_facet *facet,
                          pir_nearest *ret_nearest);

/* That point, given the facet's slack as pir_facet_slack gives it. */
bool pir_nearest_at_slack(pir_exact *exact, const pir_placement *placement, const pir_facet *facet, double slack,
                          pir_nearest *ret_nearest);

/*
 * The nearest point by integers, from any simplex of at least one vertex, given that x is outside of D. False after
 * MOST_STEPS steps.
 */
bool pir_nearest_find(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, uint32_t *steps);

/*
 * Visits all pairs of nearest points that are corners of their polygon; otherwise as pir_nearest_find. Distance and
 * normal are set before the first visit, and the touch not at all.
 */
bool pir_nearest_each(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, const pir_touch_visitor *visitor);

#endif
