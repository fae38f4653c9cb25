/* SPDX-License-Identifier: MIT */
/**
 * First contacts, exactly: when a convex P that turns about an axis, or goes straight on, first touches a convex Q.
 *
 * A hinge, a door or a gear turns about a fixed axis through a pivot. With κ = |u|·cot(θ/2) for the angle θ about
 * the axis u, and κ = 1/λ for the fraction λ of a way, κ falls from +∞ while P moves, and each number by which
 * the bodies are apart along a facet of their difference is a quadratic in κ with rational coefficients, two edges
 * included. The first contact is therefore a root of a quadratic, and is found, isolated and told exactly.
 *
 * The search goes from one separating plane to the next. Each has the κ at which it ceases to separate, a root. There
 * another plane separates, of which that is proven at the root itself, or the bodies touch. So no contact is passed,
 * however short, and none is told that is not one. After kinetic data structures (Basch, Guibas and Hershberger, Data
 * Structures for Mobile Data, 1997) and the Plücker coordinates of edges (Canny, Collision Detection for Moving
 * Polyhedra, 1986).
 */
#ifndef PIROUETTE_IMPACT_H
#define PIROUETTE_IMPACT_H

#include <pirouette/base.h>
#include <pirouette/motion.h>
#include <pirouette/pair.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A turn about an axis, or a way without turning. All zeros is rest. */
typedef struct pir_exact_motion {
    pir_vec3 pivot, axis; /**< in the world; the axis of any length but 0 */
    double degrees;       /**< from −360 to 360, counter-clockwise seen from where the axis points to; 0 for a way */
    pir_vec3 way;         /**< in the world; zero for a turn */
} pir_exact_motion;

/** The first contact. */
typedef struct pir_exact_impact {
    /**
     * The outcome is one of pir_pair_cast, exact. `time` is rounded down, and is below the contact's by at most 1e-9 as
     * a rule; just before the contact the bodies do not overlap. The witness is the facet and vertex, or the two edges,
     * whose plane has the bodies on its sides at the contact; both lie in that plane there. `normal` is that plane's,
     * `point` in it on Q, both within 1e-9 as a rule, in the world. `steps` counts planes.
     */
    pir_impact impact;
    double kappa[2]; /**< on a hit, doubles around κ, with no other root of the quadratic between; else infinite */
    double degrees; /**< of a turn: from 0 on, in the direction of motion, rounded down: before the contact, or at it */
} pir_exact_impact;

/**
 * When P first touches Q.
 *
 * PIR_CAST_HIT: also where P only grazes Q. PIR_CAST_RECEDING: they touch at the start and do not overlap just after
 * it, and no later contact is looked for. PIR_CAST_START_INSIDE, PIR_CAST_AT_REST, PIR_CAST_MISS: as of motion.h.
 * Contact at the end of the motion is a hit. The end of a turn is at the double nearest to |u|·cot(θ/2).
 *
 * pair       of bodies of dimension 2 or 3, one of dimension 3.
 * workspace  scratch.
 * input      the poses at the start; radii, cutoff and margin do not count.
 * motion     P's; Q rests.
 *
 * Cost: for each plane a query of the pair and O(n) for n vertices; most motions need fewer than ten planes. Where
 * doubles do not tell signs, exact arithmetic; at a contact that is no crossing and no vertex within a facet, O(e f)
 * for e and f edges.
 *
 * Errors: those of a query of a pair; PIR_ERR_NOT_FINITE; PIR_ERR_ARGUMENT for dimensions, an axis of length 0, an
 * angle out of range, or turn and way together; PIR_ERR_LIMIT for an axis whose greatest component is beyond 2^±400.
 */
PIR_API pir_status pir_pair_impact(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                   const pir_exact_motion *motion, pir_exact_impact *ret_impact);

#ifdef __cplusplus
}
#endif

#endif
