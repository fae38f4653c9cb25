/* SPDX-License-Identifier: MIT */
/*
 * Convex pieces over an interval of a turn about an axis: one that is in the piece at all angles of the interval, and
 * one that has the piece at all of them.
 *
 * A normal n that turns from n0 to n1 by δ < π stays in the triangle of n0, n1 and m, where the tangents of its arc
 * meet. What the half-spaces of these three leave, for all facets, is in the piece at each angle. Likewise the hull of
 * v0, v1 and m of all vertices has it. Both are computed in doubles, within 2^-46 of the size of the piece. The inner
 * one is then shrunk and the outer one grown about a point within, by 2^-28, where half-spaces are at least 2^-14 of
 * the size from that point; so each moves by 2^-42 of the size. Where they are nearer there is no inner piece, and no
 * outer one.
 */
#ifndef PIR_PLAN_TURN_BODIES_H
#define PIR_PLAN_TURN_BODIES_H

#include <pirouette/polytope.h>

/* A turn by angles from low to high in radians, at most π/2, about a unit axis. */
typedef struct pir_plan_arc {
    double axis[3], low, high;
} pir_plan_arc;

/* The inner piece: NULL where there is none. */
pir_status pir_plan_piece_within(const pir_polytope *piece, const pir_plan_arc *arc, pir_polytope **ret_inner);

/* The outer piece: PIR_ERR_LIMIT where the piece is too thin for one. */
pir_status pir_plan_piece_around(const pir_polytope *piece, const pir_plan_arc *arc, pir_polytope **ret_outer);

#endif
