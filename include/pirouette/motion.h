/* SPDX-License-Identifier: MIT */
/**
 * Motions, and what they meet first: of one form for sums, pairs, solids and scenes.
 *
 * P moves over time 0 to 1 at constant speed, from the pose that a call is given; Q, and all else, is at rest. A cast
 * and a time of impact end with a pir_impact, whose outcome says whether there was a contact, and whether the search
 * for it came to an end.
 */
#ifndef PIROUETTE_MOTION_H
#define PIROUETTE_MOTION_H

#include <pirouette/base.h>
#include <pirouette/witness.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A motion over time 0 to 1 at constant speed: along `way`, and about the body's own origin. All zeros is rest. */
typedef struct pir_motion {
    pir_vec3 way;  /**< of the body's origin, in the frame of Q, of a pair, solids and scenes in the world */
    pir_vec3 turn; /**< along the axis, as long as the angle in radians, up to 2^20; in the same frame */
    /**
     * Above 0 where something else, a solver say, holds the contacts of time 0. What is no farther than this then is
     * not met at all, and what is within the tolerance only when it comes within half of its distance then.
     */
    double held;
} pir_motion;

/** How a cast or a time of impact ended. */
typedef enum pir_cast_outcome {
    PIR_CAST_HIT = 0,      /**< touches at `time` in [0, 1] */
    PIR_CAST_MISS,         /**< never within the motion */
    PIR_CAST_RECEDING,     /**< touches at the start and moves apart, along, or not at all: time 0 */
    PIR_CAST_START_INSIDE, /**< overlaps at the start: time 0, normal of the least penetration */
    PIR_CAST_AT_REST,      /**< motion zero and no contact */
    PIR_CAST_STEP_LIMIT,   /**< not within tolerance after the bound on steps; there is no contact before `time` */
} pir_cast_outcome;

/** The first meeting of a motion or a ray. Where there is none, outcome, time, body and the pieces alone are set. */
typedef struct pir_impact {
    pir_cast_outcome outcome;
    double time;               /**< fraction of the motion, 0 to 1; 1 on a miss */
    pir_vec3 normal;           /**< at contact, unit, from Q to P; where it begins inside, that of the depth */
    pir_vec3 point;            /**< of contact, on Q; in the frame of the motion */
    pir_witness witness;       /**< of the two pieces that meet; none of a ray */
    uint32_t body;             /**< of a scene, the one that is met: PIR_SCENE_NONE where none is; else 0 */
    uint32_t piece_p, piece_q; /**< that meet, of solids and scenes; 0 of sums and pairs */
    uint32_t steps;            /**< of the search, on sums and pairs; it may depend on what was asked before */
    uint64_t user, piece_user; /**< of scenes, the caller's numbers for what is met; of a triangle its material */
} pir_impact;

#ifdef __cplusplus
}
#endif

#endif
