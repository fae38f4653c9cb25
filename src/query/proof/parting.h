/* SPDX-License-Identifier: MIT */
/*
 * Conservative advancement (Mirtich, "Impulse-based dynamic simulation of rigid body systems", 1996): when a body that
 * moves comes near one that stands. A step goes as far as the motion allows, and not only as far as the greatest speed
 * of any point does (after Catto, "Continuous collision", GDC 2013).
 */
#ifndef PIR_QUERY_PROOF_PARTING_H
#define PIR_QUERY_PROOF_PARTING_H

#include <pirouette/impact.h>
#include <pirouette/motion.h>
#include <pirouette/pose.h>
#include <pirouette/query.h>

#include "base/vec.h"

/* A body of these points, grown by a radius, moves over time 0 to 1 at constant speed, and turns about its centre. */
typedef struct pir_parted {
    const pir_vec3 *point;
    uint32_t count;
    double radius;
    double reach;       /* no point is farther from the centre */
    pir_vec3 way, turn; /* in the world; the turn along its axis, as long as the angle */
    pir_vec3 centre;    /* in the body's frame */
} pir_parted;

/* The distance of the farthest of some points from a centre, rounded up. */
double pir_parted_reach(const pir_vec3 *point, uint32_t count, pir_vec3 centre);

/* A plane below the body, and how near the body may come. */
typedef struct pir_parting {
    pir_vec3 normal; /* unit, towards the body */
    pir_vec3 foot;   /* a point of the plane */
    double near;     /* > 0: the answer is a time at which the body is no farther from the plane than this */
    double least;    /* ≥ 0, below `near`: until then it is farther than this */
} pir_parting;

/*
 * The time to which the plane parts them, from `time` on, when the body is at `pose`. HUGE_VAL where it does until
 * the time `end`. At every time before, all points of the body are more than `least` above the plane, but for what
 * `least` has to hold: 2^-44 of sizes and coordinates, and 2^-48 of the way of the farthest point. `distance` is how
 * far the body is above the plane at `time`. O(points) where the body turns far enough to come down, otherwise O(1).
 */
double pir_part_until(const pir_parted *body, const pir_parting *plane, pir_pose pose, double distance, double time,
                      double end);

/* PIR_ERR_NOT_FINITE, PIR_ERR_ARGUMENT for a tolerance not above 0 or `held` below 0, PIR_ERR_LIMIT for the turn. */
pir_status pir_motion_check(const pir_motion *motion, double tolerance);

/*
 * Whether a turn, a way or a screw of at most so many degrees can be: PIR_ERR_NOT_FINITE; PIR_ERR_ARGUMENT for the
 * angle, or an axis of length 0; PIR_ERR_LIMIT for an axis whose greatest component is beyond 2^±400.
 */
pir_status pir_screw_check(const pir_exact_motion *motion, double most_degrees);

/* An advance, and the source of distances that it takes its steps by. */
typedef struct pir_advance pir_advance;
struct pir_advance {
    pir_parted body;
    const pir_motion *motion;
    double tolerance; /* bodies this near have met */
    double least;     /* how near that may be told */
    double until;     /* a later contact is a miss */
    int steps;        /* the most distances asked for */
    /*
     * Sets the answer at the time at hand, and the body's pose then. An outcome other than PIR_CAST_STEP_LIMIT ends the
     * advance, as at time 0 of bodies that share a point.
     */
    pir_status (*ask)(pir_advance *advance, pir_pose *ret_pose);
    /* HIT, MISS or STEP_LIMIT, or what `ask` has set; the time, of a miss any; the last answer */
    pir_cast_outcome outcome;
    double time;
    pir_query_result answer;
};

/* Advances from time 0 until the body has come near. Errors of `ask`. */
pir_status pir_advance_run(pir_advance *advance);

#endif
