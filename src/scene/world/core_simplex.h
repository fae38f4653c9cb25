/* SPDX-License-Identifier: MIT */
/*
 * The point nearest to 0 of the hull of at most four differences of points of two bodies (Gilbert, Johnson and Keerthi,
 * 1988; by the regions of a triangle: Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
 *
 * Invariants
 *   - After pir_core_simplex_solve at most three differences are left, with the weights of the point, above 0, of
 *     sum 1.
 *   - What rounding makes of it is a point of the hull all the same, but for the rounding of its sum: whoever needs it
 *     to be the nearest has to prove it.
 */
#ifndef PIR_SCENE_QUERY_CORE_SIMPLEX_H
#define PIR_SCENE_QUERY_CORE_SIMPLEX_H

#include <stdint.h>

#include "base/vec.h"

/* A difference: of point `a` of P and point `b` of Q, and its weight. */
typedef struct pir_core_corner {
    pir_vec3 w;
    double part;
    uint32_t a, b;
} pir_core_corner;

typedef struct pir_core_simplex {
    pir_core_corner corner[4];
    int count;
} pir_core_simplex;

/* The nearest point; the corners that hold it stay. */
pir_vec3 pir_core_simplex_solve(pir_core_simplex *simplex);

#endif
