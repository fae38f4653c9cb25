/* SPDX-License-Identifier: MIT */
/*
 * The oracle of signed distances: two small polytopes at poses that are moved a little, by brute force over all pairs
 * of features, in GMP floats of 320 bits. Poses are rational and rounding is near 1e-94, far below the differences of
 * distances that tests take at steps of 2^-60. Nothing of the library is used but vertices, edges and facets.
 */
#ifndef PIR_ORACLE_SIGNED_DISTANCE_H
#define PIR_ORACLE_SIGNED_DISTANCE_H

#include <gmp.h>

#include <pirouette/polytope.h>
#include <pirouette/pose.h>

typedef struct oracle_signed oracle_signed;

oracle_signed *oracle_signed_make(const pir_polytope *p, const pir_polytope *q);
void oracle_signed_free(oracle_signed *o);

/*
 * The distance where the bodies are apart, minus the depth where they overlap, at the poses moved by 2^exponent times
 * `motion`: v and w of P, then of Q. Origins move by v; bodies turn about them by the quaternion (w/2, 1), which is e^w
 * up to the third order.
 */
void oracle_signed_distance(oracle_signed *o, const pir_pose *pose_p, const pir_pose *pose_q, const double motion[12],
                            int exponent, mpf_t ret_distance);

/*
 * Settles poses: until others are settled, distances at these, moved by 2^-50 at most, are those of the features alone
 * that may decide them, by doubles. They are the same, many times faster.
 */
void oracle_signed_settle(oracle_signed *o, const pir_pose *pose_p, const pir_pose *pose_q);

/* Numbers of that precision. */
void oracle_signed_init(mpf_t x);

#endif
