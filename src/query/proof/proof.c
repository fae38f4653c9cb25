/* SPDX-License-Identifier: MIT */
/* Bodies that are apart still: see proof.h. */
#include "query/proof/proof.h"

/*
 * The error of a difference of two such quaternions, brought to length 1: |q| is within 2^-21 and some
 * rounding of 1, so each moves by less than 2^-20, and both by less than 2^-19.
 */
#define BESIDE_UNIT 0x1p-18

/* The square of the distance of two quaternions; of those that are each other's opposite it is far too great. */
static inline double square_chord(pir_quat a, pir_quat b) {
    double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z, w = a.w - b.w;
    return x * x + y * y + z * z + w * w;
}

/* How far a body has gone along n, in units of the frame, and the length that rounding is relative to. */
static double gone_along(const pir_pair_proof *proof, const pir_pose *from, const pir_pose *to, double *far) {
    pir_vec3 way = pir_vec_scale(pir_vec_sub(to->translation, from->translation), proof->down);
    *far += pir_vec_taxicab(way);
    return pir_vec_dot(proof->along, way);
}

/* Whether a body's support has changed by less than *leeway as it turned; sets that to what is left of it. */
static inline bool leaves_some(const pir_body *body, const pir_pose *from, const pir_pose *to, double *leeway) {
    const double swing = body->swing + body->far, square = square_chord(from->rotation, to->rotation);
    // the chord rejects most turns that are too great
    if (!(*leeway > 0 && 4 * square * swing * swing < *leeway * *leeway))
        return false;
    *leeway -= pir_rotation_angle_of_chord(sqrt(square) + BESIDE_UNIT) * swing * (1 + 0x1p-40);
    return *leeway > 0;
}

bool pir_pair_proof_holds(const pir_pair_proof *proof, const pir_body *p, const pir_body *q, const pir_pose *at_p,
                          const pir_pose *at_q, double least) {
    if (!(proof->leeway > 0))
        return false;
    const bool q_stands = pir_pose_is_same(at_q, &proof->q);
    const double reach = pir_pair_reach(p, q, at_p, at_q, proof->down);
    double way = reach, leeway = proof->leeway - least * proof->down * (1 + 0x1p-40);
    leeway += gone_along(proof, &proof->p, at_p, &way);
    if (!q_stands)
        leeway -= gone_along(proof, &proof->q, at_q, &way);
    leeway -= PIR_PROOF_ERROR * way;
    return leaves_some(p, &proof->p, at_p, &leeway) && (q_stands || leaves_some(q, &proof->q, at_q, &leeway)) &&
           pir_poses_are_plain(reach, at_p, at_q);
}
