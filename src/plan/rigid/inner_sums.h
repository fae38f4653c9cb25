/* SPDX-License-Identifier: MIT */
/*
 * Inner sums: convex polytopes of translations that block a box of rotations.
 *
 * A translation x is blocked by a piece P of the robot and a piece O of the obstacles at all rotations q of a box where
 * it is in S(q) = O ⊕ (−R(q)·P) at each: the point of P that is in O may be another for each q. S(q) is what the
 * half-spaces leave whose normals N are those of facets of O, of facets of −R·P, and e × R·f for edges e of
 * O and f of P; x is in one where N·(x − o + R·p) ≤ 0 for points o of O and p of P. With these fixed that is a
 * quadratic form in q times a positive number, so it holds in the whole box where all polar forms of two corners are
 * at most 0 (turn_bodies.h). N of two edges is only of need where it is between the normals of the two facets of O at
 * e, and between those of the two facets of −R·P at f. So the half-spaces of both facets, with the same o and p,
 * stand for it as well: they serve where edges may be parallel, and N is anything. Where one o is in all half-spaces of
 * P, x is in S(q) at once.
 *
 * p are corners of P, middles of its edges and its middle; o corners of O and the points of its edges and facets that
 * are nearest to x.
 *
 * An inner sum is the hull of points: corners of S at the middle rotation, each moved inwards until it is in S(q)
 * throughout, then points before its facets, as far outwards as they are in S(q). Points keep half-spaces by 2^-22 of
 * the size of both pieces, and are rounded to 2^-24 of it. Of them few are kept, those that are farthest out within the
 * bounds, since a division costs as facets do. Where a translation is blocked that the sum has not, it can be added: S
 * is convex, so the hull with it is in S too.
 */
#ifndef PIR_PLAN_RIGID_INNER_SUMS_H
#define PIR_PLAN_RIGID_INNER_SUMS_H

#include "plan/rigid/box_parts.h"
#include "plan/turn_bodies.h"

/* The most corners of an inner sum as it is made, and of more points that widen it. */
#define PIR_INNER_CORNERS 12
#define PIR_INNER_MORE    12

/*
 * A search for all pairs of pieces over one box; a pair is the obstacle's number and that of the robot times how many
 * obstacles there are. The question and the space, of which it takes its memory, are borrowed. To be
 * closed also where it fails.
 */
typedef struct pir_inner_search pir_inner_search;

pir_status pir_inner_search_open(const pir_rigid_question *question, const pir_plan_turns *turns, pir_plan_space *space,
                                 pir_inner_search **ret_search);
void pir_inner_search_close(pir_inner_search *search);

/* About how deep a translation is in the sum of a pair at the middle rotation, at most; 0 or less outside. */
double pir_inner_depth(const pir_inner_search *search, uint32_t pair, const double at[3]);

/* Whether a pair blocks a translation at all rotations, with room. */
bool pir_inner_has(pir_inner_search *search, uint32_t pair, const double at[3]);

/* The inner sum of a pair; NULL where there is none. */
pir_status pir_inner_sum_make(pir_inner_search *search, uint32_t pair, pir_polytope **ret_sum);

/* How far a translation is from a sum, about; 0 or less within. */
double pir_inner_sum_far(const pir_polytope *sum, const double at[3]);

/*
 * A translation that a pair blocks and its sum has not, moved on outwards as far as the pair blocks it; false where the
 * pair does not block it once it is rounded.
 */
bool pir_inner_sum_point(pir_inner_search *search, uint32_t pair, const pir_polytope *sum, const double at[3],
                         pir_vec3 *ret_point);

/* A sum made wider by such points; NULL where it has no inside. */
pir_status pir_inner_sum_widen(pir_inner_search *search, const pir_polytope *sum, const pir_vec3 *more, uint32_t count,
                               pir_polytope **ret_wider);

#endif
