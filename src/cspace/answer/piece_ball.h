/* SPDX-License-Identifier: MIT */
/* A convex piece with a ball around it. */
#ifndef PIR_CSPACE_ANSWER_PIECE_BALL_H
#define PIR_CSPACE_ANSWER_PIECE_BALL_H

#include <math.h>

#include <pirouette/polytope.h>

#include "base/vec.h"

/* The unit of rounding. */
#define PIR_ROUNDING 0x1p-53

typedef struct pir_piece_ball {
    const pir_polytope *polytope; /* borrowed */
    pir_vec3 centre;              /* in the hull but for rounding, near the middle of the least ball around it */
    double radius;                /* no vertex is farther from the centre */
    double reach;                 /* no vertex is farther from the origin */
} pir_piece_ball;

/* The length of a vector whose square may be beyond the doubles. */
double pir_scaled_length(pir_vec3 v);

/* The length of any vector. */
static inline double pir_safe_length(pir_vec3 v) {
    const double square = pir_vec_dot(v, v);
    return square > 0x1p-900 && square < 0x1p900 ? sqrt(square) : pir_scaled_length(v);
}

/* O(n) for n vertices. */
pir_piece_ball pir_piece_ball_of(const pir_polytope *polytope);

#endif
