/* SPDX-License-Identifier: MIT */
/**
 * Sweeps: whether a pair is free all along a motion from poses to poses, or along a screw, proven, or when it meets.
 *
 * Both bodies move over time s from 0 to 1. Of each, the translation is (1 − s)·t₀ + s·t₁. The rotation is the
 * first one, turned on by s·φ about the fixed axis of the turn from the first to the second, the shorter way, through
 * φ ≤ 180 degrees. These are exact poses, for all s; at 0 and at 1 they are those given. Where φ is 180 degrees,
 * the axis is, as the body sees it, the one whose first component that is not 0 is positive.
 *
 * A screw is that of a bolt: at time s, P has turned by s·θ about an axis through a pivot, and has gone s of its way.
 * So the way is proportional to the angle, of however many turns. (First contacts of impact.h are exact, of ways that
 * go as the tangent of half the angle.) The times told are fractions of the angle too.
 *
 * Nothing is sampled. From a time at which the bodies are apart a plane between them goes on to part them until a point
 * of either may have come to it, a bound on the exact motion with all rounding in it; there the next plane is asked
 * for. A meeting is an overlap at some time, deeper than rounding could make up. What is neither is told as undecided.
 * After conservative advancement (Mirtich, Impulse-based dynamic simulation of rigid body systems, 1996).
 */
#ifndef PIROUETTE_SWEEP_H
#define PIROUETTE_SWEEP_H

#include <pirouette/base.h>
#include <pirouette/impact.h>
#include <pirouette/pair.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Knowledge of a motion. Never wrong: what is not proven is undecided. */
typedef enum pir_sweep_outcome {
    PIR_SWEEP_UNDECIDED = 0, /**< neither is proven, as where bodies slide along each other, or the budget is used up */
    PIR_SWEEP_FREE,          /**< the bodies share no point at any time */
    PIR_SWEEP_MEETS,         /**< they share a point at some time */
} pir_sweep_outcome;

/** The answer for a motion. */
typedef struct pir_sweep_result {
    pir_sweep_outcome outcome;
    /**
     * Times from 0 to 1. Before `from` the bodies share no point. PIR_SWEEP_MEETS: at `to` they share one, so the first
     * contact is in between. PIR_SWEEP_UNDECIDED: after `to` they share none either. PIR_SWEEP_FREE: both are 1.
     */
    double from, to;
    uint32_t queries; /**< distances that were asked for */
} pir_sweep_result;

/** The most distances that are asked for where a budget of 0 is given. */
#define PIR_SWEEP_BUDGET 512

/**
 * Sweeps both bodies of a pair from poses to poses.
 *
 * Decided is what is clearer than rounding: distances above 1e-11 and depths above 4e-12, relative to the size of
 * bodies, ways and coordinates. At times 0 and 1, without radii, states are exact: touching there is meeting, and
 * bodies that both rest are always decided. Two flat bodies in one plane are never proven to meet in between.
 *
 * workspace      scratch.
 * first, second  the poses at times 0 and 1, in the world; the radii of `first` count, cutoff and margin do not.
 * budget         the most distances that are asked for, two at least; 0 for PIR_SWEEP_BUDGET.
 *
 * Cost: a query of a pair and O(n) for n vertices, for each plane; most motions need fewer than ten.
 *
 * Errors: those of a query of a pair for either poses; PIR_ERR_LIMIT also for the two rotations of a body where the
 * components of their quaternions span more than 2^900.
 */
PIR_API pir_status pir_pair_sweep(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *first,
                                  const pir_pair_input *second, uint32_t budget, pir_sweep_result *ret_sweep);

/** The greatest angle of a screw: a hundred turns. */
#define PIR_SWEEP_DEGREES 36000

/**
 * Sweeps P of a pair along a turn, a way or a screw; Q rests.
 *
 * Decided is what is clearer than rounding, as of pir_pair_sweep, with the pivot among the coordinates, and times the
 * half turns that are begun. At time 0, without radii, the state is exact; that at time 1 is not, unless P rests.
 *
 * workspace  scratch.
 * input      the poses at time 0, in the world; the radii count, cutoff and margin do not.
 * motion     P's, its way proportional to the angle, which is from −PIR_SWEEP_DEGREES to PIR_SWEEP_DEGREES.
 * budget     the most distances that are asked for, two at least; 0 for PIR_SWEEP_BUDGET.
 *
 * Cost: that of pir_pair_sweep; most screws need fewer than ten distances a turn.
 *
 * Errors: those of a query of a pair; PIR_ERR_NOT_FINITE; PIR_ERR_ARGUMENT for an axis of length 0, or an angle out of
 * range; PIR_ERR_LIMIT for an axis whose greatest component is beyond 2^±400.
 */
PIR_API pir_status pir_pair_sweep_screw(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                                        const pir_exact_motion *motion, uint32_t budget, pir_sweep_result *ret_sweep);

#ifdef __cplusplus
}
#endif

#endif
