/* SPDX-License-Identifier: MIT */
/*
 * A decision that outlasts the poses it was made at: two bodies are apart along a direction, by so much.
 *
 * Let n be a unit vector from Q to P in the world, and d the distance of the bodies along it: the least of P less the
 * most of Q. As a body moves, its origin goes along n by what its translation says. As it turns about that origin by
 * an angle, its support along n changes by at most the angle times its greatest distance from the origin. So d at
 * another two poses is at least what both leave of it. No frame is needed to tell, and neither body is looked at.
 */
#ifndef PIR_QUERY_PROOF_PROOF_H
#define PIR_QUERY_PROOF_PROOF_H

#include <string.h>

#include <pirouette/pose.h>

#include "query/frame/frame.h"

typedef struct pir_pair_proof {
    double leeway;  /* the distance along `along` at the poses, in units of the frame, less its error; 0 for no proof */
    double down;    /* units of the frame in one of the world */
    pir_vec3 along; /* unit, in the world, from Q to P */
    pir_pose p, q;  /* their quaternions are near unit */
} pir_pair_proof;

/* The bits in which two numbers differ. */
static inline uint64_t pir_bits_apart(double a, double b) {
    uint64_t of_a, of_b;
    memcpy(&of_a, &a, sizeof a);
    memcpy(&of_b, &b, sizeof b);
    return of_a ^ of_b;
}

/* Whether two poses are the same to the bit. */
static inline bool pir_pose_is_same(const pir_pose *a, const pir_pose *b) {
    const pir_quat *r = &a->rotation, *s = &b->rotation;
    const pir_vec3 *t = &a->translation, *u = &b->translation;
    return (pir_bits_apart(r->x, s->x) | pir_bits_apart(r->y, s->y) | pir_bits_apart(r->z, s->z) |
            pir_bits_apart(r->w, s->w) | pir_bits_apart(t->x, u->x) | pir_bits_apart(t->y, u->y) |
            pir_bits_apart(t->z, u->z)) == 0;
}

/* The most that |q|² of a quaternion may differ from 1, so that none has to be brought to length 1. */
#define PIR_NEAR_UNIT 0x1p-20

/* Distances are known this well, relative to a bound on the reach: more than PIR_DISTANCE_ERROR of the reach. */
#define PIR_PROOF_ERROR 0x1p-40

/* Beyond this reach nothing is decided by proofs. */
#define PIR_PROOF_FARTHEST 0x1p300

static inline bool pir_quat_is_near_unit(pir_quat q) {
    return fabs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) <= PIR_NEAR_UNIT;
}

/* Whether a component is no 0 and may be too small for a relative rotation. */
static inline bool pir_is_tiny(double c) {
    return (fabs(c) < 0x1p-800) & (c != 0);
}

/* Whether a rotation, and a relative one, can be made of it as it is. */
static inline bool pir_quat_is_plain(pir_quat q) {
    return pir_quat_is_near_unit(q) && !(pir_is_tiny(q.x) || pir_is_tiny(q.y) || pir_is_tiny(q.z) || pir_is_tiny(q.w));
}

/* A bound on all lengths that a distance of the bodies is computed from, in units of the frame; `down` as above. */
static inline double pir_pair_reach(const pir_body *p, const pir_body *q, const pir_pose *at_p, const pir_pose *at_q,
                                    double down) {
    return p->size + q->size + p->far + q->far +
           (pir_vec_taxicab(at_p->translation) + pir_vec_taxicab(at_q->translation)) * down;
}

/* Whether doubles tell about bodies of a reach at two poses, which then are valid ones. */
static inline bool pir_poses_are_plain(double reach, const pir_pose *at_p, const pir_pose *at_q) {
    return reach < PIR_PROOF_FARTHEST && pir_quat_is_plain(at_p->rotation) && pir_quat_is_plain(at_q->rotation);
}

/* Keeps that the bodies are apart by `leeway` along a unit vector; no proof where a quaternion is not near unit. */
static inline void pir_pair_proof_set(pir_pair_proof *proof, double leeway, double down, pir_vec3 along,
                                      const pir_pose *p, const pir_pose *q) {
    const bool is_near = pir_quat_is_near_unit(p->rotation) && pir_quat_is_near_unit(q->rotation);
    proof->leeway = is_near ? leeway : 0;
    proof->down = down;
    proof->along = along;
    proof->p = *p;
    proof->q = *q;
}

/*
 * Whether the bodies are apart at other poses by more than `least`, a length of the world. False too where the proof
 * does not tell, and where a pose may be no valid one.
 */
bool pir_pair_proof_holds(const pir_pair_proof *proof, const pir_body *p, const pir_body *q, const pir_pose *at_p,
                          const pir_pose *at_q, double least);

#endif
