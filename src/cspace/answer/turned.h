/* SPDX-License-Identifier: MIT */
/*
 * A pose beside a slice's rotation.
 *
 * A is the pose's rotation and t its translation, B the slice's rotation. P is moved so that its centre c stays where
 * the pose has it: with t' = t + (A − B)c a point v of P is at A·v + t in the pose and at B·v + t' beside the
 * slice, and the two places are |(A − B)(v − c)| apart. That is no more than δ, the turn from B to A times the
 * radius of P's ball or, closer, the most that a vertex moves.
 *
 * In the space of translations D(R) = Q ⊕ (−R·P): the difference at the pose's rotation, moved by (A − B)c, and
 * the one at the slice's differ by at most δ in every direction.
 */
#ifndef PIR_CSPACE_ANSWER_TURNED_H
#define PIR_CSPACE_ANSWER_TURNED_H

#include <pirouette/pair.h>

#include "base/vec.h"
#include "cspace/answer/piece_ball.h"
#include "exact/rotation.h"

typedef struct pir_turned {
    pir_mat3 a, between; /* A, and A − B */
    pir_vec3 t;
    double turn; /* radians, rounded up, from B to A */
} pir_turned;

pir_turned pir_turned_of(const pir_rotation *pose, pir_vec3 translation, const pir_rotation *slice);

/* t' − t for a piece: (A − B)c. */
pir_vec3 pir_turned_shift(const pir_turned *turned, const pir_piece_ball *p);

/* The error of t' and of lengths here, at most. */
double pir_turned_error(const pir_turned *turned, const pir_piece_ball *p, const pir_piece_ball *q);

/* δ by the ball, O(1), and by the vertices, O(n). */
double pir_turned_by_ball(const pir_turned *turned, const pir_piece_ball *p);
double pir_turned_by_vertices(const pir_turned *turned, const pir_piece_ball *p);

#endif
