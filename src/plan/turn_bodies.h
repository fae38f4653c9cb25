/* SPDX-License-Identifier: MIT */
/*
 * Convex pieces over a set of rotations: one that is in the piece at all of them, and one that has the piece at all.
 *
 * The rotations are those of the hull of some quaternions, any two of which have a positive product: two for an arc of
 * a turn, the corners of a box for a cell of all rotations. R(q)·v·|q|² is a quadratic form in q, whose polar form
 * is B(p, q)·v with B(q, q) = |q|²·R(q). So for q = Σ λᵢ qᵢ it is Σᵢₖ λᵢ λₖ B(qᵢ, qₖ)·v, and
 * |q|² is Σᵢₖ λᵢ λₖ qᵢ·qₖ: a turned vector is a mean, with weights λᵢ λₖ qᵢ·qₖ / |q|², of
 * the vectors B(qᵢ, qₖ)·v / qᵢ·qₖ. What the half-spaces with these normals leave, for all facets, is in the
 * piece at each rotation. The hull of these vectors for all vertices has it.
 *
 * Inner pieces are hulls of points: corners of the piece and middles of its edges, at the middle rotation, moved
 * towards a point within until they keep all half-spaces of all facets. They have about as many facets as the piece,
 * and lose as much as is lost in the first order of the turn where they have points. They keep the half-spaces by 2^-22
 * of the size of the piece, are then rounded to 2^-24 of it, so that numbers are short, and doubles are within 2^-45.
 * Where the point within has not 2^-14 of the size for that there is no inner piece.
 *
 * An outer piece is grown about a point within by 2^-18, which moves its facets by 2^-18 of the radius r of a ball
 * about that point that the piece has; its corners are then rounded to 2^-20·r. There is none where r is less than
 * 2^-14 of the size.
 */
#ifndef PIR_PLAN_TURN_BODIES_H
#define PIR_PLAN_TURN_BODIES_H

#include "plan/plan_sums.h"

#define PIR_PLAN_TURNS 8
#define PIR_TURN_FORMS (PIR_PLAN_TURNS * (PIR_PLAN_TURNS + 1) / 2)

/* Quaternions as above; one stands for its rotation alone. */
typedef struct pir_plan_turns {
    pir_quat q[PIR_PLAN_TURNS];
    int count;
} pir_plan_turns;

/* The rows of B(p, q) / p·q for each two of the quaternions, then those of the middle one. */
typedef struct pir_turn_forms {
    pir_vec3 row[PIR_TURN_FORMS + 1][3];
    int count;
} pir_turn_forms;

pir_turn_forms pir_turn_forms_of(const pir_plan_turns *turns);

/*
 * The inner or outer pieces of a robot's, from malloc; `body` is which piece each is of. There may be fewer inner ones.
 * PIR_ERR_LIMIT where a piece is too thin for an outer one. To be freed also where it fails.
 */
pir_status pir_plan_pieces_over(const pir_plan_pieces *robot, const pir_plan_turns *turns, bool outer,
                                pir_plan_pieces *ret_pieces);
void pir_plan_pieces_over_free(pir_plan_pieces *pieces);

#endif
