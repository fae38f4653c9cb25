/* SPDX-License-Identifier: MIT */
/*
 * The point of D nearest to x, from outside, as the faces of P and Q whose sum holds it, and the answer that follows
 * from these alone.
 *
 * A descent (descent.c) ends at a simplex of vertices of D that depends on where it began. The faces do not: the
 * direction n from the nearest point to x exposes one face of P and one of Q. Where doubles prove which, they are
 * taken; else nearest_exact.c finds them with integers. The numbers are then worked out from the faces, so that an
 * answer is the same, bit for bit, however it was found.
 */
#ifndef PIR_QUERY_DECIDE_NEAREST_H
#define PIR_QUERY_DECIDE_NEAREST_H

#include "query/decide/touch.h"
#include "query/frame/nearest_vertex.h"

typedef struct pir_nearest {
    double distance; /* in the frame */
    pir_vec3 normal;
    pir_touch touch;
} pir_nearest;

/*
 * The nearest point, where doubles and filtered signs prove that the sum of two features holds it. That also proves
 * that x is outside of D. `piece` is the piece of D that is the sum of the features, or NULL where D has none. False
 * where there is no such proof.
 */
bool pir_nearest_prove(pir_exact *exact, const pir_placement *placement, pir_witness faces, const pir_piece *piece,
                       pir_nearest *ret_nearest);

/*
 * The nearest point by integers, from any simplex of at least one vertex, given that x is outside of D. False after a
 * bound on steps.
 */
bool pir_nearest_find(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
                      pir_nearest *ret_nearest, uint32_t *steps);

/* --- nearest_exact.c --- */

/*
 * The faces that the direction from the nearest point to x exposes, given that x is outside; false after a bound on
 * steps.
 */
bool pir_nearest_faces(pir_exact *exact, const pir_placement *placement, const pir_simplex *simplex,
                       pir_witness *ret_faces, pir_facet *ret_facet, bool *ret_flat, uint32_t *steps);

#endif
