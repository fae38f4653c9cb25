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
#ifndef PIR_SCENE_WORLD_CORE_SIMPLEX_H
#define PIR_SCENE_WORLD_CORE_SIMPLEX_H

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

/* Whether it has the difference of two points. */
static inline bool pir_core_simplex_has(const pir_core_simplex *simplex, uint32_t a, uint32_t b) {
    bool has = false;
    for (int k = 0; k < simplex->count; k++)
        has |= simplex->corner[k].a == a && simplex->corner[k].b == b;
    return has;
}

/* The points of P and Q that are the least and the most along a direction, and the gap between them there. */
typedef struct pir_core_supports {
    uint32_t a, b;
    double gap;
} pir_core_supports;

/* Of the first `count` points of P and three corners of Q, along a unit direction from Q to P. */
pir_core_supports pir_core_supports_along(const pir_vec3 *point, uint32_t count, const pir_vec3 *corner, pir_vec3 n);

/*
 * A bound from below on the distance of the hull of points and a triangle, but for the rounding of dot products with
 * unit vectors; below 0 where none is found. It is the distance but for rounding, or at least `enough`.
 */
double pir_core_gap(const pir_vec3 *point, uint32_t count, const pir_vec3 *corner, double enough);

#endif
