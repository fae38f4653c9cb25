/* SPDX-License-Identifier: MIT */
/**
 * First contacts, exactly: when a convex P that turns about an axis, goes straight on, or does both, first touches a
 * convex Q.
 *
 * A hinge, a door or a gear turns about a fixed axis through a pivot. With κ = |u|·cot(θ/2) for the angle θ about
 * the axis u, and κ = 1/λ for the fraction λ of a way, κ falls from +∞ while P moves, and each number by which
 * the bodies are apart along a facet of their difference is a quadratic in κ with rational coefficients, two edges
 * included. The first contact is therefore a root of a quadratic, and is found, isolated and told exactly.
 *
 * A screw turns and goes at once. What is proportional to the angle itself is no root of any polynomial in κ. So the
 * fraction of the way here is κ₁/κ, of the κ₁ at the end: tan(θ/2)/tan(θ₁/2). All conditions then are
 * cubics. From θ/θ₁ this differs by at most 0.001 in a screw of 10 degrees, 0.009 in one of 30, 0.037 in one of 60,
 * 0.09 in one of 90. For a way that is proportional to the angle, pir_pair_sweep_screw has proven bounds.
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

/** A turn about an axis, a way without turning, or a screw: both. All zeros is rest. */
typedef struct pir_exact_motion {
    pir_vec3 pivot, axis; /**< in the world; the axis of any length but 0, which does not move */
    double degrees;       /**< from −360 to 360, counter-clockwise seen from where the axis points to; 0 for a way */
    /**
     * In the world; zero for a turn. Of a screw it is gone by tan(θ/2)/tan(θ₁/2), in any direction, along the axis
     * or not; the angle then is below 180 degrees and at least 2^-20. In sweeps (sweep.h) it is gone by θ/θ₁.
     */
    pir_vec3 way;
} pir_exact_motion;

/** The first contact. */
typedef struct pir_exact_impact {
    /**
     * The outcome is one of pir_pair_cast, exact. `time` is rounded down, and is below the contact's by at most 1e-9 as
     * a rule; of a screw it is the fraction of the angle. Just before the contact the bodies do not overlap. The
     * witness is the facet and vertex, or the two edges, whose plane has the bodies on its sides at the contact; both
     * lie in that plane there. `normal` is that plane's, `point` in it on Q, both within 1e-9 as a rule, in the world.
     * `steps` counts planes.
     */
    pir_impact impact;
    /**
     * On a hit, doubles around κ, with no other root of the quadratic between, of a cubic as a rule; else infinite.
     */
    double kappa[2];
    /** Of turns and screws: from 0 on, in the direction of motion, rounded down: before the contact, or at it. */
    double degrees;
} pir_exact_impact;

/**
 * When P first touches Q.
 *
 * PIR_CAST_HIT: also where P only grazes Q. PIR_CAST_RECEDING: they touch at the start and do not overlap just after
 * it, and no later contact is looked for. PIR_CAST_START_INSIDE, PIR_CAST_AT_REST, PIR_CAST_MISS: as of motion.h.
 * Contact at the end of the motion is a hit. The end of a turn is at a double within a few last bits of |u|·cot(θ/2),
 * which of 90 and 180 degrees is |u| and 0.
 *
 * pair       of bodies of dimension 2 or 3, one of dimension 3.
 * workspace  scratch.
 * input      the poses at the start; radii, cutoff and margin do not count.
 * motion     P's; Q rests.
 *
 * Cost: for each plane a query of the pair and O(n) for n vertices; most motions need fewer than ten planes. Where
 * doubles do not tell signs, exact arithmetic; at a contact that is no crossing and no vertex within a facet, O(e f)
 * for e and f edges. A screw's planes cost about twice as much.
 *
 * Errors: those of a query of a pair; PIR_ERR_NOT_FINITE; PIR_ERR_ARGUMENT for dimensions, an axis of length 0, or an
 * angle out of range; PIR_ERR_LIMIT for an axis whose greatest component is beyond 2^±400, and for a screw of less
 * than 2^-20 degrees.
 */
PIR_API pir_status pir_pair_impact(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                   const pir_exact_motion *motion, pir_exact_impact *ret_impact);

#ifdef __cplusplus
}
#endif

#endif
