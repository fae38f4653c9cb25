/* SPDX-License-Identifier: MIT */
/*
 * Features of a slice, carried to the pose's rotation.
 *
 * A slice knows which faces of P and Q make the boundary of the difference D near a translation, and the normal there.
 * At the pose's rotation A the same faces still say something, whether or not D's boundary has other faces there:
 *
 *   - a direction n with n·(A·p + t) > n·q for all vertices p of P and q of Q separates the bodies;
 *   - all points q − A·p are points of D; together with a ball that lies in D they make a part of D, as they and the
 *     ball are in it and it is convex. If t is in that part the bodies overlap.
 *
 * Both are tested in doubles, on the safe side of rounding by a bound on it.
 */
#ifndef PIR_CSPACE_ANSWER_CARRY_H
#define PIR_CSPACE_ANSWER_CARRY_H

#include <pirouette/query.h>

#include "cspace/answer/turned.h"

/* A pose of P beside Q, and a ball in D at the pose's rotation. */
typedef struct pir_carrying {
    const pir_turned *turned;
    const pir_piece_ball *p, *q;
    double error;    /* what points, and products with unit vectors, are off by at most */
    pir_vec3 centre; /* of the ball */
    double radius;   /* of it; 0 or less where there is none */
} pir_carrying;

/* The findings of a proof. */
typedef struct pir_proof {
    bool free, blocked;
    double gap; /* it holds wherever no point of P is moved farther than this */
} pir_proof;

/* Adds to `proof` what faces of P and Q and a normal of a slice prove. O(n) for n vertices. */
void pir_carry(const pir_carrying *carrying, const pir_mat3 *slice, pir_witness faces, pir_vec3 normal,
               pir_proof *proof);

/* Whether a translation is in the hull of the ball and a point of D. */
bool pir_carry_covers(const pir_carrying *carrying, pir_vec3 point);

#endif
