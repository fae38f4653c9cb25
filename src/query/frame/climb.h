/* SPDX-License-Identifier: MIT */
/*
 * Support vertices of a polytope by hill climbing, and the vertices that a climb starts from.
 *
 * A support vertex in a direction n is one that is farthest along n. On a convex polytope a vertex without a rising
 * edge is one.
 */
#ifndef PIR_QUERY_FRAME_CLIMB_H
#define PIR_QUERY_FRAME_CLIMB_H

#include <math.h>

#include "base/vec.h"
#include "polytope/polytope.h"

/* Rises smaller than this, along unit vectors, are taken for none: unit vectors are off by a few 2^-53. */
#define PIR_LEAST_SLOPE 0x1p-49

/* The number of directions whose support vertices a body keeps, as places for a climb to start from. */
#define PIR_LANDMARKS 24

/*
 * The vertex that a climb along n ends at. n has any length. The climb starts at vertex `from` and takes the steepest
 * edge as long as one rises by more than `least`.
 */
static inline uint32_t pir_climb_above(const pir_polytope *polytope, pir_vec3 n, double least, uint32_t from) {
    // every step rises, so no vertex comes twice; the count bounds the loop even if rounding should err
    for (uint32_t steps = polytope->vertex_count; steps > 0; steps--) {
        uint32_t best = UINT32_MAX, end = polytope->ring_start[from + 1];
        double steepest = least;
        for (uint32_t h = polytope->ring_start[from]; h < end; h++) {
            double slope = pir_vec_dot(n, polytope->direction[h]);
            best = slope > steepest ? h : best;
            steepest = slope > steepest ? slope : steepest;
        }
        if (best == UINT32_MAX)
            break;
        from = polytope->target[best];
    }
    return from;
}

/* The landmark of a vector: the number of its greatest component and of the signs of all three. */
static inline uint32_t pir_landmark_of(pir_vec3 n) {
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    uint32_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return 8 * axis + 4 * (n.x < 0) + 2 * (n.y < 0) + (n.z < 0);
}

/* The vertex of a polytope farthest along the unit vector n, uphill from vertex `from`. */
uint32_t pir_climb(const pir_polytope *polytope, pir_vec3 n, uint32_t from);

/* Finds a support vertex for every landmark. */
void pir_landmarks_set(const pir_polytope *polytope, uint32_t landmarks[PIR_LANDMARKS]);

#endif
