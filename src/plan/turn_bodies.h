/* SPDX-License-Identifier: MIT */
/*
 * Convex pieces over a set of rotations: one that is in the piece at all of them, and one that has the piece at all.
 *
 * The rotations are those of the hull of some quaternions, any two of which have a positive product: two for an arc of
 * a turn, the corners of a box for a cell of all rotations. R(q)·v·|q|² is a quadratic form in q, whose polar form is
 * B(p, q)·v with B(q, q) = |q|²·R(q). So for q = Σ λᵢ qᵢ it is Σᵢₖ λᵢ λₖ B(qᵢ, qₖ)·v, and |q|² is Σᵢₖ λᵢ λₖ qᵢ·qₖ:
 * a turned vector is a mean, with weights λᵢ λₖ qᵢ·qₖ / |q|², of the vectors B(qᵢ, qₖ)·v / qᵢ·qₖ. What the half-spaces
 * with these normals leave, for all facets, is in the piece at each rotation. The hull of these vectors for all
 * vertices has it.
 *
 * For an arc all half-spaces are taken. For more quaternions each facet has one, with the normal at the middle, moved
 * in by what the corners of the facet lose: that has as many facets as the piece, and its corners lose as much in the
 * first order. Corners are found in doubles, and each is then moved towards a point within until it keeps all
 * half-spaces of all facets by 2^-42 of the size of the piece, where doubles are within 2^-45 of that. Where the point
 * has not 2^-14 of the size for that there is no inner piece. The outer piece is grown about a point within by 2^-28,
 * where facets are at least 2^-14 of the size from that point; there is none for thinner ones.
 */
#ifndef PIR_PLAN_TURN_BODIES_H
#define PIR_PLAN_TURN_BODIES_H

#include <pirouette/polytope.h>

#define PIR_PLAN_TURNS 8

/* Quaternions as above; one stands for its rotation alone. */
typedef struct pir_plan_turns {
    pir_quat q[PIR_PLAN_TURNS];
    int count;
} pir_plan_turns;

/* The inner piece: NULL where there is none. */
pir_status pir_plan_piece_within(const pir_polytope *piece, const pir_plan_turns *turns, pir_polytope **ret_inner);

/* The outer piece: PIR_ERR_LIMIT where the piece is too thin for one. */
pir_status pir_plan_piece_around(const pir_polytope *piece, const pir_plan_turns *turns, pir_polytope **ret_outer);

#endif
